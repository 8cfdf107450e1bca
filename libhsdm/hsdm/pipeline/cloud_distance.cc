#include "hsdm/pipeline/cloud_distance.hh"

#include "hsdm/core/chunks.hh"
#include "hsdm/core/large_vector.hh"
#include "hsdm/core/system.hh"
#include "hsdm/mesh/part_of.hh"
#include "hsdm/quality/distance_to_surface.hh"
#include "hsdm/spatial/facet_cells.hh"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace hsdm {
namespace {

/// Facets by the cell of the cloud that the first vertex of each lies in.
class NearFacets {
public:
    NearFacets(const ScratchCloud& cloud, const PolygonMesh& facets)
        : cloud_(cloud), facets_(facets), cell_size_(std::ldexp(cloud.cube_extent(), -cloud.cell_depth())) {
        const int shift = 3 * (morton_levels - cloud.cell_depth());
        cell_ = large_vector<Index>(facets.facet_count());
        std::vector<double> longest = large_vector<double>(facets.facet_count());
        for_each_index(cell_.size(), chunks::quick, [&](Index f) {
            const Vec3& first = facets.positions[facets.facet(f)[0]];
            cell_[f] = static_cast<Index>(code_at(first, cloud.cube_extent()) >> shift);
            for (const Index v : facets.facet(f))
                longest[f] = std::max(longest[f], (facets.positions[v] - first).norm());
        });
        if (!longest.empty()) longest_ = std::ranges::max(longest);
    }

    int all_cells() const { return 1 << cloud_.cell_depth(); }

    /// Far enough for points that are within a few voxels of the facets.
    int first_reach() const {
        const double far = longest_ + 2 * cloud_.voxel_size();
        return static_cast<int>(std::min(std::ceil(far / cell_size_), 1.0 * all_cells()));
    }

    /// The nearest facet of a point in one of some cells is among those whose first vertex is at most `reach`
    /// cells from them, if it is no farther than this.
    double known(int reach) const {
        return reach >= all_cells() ? Box::inf : std::max(0.0, reach * cell_size_ - longest_);
    }

    /// Those facets, in their order.
    PolygonMesh around(const std::vector<Index>& cells, int reach) const {
        const auto side = static_cast<std::size_t>(all_cells());
        std::vector<std::uint8_t> is_near = large_vector<std::uint8_t>(side * side * side);
        for (const Index cell : cells) {
            const VoxelCoord at = morton_decode(cell);
            CellRange around{at, at};
            for (std::size_t k = 0; k < 3; ++k) {
                around.lo[k] = std::max(0, at[k] - reach);
                around.hi[k] = std::min(all_cells() - 1, at[k] + reach);
            }
            around.for_each([&](const VoxelCoord& c) { is_near[morton_encode(c)] = 1; });
        }
        return part_of(
            facets_, indices_where(cell_.size(), chunks::light, [&](Index f) { return is_near[cell_[f]]; }));
    }

private:
    const ScratchCloud& cloud_;
    const PolygonMesh& facets_;
    double cell_size_, longest_ = 0;
    std::vector<Index> cell_;
};

std::vector<Index> cells_of(std::span<const MortonCode> codes, int shift) {
    std::vector<Index> cells;
    for (const MortonCode code : codes) {
        const auto cell = static_cast<Index>(code >> shift);
        if (cells.empty() || cells.back() != cell) cells.push_back(cell);
    }
    return cells;
}

/// Looks around the cells of all points, and farther for those that are farther off.
std::vector<double> squared_distances(std::span<const Vec3> points, std::span<const MortonCode> codes,
                                      const NearFacets& near, const ScratchCloud& cloud) {
    const int shift = 3 * (morton_levels - cloud.cell_depth());
    std::vector<double> squared = large_vector<double>(points.size(), Box::inf);
    std::vector<Index> due = indices_where(points.size(), chunks::light, [](Index) { return true; });
    for (int reach = near.first_reach(); !due.empty(); reach *= 2) {
        std::vector<Vec3> places = large_vector<Vec3>(due.size());
        std::vector<MortonCode> at = large_vector<MortonCode>(due.size());
        for_each_index(due.size(), chunks::light,
                       [&](Index i) { places[i] = points[due[i]], at[i] = codes[due[i]]; });
        const PolygonMesh facets = near.around(cells_of(at, shift), reach);
        if (facets.facet_count() > 0) {
            const FacetCells cells(facets, cloud.voxel_size());
            const std::vector<double> found = squared_distances_by_cells(places, facets, cells);
            for_each_index(due.size(), chunks::light, [&](Index i) { squared[due[i]] = found[i]; });
        }
        const double known = near.known(reach);
        std::erase_if(due, [&](Index i) { return std::sqrt(squared[i]) <= known; });
    }
    return squared;
}

} // namespace

Distance cloud_distance(const ScratchCloud& cloud, const PolygonMesh& facets, std::size_t most_points,
                        Occurrences& off) {
    const NearFacets near(cloud, facets);
    DistanceSums sums(std::numbers::sqrt3 * cloud.voxel_size());
    cloud.for_groups(most_points, [&](const Octree& part) {
        if (part.size() == 0) return;
        const std::size_t before = sums.count();
        sums.add(squared_distances(part.positions, part.codes, near, cloud));
        const Distance so_far = sums.result();
        if (off.count == 0 && so_far.beyond > 0)
            off.first = part.positions[so_far.first_beyond - before] + cloud.origin();
        off.count = so_far.beyond;
        os::give_back_freed_memory();
    });
    return sums.result();
}

} // namespace hsdm
