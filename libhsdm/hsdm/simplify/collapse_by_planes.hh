#pragma once
// Vertices merged into neighbours that lie on all of their planes: over flat ground, along straight creases,
// along a cylinder. Leaves are cubes; facets need not be.

#include "hsdm/simplify/collapsing_mesh.hh"
#include "hsdm/simplify/quadric.hh"

#include <vector>

namespace hsdm {

/// A vertex that another, at the end of a side of the triangles that the mesh is cut into, stands for, there.
struct PlaneCollapse {
    Index side;
    Index vertex, onto;
    Vec3 place;
};

/// Merges inner vertices into neighbours, over short edges first, where a place misses the planes of either
/// by no more than the smaller `tolerance` of both (root mean square, the mesh's units; a vertex with 0
/// stays, and nothing merges into it); the neighbour moves there unless it is as good where it is, and stands
/// for both from then on. A 2-manifold keeps its topology (link condition), no facet turns or
/// gets thinner than all were, but where folds are undone; what changes comes out as triangles. Vertices that
/// then carry nothing go (remove_flat_vertices). `planes` and `tolerance` have an entry per vertex.
/// `plane_collapses`: those made; if there are some before, of the same mesh with larger tolerances, these
/// are repeated as far as tolerances allow and others are looked for only beside those that cannot be. O(n
/// log n) in each of two times 32 sweeps at most, of fewer edges each.
CollapsedMesh collapse_by_planes(CollapsingMesh mesh, std::vector<Quadric> planes,
                                 std::vector<double> tolerance, std::vector<PlaneCollapse>& plane_collapses);

} // namespace hsdm
