#pragma once
// Removes self-intersections by moving vertices.

#include "hsdm/contour/constants.hh"
#include "hsdm/spatial/facet_cells.hh"

namespace hsdm {

struct UntangleOptions {
    /// at most so many, >= 0; 0 only counts intersections
    int rounds = untangling::rounds;
    /// (0, 1]: share of the way a vertex moves to the mean of its neighbours in a round
    double step = untangling::step;
    double reach =
        0; ///< how far a vertex may move in all, in the mesh's units; 0: as far as the rounds take it
    double nearby = 0; ///< facets this close to a moved one are checked against it, in the mesh's units, > 0
};

struct UntangleCounts {
    std::size_t before = 0; ///< pairs of triangles that intersected
    std::size_t after = 0;  ///< pairs that still do
    std::size_t pairs = 0;  ///< of facets that still do, as far as those near moved ones were looked at
    std::size_t moved = 0;  ///< vertices moved or merged, and quads cut
    Vec3 first{0, 0, 0};    ///< a corner of the first facet that still meets another; anything if none does
};

/// Moves the vertices of facets that intersect others towards the mean of their neighbours, round by round,
/// as long as that leaves fewer intersections; after the first search only facets near the trouble are tested
/// again. Connectivity is untouched. O(t log t) for the first search, then O(facets near by) a round; the
/// same for any number of threads. `cells`: those of the mesh, which speed up the search if facets are about
/// as large as cells; they stay valid if no vertex moves. Throws OptionError.
UntangleCounts untangle(PolygonMesh& mesh, const UntangleOptions& options, const FacetCells* cells = nullptr);

/// Changes facets that still intersect others, one place at a time, as long as each change leaves fewer
/// intersections: unites two facets that are folded onto each other round vertices of no third, merges two
/// vertices, cuts a facet in two, or fills the border of a disc of facets anew. The topology stays. Nothing
/// is tried if more than `most_pairs` pairs of facets intersect. Merged vertices become isolated; the facets
/// around come to be the mesh's last. `nearby`: as above. O(t log t + facets near by * changes tried).
UntangleCounts mend_tangles(PolygonMesh& mesh, double nearby,
                            std::size_t most_pairs = untangling::most_pairs);

} // namespace hsdm
