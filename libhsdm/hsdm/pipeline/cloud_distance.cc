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
        if (reach >= all_cells()) return Box::inf;
        return std::max(0.0, reach * cell_size_ - longest_);
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

void send_facets(const PolygonMesh& facets, Ranks& ranks) {
    Ranks::Bytes bytes;
    put_vector(facets.positions, bytes);
    put_vector(facets.first, bytes);
    put_vector(facets.corners, bytes);
    ranks.of_first(std::move(bytes));
}

PolygonMesh receive_facets(Ranks& ranks) {
    const Ranks::Bytes got = ranks.of_first(Ranks::Bytes());
    ByteReader reader(got);
    PolygonMesh mesh;
    mesh.positions = reader.take_vector<Vec3>();
    mesh.first = reader.take_vector<Index>();
    mesh.corners = reader.take_vector<Index>();
    return mesh;
}

/// Distances that come in the order of the points, and what they add up to.
class Measured {
public:
    explicit Measured(const ScratchCloud& cloud) : sums_(std::numbers::sqrt3 * cloud.voxel_size()) {}

    void add(const std::vector<double>& squared, const auto& position_of) {
        const std::size_t before = sums_.count();
        sums_.add(squared);
        const Distance so_far = sums_.result();
        if (off_.count == 0 && so_far.beyond > 0) off_.first = position_of(so_far.first_beyond - before);
        off_.count = so_far.beyond;
    }

    const Occurrences& off() const { return off_; } ///< relative to the cube
    Distance result() const { return sums_.result(); }

private:
    DistanceSums sums_;
    Occurrences off_;
};

/// What a rank has to tell the first: distances of all its points, and the first place that is far off.
struct OwnDistances {
    std::vector<double> squared;
    Vec3 first_off{0, 0, 0};
};

/// act(squared, octree) for this rank's points.
template <class Act>
void measure_own(const ScratchCloud& cloud, const PolygonMesh& facets, std::size_t most_points,
                 const Act& act) {
    const NearFacets near(cloud, facets);
    cloud.for_groups(most_points, [&](const Octree& part) {
        if (part.size() == 0) return;
        act(squared_distances(part.positions, part.codes, near, cloud), part);
        os::give_back_freed_memory();
    });
}

/// Of one rank after the other, so that the first has room for one of them.
void pass_to_first(const OwnDistances& own, Ranks& ranks, const std::function<void(ByteReader&)>& receive) {
    for (int sender = 1; sender < ranks.size(); ++sender) {
        std::vector<Ranks::Bytes> out(static_cast<std::size_t>(ranks.size()));
        if (sender == ranks.rank()) {
            put(own.first_off, out.front());
            put_vector(own.squared, out.front());
        }
        const std::vector<Ranks::Bytes> got = ranks.exchange(std::move(out));
        if (!ranks.is_first()) continue;
        ByteReader reader(got[static_cast<std::size_t>(sender)]);
        receive(reader);
    }
}

} // namespace

Distance cloud_distance(const ScratchCloud& cloud, const PolygonMesh& facets, std::size_t most_points,
                        Occurrences& off) {
    Ranks& ranks = cloud.ranks();
    if (ranks.size() > 1) send_facets(facets, ranks);
    Measured all(cloud);
    measure_own(cloud, facets, most_points, [&](const std::vector<double>& squared, const Octree& part) {
        all.add(squared, [&](std::size_t i) { return part.positions[i]; });
    });
    pass_to_first({}, ranks, [&](ByteReader& reader) {
        const Vec3 first_off = reader.take<Vec3>();
        all.add(reader.take_vector<double>(), [&](std::size_t) { return first_off; });
    });
    off = all.off();
    if (off.count > 0) off.first += cloud.origin();
    return all.result();
}

void assist_cloud_distance(const ScratchCloud& cloud, std::size_t most_points) {
    const PolygonMesh facets = receive_facets(cloud.ranks());
    OwnDistances own;
    Measured here(cloud);
    measure_own(cloud, facets, most_points, [&](const std::vector<double>& squared, const Octree& part) {
        here.add(squared, [&](std::size_t i) { return part.positions[i]; });
        append_large(own.squared, squared);
    });
    own.first_off = here.off().first;
    pass_to_first(own, cloud.ranks(), {});
}

} // namespace hsdm
