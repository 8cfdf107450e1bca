#pragma once
// Untangling part of a larger mesh as it is done in the whole: what is weighed there is added up over parts.

#include "hsdm/contour/mesh_of_part.hh"
#include "hsdm/contour/untangle.hh"
#include "hsdm/core/occurrences.hh"

namespace hsdm {

/// What is to be added up over all parts.
struct TangleCounts {
    /// Pairs that intersect after so many rounds of moving, of triangles and of facets. A pair is of the part
    /// that owns its least voxel.
    std::array<std::uint64_t, untangling::rounds + 1> triangles{}, facets{};
    std::uint64_t changed = 0; ///< pairs of triangles fewer since facets were changed
    Occurrences left;          ///< pairs of triangles in the end
    bool near = false;         ///< some intersected in the part or near by

    void operator+=(const TangleCounts& other);
};

/// What is done about intersections, as sums over all parts have it.
struct TanglePlan {
    int rounds = untangling::rounds; ///< of moving vertices, in [0, untangling::rounds]
    bool weighed = false;            ///< by sums; else all were assumed to come apart
    bool mends = false;              ///< facets are changed
    bool replaces = false;           ///< and are where that leaves them, since some were

    /// Takes the sums over parts that were made by this plan. Returns whether it is another one now, by which
    /// parts with intersections near by are to be made again: what they leave is counted only then.
    bool weigh(const TangleCounts& sums);
};

/// As untangle() and, where the plan says so, mend_tangles() of the whole, but for `left`. `of`: the same
/// mesh. `cells` are those of the mesh. `moved` becomes true if it may have changed.
TangleCounts untangle_part(PolygonMesh& mesh, const MeshOfPart& of, const UntangleOptions& options,
                           const TanglePlan& plan, const FacetCells& cells, bool& moved);

/// The part's own pairs of triangles that intersect. O(t log t).
Occurrences own_intersections(const MeshOfPart& of);

} // namespace hsdm
