#include "hsdm/contour/wide_holes.hh"

#include "hsdm/core/chunks.hh"

#include <algorithm>
#include <limits>
#include <numbers>
#include <tuple>

namespace hsdm {
namespace {

/// Of the vertices, summed in the order of their coordinates, whatever their numbers.
Vec3 middle_of(const PolygonMesh& mesh, std::span<const Index> vertices) {
    std::vector<Vec3> positions;
    for (const Index v : vertices) positions.push_back(mesh.positions[v]);
    std::ranges::sort(positions, {}, [](const Vec3& p) { return std::tuple(p[0], p[1], p[2]); });
    Vec3 sum(0, 0, 0);
    for (const Vec3& p : positions) sum += p;
    return sum / static_cast<double>(positions.size());
}

} // namespace

HoleMiddle middle_of_hole(const Octree& octree, const OctreeLevel& level, std::span<const Index> voxel,
                          const PolygonMesh& mesh, std::span<const Index> loop) {
    const Vec3 middle = middle_of(mesh, loop);
    std::vector<Index> voxels; // around it, each once
    for (const Index v : loop) {
        const Index own = voxel[mesh.origin[v]];
        voxels.push_back(own);
        for_neighbors(level, own, [&](Index w) { voxels.push_back(w); });
    }
    sort_unique(voxels);
    double nearest = std::numeric_limits<double>::infinity(), points = 0; // the former squared
    for (const Index v : voxels)
        for (Index p = level.first_point[v]; p < level.first_point[v + 1]; ++p, ++points)
            nearest = std::min(nearest, (octree.positions[p] - middle).sqrnorm());
    const double squares = static_cast<double>(voxels.size()) * level.voxel_size * level.voxel_size;
    return {middle, std::numbers::pi * nearest * points / squares};
}

} // namespace hsdm
