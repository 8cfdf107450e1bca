#include "hsdm/contour/spikes.hh"

#include "hsdm/contour/constants.hh"
#include "hsdm/core/chunks.hh"
#include "hsdm/core/large_vector.hh"
#include "hsdm/mesh/vertex_neighbors.hh"
#include "hsdm/octree/constants.hh"

#include <algorithm>
#include <cmath>

namespace hsdm {
namespace {

/// Says whether a place is far from all points.
class PointsNear {
public:
    PointsNear(const Octree& octree, const OctreeLevel& level) : octree_(octree), level_(level) {}

    /// `own`: the voxel that what lies at the place stands for, which the place may have left.
    bool none(const Vec3& place, Index own) const {
        const double usual = spikes::farthest * level_.voxel_size;
        if (holds(own, place, usual)) return false;
        const double within = std::max(usual, spacings::beside * spacing_around(own));
        return !any_around(level_.coord(own), place, within) && !any_around(coord_of(place), place, within);
    }

private:
    double count(Index v) const { return level_.first_point[v + 1] - level_.first_point[v]; }

    VoxelCoord coord_of(const Vec3& place) const {
        VoxelCoord c{};
        for (unsigned a = 0; a < 3; ++a) c[a] = static_cast<int>(std::floor(place[a] / level_.voxel_size));
        return c;
    }

    bool holds(Index v, const Vec3& place, double within) const {
        if (v == no_index) return false;
        for (Index p = level_.first_point[v]; p < level_.first_point[v + 1]; ++p)
            if ((octree_.positions[p] - place).sqrnorm() <= within * within) return true;
        return false;
    }

    bool any_around(const VoxelCoord& c, const Vec3& place, double within) const {
        return holds(level_.find(c), place, within)
               || std::ranges::any_of(neighbor_offsets, [&](const VoxelCoord& o) {
                      return holds(level_.find({c[0] + o[0], c[1] + o[1], c[2] + o[2]}), place, within);
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
    std::vector<std::uint8_t> marked = large_vector<std::uint8_t>(mesh.vertex_count());
    for (const Index v : far) marked[v] = 1;
    const VertexNeighbors neighbors(mesh, marked);
    std::vector<Vec3> moved;
    for (int round = 0; round < spikes::rounds && !far.empty(); ++round) {
        moved.resize(far.size());
        for_each_index(far.size(), chunks::heavy, [&](Index i) {
            const auto beside = neighbors.of(far[i]);
            Vec3 sum(0, 0, 0);
            for (const Index w : beside) sum += mesh.positions[w];
            moved[i] = 0.5 * (mesh.positions[far[i]] + sum / static_cast<double>(beside.size()));
        });
        for (std::size_t i = 0; i < far.size(); ++i) mesh.positions[far[i]] = moved[i];
        std::erase_if(far, [&](Index v) { return !is_far(v); });
    }
    return found;
}

} // namespace hsdm
