#include "hsdm/completion/slits.hh"

#include "hsdm/completion/constants.hh"
#include "hsdm/mesh/area_vector.hh"
#include "hsdm/mesh/triangulate.hh"

#include <algorithm>
#include <cmath>

namespace hsdm {
namespace {

/// Loops as facets over vertices of their own: side i of all begins at vertex i.
PolygonMesh facets_over(const PolygonMesh& mesh, const BoundaryLoops& loops) {
    PolygonMesh facets;
    std::vector<Index> corners;
    for (std::size_t l = 0; l < loops.size(); ++l) {
        corners.clear();
        for (Index v : loops[l]) {
            corners.push_back(static_cast<Index>(facets.positions.size()));
            facets.positions.push_back(mesh.positions[v]);
        }
        facets.add_facet(corners);
    }
    return facets;
}

Vec3 area_vector_of(const PolygonMesh& mesh, const Triangle& t) {
    return 0.5
           * ((mesh.positions[t[1]] - mesh.positions[t[0]]) % (mesh.positions[t[2]] - mesh.positions[t[0]]));
}

/// The part of the loops that `is_chosen(loop)`.
template <class IsChosen>
BoundaryLoops chosen_loops(const BoundaryLoops& loops, const IsChosen& is_chosen) {
    BoundaryLoops chosen;
    for (std::size_t l = 0; l < loops.size(); ++l) {
        if (!is_chosen(l)) continue;
        for (Index i = loops.begin[l]; i < loops.begin[l + 1]; ++i) {
            chosen.vertices.push_back(loops.vertices[i]);
            chosen.facets.push_back(loops.facets[i]);
        }
        chosen.begin.push_back(static_cast<Index>(chosen.vertices.size()));
    }
    return chosen;
}

} // namespace

BoundaryLoops narrow_loops(const PolygonMesh& mesh, const BoundaryLoops& loops, double widest) {
    // What closes a loop has at least the area of the loop's area vector: most borders need not be filled.
    const BoundaryLoops candidates = chosen_loops(loops, [&](std::size_t l) {
        return loops[l].size() >= 3
               && 2 * area_vector(mesh, loops[l]).norm() <= widest * length_of(mesh, loops[l]);
    });
    const PolygonMesh closing = facets_over(mesh, candidates);
    const Triangulation cut = triangulate(closing);
    return chosen_loops(candidates, [&](std::size_t l) {
        double area = 0, length = 0, agreeing = 0;
        const Index begin = candidates.begin[l], end = candidates.begin[l + 1];
        for (Index t = cut.first[l]; t < cut.first[l + 1]; ++t) {
            const Triangle& corners = cut.triangles[t];
            const Vec3 vector = area_vector_of(closing, corners);
            area += vector.norm();
            for (std::size_t i = 0; i < 3; ++i) {
                const Index from = corners[i], to = corners[(i + 1) % 3];
                if (to != (from + 1 == end ? begin : from + 1)) continue;
                const double side = (closing.positions[to] - closing.positions[from]).norm();
                length += side;
                agreeing +=
                    side * (unit(vector) | unit(area_vector(mesh, mesh.facet(candidates.facets[from]))));
            }
        }
        return 4 * area <= widest * length && length * length >= slits::least_slenderness * 2 * area
               && agreeing > slits::least_agreement * length;
    });
}

CompletedPoints points_across(const PolygonMesh& mesh, const BoundaryLoops& loops, double voxel_size) {
    const PolygonMesh closing = facets_over(mesh, loops);
    CompletedPoints points;
    for (const Triangle& corners : triangulate(closing).triangles) {
        const Vec3 vector = area_vector_of(closing, corners);
        if (!(vector.norm() > 0)) continue;
        const Vec3 &a = closing.positions[corners[0]], &b = closing.positions[corners[1]],
                   &c = closing.positions[corners[2]];
        // n (n + 1) / 2 of the n^2 alike triangles that it consists of have a point each.
        const int n = std::max(
            1, static_cast<int>(std::ceil(std::sqrt(2 * vector.norm()) * completing::samples / voxel_size)));
        for (int i = 0; i < n; ++i)
            for (int k = 0; i + k < n; ++k) {
                points.positions.push_back(a + (b - a) * ((i + 1.0 / 3) / n) + (c - a) * ((k + 1.0 / 3) / n));
                points.normals.push_back(unit(vector));
            }
    }
    return points;
}

} // namespace hsdm
