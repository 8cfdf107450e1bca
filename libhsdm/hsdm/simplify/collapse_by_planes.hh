#pragma once
// Collapses edges where one vertex meets the planes of both ends (quadrics): over flat ground, along straight
// creases, along a cylinder. Leaves are cubes; facets need not be.

#include "hsdm/simplify/collapsing_mesh.hh"
#include "hsdm/simplify/quadric.hh"

#include <vector>

namespace hsdm {

/// A collapse made: the start of a side of the triangles that the mesh is cut into merged into its end, which
/// moved to a place.
struct PlaneCollapse {
    Index side;
    Index vertex, onto;
    Vec3 place;
};

/// Merges inner vertices into neighbours, over short edges first, where a place misses the planes of either
/// by no more than the smaller `tolerance` of both (root mean square, the mesh's units; a vertex with
/// tolerance 0 stays, and nothing merges into it). The neighbour stays where it is if that is as good, else
/// it moves to that place, and it has the planes of both from then on. A 2-manifold keeps its topology (link
/// condition); no facet turns or gets thinner than the thinnest there, except where folds are undone. Facets
/// that change come out as triangles. At the end vertices that carry nothing are removed
/// (remove_flat_vertices). `planes` and `tolerance` have an entry per vertex. `plane_collapses` returns the
/// collapses made; if it holds some of the same mesh with larger tolerances, these are repeated as far as
/// tolerances allow, and others are looked for only beside those that cannot be. O(n log n) in each of two
/// times 32 sweeps at most, of fewer edges each.
CollapsedMesh collapse_by_planes(CollapsingMesh mesh, std::vector<Quadric> planes,
                                 std::vector<double> tolerance, std::vector<PlaneCollapse>& plane_collapses);

} // namespace hsdm
