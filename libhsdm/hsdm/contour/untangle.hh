#pragma once
// Self-intersections that vertex positions cause, taken back by moving those vertices.

#include "hsdm/contour/constants.hh"
#include "hsdm/spatial/facet_cells.hh"

namespace hsdm {

struct UntangleOptions {
    /// at most, >= 0; 0 only counts
    int rounds = untangling::rounds;
    /// (0, 1]: share of the way a vertex moves to the mean of its neighbours in a round
    double step = untangling::step;
    double reach =
        0; ///< how far a vertex may move in all, in the mesh's units; 0: as far as the rounds take it
    double nearby = 0; ///< facets this close to a moved one are checked against it, in the mesh's units, > 0
};

struct UntangleCounts {
    std::size_t before = 0; ///< pairs of triangles that intersected
    std::size_t after = 0;  ///< that still do
    std::size_t moved = 0;  ///< vertices
};

/// Moves the vertices of facets that intersect others towards the mean of their neighbours, round by round,
/// as long as that leaves fewer intersections; only the neighbourhood of the trouble is looked at again.
/// Connectivity is untouched. O(t log t) for the search, then O(the neighbourhoods) a round; the same for any
/// number of threads. `cells`: the mesh's, if its facets are about as large, to find intersections sooner;
/// they are the mesh's still if none is moved. Throws OptionError.
UntangleCounts untangle(PolygonMesh& mesh, const UntangleOptions& options, const FacetCells* cells = nullptr);

} // namespace hsdm
