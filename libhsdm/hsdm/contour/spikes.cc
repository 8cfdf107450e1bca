#include "hsdm/contour/spikes.hh"

#include "hsdm/contour/constants.hh"
#include "hsdm/core/chunks.hh"
#include "hsdm/core/large_vector.hh"

#include <algorithm>
#include <cmath>

namespace hsdm {
namespace {

/// Says whether a place is far from all points.
class PointsNear {
public:
    PointsNear(const Octree& octree, const OctreeLevel& level) : octree_(octree), level_(level) {}

    /// `own`: the voxel that what lies at the place stands for.
    bool none(const Vec3& place, Index own) const {
        const double usual = spikes::farthest * level_.voxel_size;
        if (holds(own, place, usual) || around_holds(place, usual)) return false;
        const double sparse = spikes::spacings * spacing_around(own);
        if (sparse <= usual) return true;
        bool found = holds(own, place, sparse);
        for_neighbors(level_, own, [&](Index v) { found = found || holds(v, place, sparse); });
        return !found;
    }

private:
    double count(Index v) const { return level_.first_point[v + 1] - level_.first_point[v]; }

    bool holds(Index v, const Vec3& place, double within) const {
        for (Index p = level_.first_point[v]; p < level_.first_point[v + 1]; ++p)
            if ((octree_.positions[p] - place).sqrnorm() <= within * within) return true;
        return false;
    }

    /// The place may have left its voxel for one without points.
    bool around_holds(const Vec3& place, double within) const {
        VoxelCoord c{};
        for (unsigned a = 0; a < 3; ++a) c[a] = static_cast<int>(std::floor(place[a] / level_.voxel_size));
        const auto holds_at = [&](const VoxelCoord& at) {
            const Index v = level_.find(at);
            return v != no_index && holds(v, place, within);
        };
        return holds_at(c) || std::ranges::any_of(neighbor_offsets, [&](const VoxelCoord& o) {
                   return holds_at({c[0] + o[0], c[1] + o[1], c[2] + o[2]});
               });
    }

    /// As if the points of a voxel and of those round it lay on a plane through each.
    double spacing_around(Index own) const {
        double points = count(own), voxels = 1;
        for_neighbors(level_, own, [&](Index v) { points += count(v), ++voxels; });
        return level_.voxel_size * std::sqrt(voxels / points);
    }

    const Octree& octree_;
    const OctreeLevel& level_;
};

/// Each marked vertex with each of its neighbours, sorted.
std::vector<std::pair<Index, Index>> neighbors_of(const std::vector<Index>& vertices,
                                                  const PolygonMesh& mesh) {
    std::vector<std::uint8_t> marked = large_vector<std::uint8_t>(mesh.vertex_count());
    for (const Index v : vertices) marked[v] = 1;
    using Pairs = std::vector<std::pair<Index, Index>>;
    Pairs pairs = collected<std::pair<Index, Index>>(
        mesh.facet_count(), chunks::quick, [&](std::size_t begin, std::size_t end, Pairs& part) {
            for (std::size_t f = begin; f < end; ++f) {
                const auto facet = mesh.facet(f);
                for (std::size_t i = 0; i < facet.size(); ++i) {
                    const Index a = facet[i], b = facet[i + 1 == facet.size() ? 0 : i + 1];
                    if (marked[a]) part.emplace_back(a, b);
                    if (marked[b]) part.emplace_back(b, a);
                }
            }
        });
    sort_unique(pairs);
    return pairs;
}

} // namespace

std::size_t draw_in_spikes(const Octree& octree, const OctreeLevel& level, std::span<const Index> voxel,
                           PolygonMesh& mesh) {
    const PointsNear points(octree, level);
    const auto is_far = [&](Index v) { return points.none(mesh.positions[v], voxel[mesh.origin[v]]); };
    std::vector<std::uint8_t> used = large_vector<std::uint8_t>(mesh.vertex_count());
    for_each_in_order(mesh.corners.size(), [&](std::size_t c) { used[mesh.corners[c]] = 1; });
    std::vector<Index> far =
        indices_where(mesh.vertex_count(), chunks::usual, [&](Index v) { return used[v] != 0 && is_far(v); });
    const std::size_t found = far.size();
    if (found == 0) return 0;
    const std::vector<std::pair<Index, Index>> neighbors = neighbors_of(far, mesh);
    std::vector<Vec3> moved;
    for (int round = 0; round < spikes::rounds && !far.empty(); ++round) {
        moved.resize(far.size());
        for_each_index(far.size(), chunks::heavy, [&](Index i) {
            const auto begin =
                std::lower_bound(neighbors.begin(), neighbors.end(), std::pair(far[i], Index{0}));
            Vec3 sum(0, 0, 0);
            auto at = begin;
            for (; at != neighbors.end() && at->first == far[i]; ++at) sum += mesh.positions[at->second];
            moved[i] = 0.5 * (mesh.positions[far[i]] + sum / static_cast<double>(at - begin));
        });
        for (std::size_t i = 0; i < far.size(); ++i) mesh.positions[far[i]] = moved[i];
        std::erase_if(far, [&](Index v) { return !is_far(v); });
    }
    return found;
}

} // namespace hsdm
