#include "hsdm/contour/wide_holes.hh"

#include "hsdm/contour/constants.hh"
#include "hsdm/core/chunks.hh"
#include "hsdm/mesh/area_vector.hh"

#include <algorithm>
#include <limits>
#include <numbers>

namespace hsdm {
namespace {

/// The facets [begin, end) that close a loop, and the voxels around them, each once.
struct ClosedHole {
    Vec3 middle{0, 0, 0};
    std::vector<Index> voxels;

    ClosedHole(const OctreeLevel& level, std::span<const Index> voxel, const PolygonMesh& mesh,
               std::size_t begin, std::size_t end) {
        std::vector<Index> vertices;
        for (std::size_t f = begin; f < end; ++f)
            for (const Index v : mesh.facet(f)) vertices.push_back(v);
        sort_unique(vertices);
        for (const Index v : vertices) {
            middle += mesh.positions[v] / static_cast<double>(vertices.size());
            const Index own = voxel[mesh.origin[v]];
            voxels.push_back(own);
            for_neighbors(level, own, [&](Index w) { voxels.push_back(w); });
        }
        sort_unique(voxels);
    }
};

/// How many points should lie in the disc about a hole's middle in which none does. Borders cut some of the
/// voxels whose density is taken, so these are rather too few.
double missing_points(const Octree& octree, const OctreeLevel& level, const ClosedHole& hole) {
    double nearest = std::numeric_limits<double>::infinity(), points = 0; // the former squared
    for (const Index v : hole.voxels)
        for (Index p = level.first_point[v]; p < level.first_point[v + 1]; ++p, ++points)
            nearest = std::min(nearest, (octree.positions[p] - hole.middle).sqrnorm());
    const double squares = static_cast<double>(hole.voxels.size()) * level.voxel_size * level.voxel_size;
    return std::numbers::pi * nearest * points / squares;
}

} // namespace

Occurrences wide_holes(const Octree& octree, const OctreeLevel& level, std::span<const Index> voxel,
                       const PolygonMesh& mesh, const FillHolesCounts& filled) {
    Occurrences wide;
    for (std::size_t i = 0; i < filled.first.size(); ++i) {
        const std::size_t end = i + 1 < filled.first.size() ? filled.first[i + 1] : mesh.facet_count();
        const ClosedHole hole(level, voxel, mesh, filled.first[i], end);
        if (missing_points(octree, level, hole) > holes::least_missing) wide.add({1, hole.middle});
    }
    return wide;
}

} // namespace hsdm
