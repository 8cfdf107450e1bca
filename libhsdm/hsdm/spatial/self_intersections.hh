#pragma once
// Self-intersections of a mesh.

#include "hsdm/polygon_mesh.hh"
#include "hsdm/spatial/facet_cells.hh"

#include <array>

namespace hsdm {

struct SelfIntersections {
    std::size_t triangle_pairs = 0; ///< pairs of triangles that meet beside the vertices and edges they share
    std::size_t skipped = 0;        ///< triangles whose corners lie on a line: they take part in no pair
    std::vector<std::array<Index, 2>> facet_pairs; ///< the facets they belong to, lesser index first, sorted,
                                                   ///< each pair once; {f, f} for a facet folded onto itself
    std::vector<std::size_t> triangles_of_pair;    ///< how many pairs of triangles each is
};

/// Finds every pair of triangles (facets cut as the STL writer cuts them) that have a point in common,
/// touching included, other than the vertices and edges they share; corners at exactly the same position
/// count as shared. Exact predicates, so neither rounding nor the number of threads changes the result. O(t
/// log t + pairs of triangles with overlapping boxes), parallel.
SelfIntersections find_self_intersections(const PolygonMesh& mesh);
/// The same, several times faster, by the cells of a mesh whose facets are about as large as its cells, such
/// as those of a uniform octree level and its voxels.
SelfIntersections find_self_intersections(const PolygonMesh& mesh, const FacetCells& cells);

} // namespace hsdm
