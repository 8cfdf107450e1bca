#include "hsdm/contour/wide_holes.hh"

#include "hsdm/contour/constants.hh"
#include "hsdm/core/chunks.hh"
#include "hsdm/mesh/area_vector.hh"

#include <algorithm>
#include <limits>
#include <numbers>
#include <tuple>
#include <utility>

namespace hsdm {
namespace {

/// Summed in the order of their coordinates, whatever theirs is.
Vec3 middle_of(std::vector<Vec3> places) {
    std::ranges::sort(places, [](const Vec3& a, const Vec3& b) {
        return std::tuple(a[0], a[1], a[2]) < std::tuple(b[0], b[1], b[2]);
    });
    Vec3 sum(0, 0, 0);
    for (const Vec3& p : places) sum += p;
    return sum / static_cast<double>(places.size());
}

std::vector<Vec3> positions_of(const PolygonMesh& mesh, std::span<const Index> vertices) {
    std::vector<Vec3> positions;
    for (const Index v : vertices) positions.push_back(mesh.positions[v]);
    return positions;
}

std::vector<Index> vertices_of(const PolygonMesh& mesh, std::size_t begin, std::size_t end) {
    std::vector<Index> vertices;
    for (std::size_t f = begin; f < end; ++f)
        for (const Index v : mesh.facet(f)) vertices.push_back(v);
    sort_unique(vertices);
    return vertices;
}

} // namespace

double missing_points(const Octree& octree, const OctreeLevel& level, std::span<const Index> voxel,
                      const PolygonMesh& mesh, std::span<const Index> hole) {
    const Vec3 middle = middle_of(positions_of(mesh, hole));
    std::vector<Index> voxels; // around it, each once
    for (const Index v : hole) {
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
    return std::numbers::pi * nearest * points / squares;
}

Occurrences wide_holes(const Octree& octree, const OctreeLevel& level, std::span<const Index> voxel,
                       const PolygonMesh& mesh, const FillHolesCounts& filled) {
    Occurrences wide;
    for (std::size_t i = 0; i < filled.first.size(); ++i) {
        const std::size_t end = i + 1 < filled.first.size() ? filled.first[i + 1] : mesh.facet_count();
        const std::vector<Index> hole = vertices_of(mesh, filled.first[i], end);
        if (missing_points(octree, level, voxel, mesh, hole) > holes::least_missing)
            wide.add({1, middle_of(positions_of(mesh, hole))});
    }
    return wide;
}

} // namespace hsdm
