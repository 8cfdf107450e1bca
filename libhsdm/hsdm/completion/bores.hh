#pragma once
// Bores whose wall nobody saw in the middle: ends that go on to each other.

#include "hsdm/completion/complete_surface.hh"

namespace hsdm {

/// What joins the ends of bores.
struct Bores {
    std::vector<Index> loops; ///< numbers of the boundary loops that are closed so
    PolygonMesh walls;        ///< triangles about a voxel long, facing as the mesh; each has its own vertices
};

/// The boundary loops that are two ends of one bore: at each, the mesh is a wall round an axis that it faces,
/// and goes on along that, a straight one, to the other end: no farther off at its arrival than a quarter of
/// the bore's radius, and as wide up to as much. Of several ends on one axis the nearest belong together. Two
/// blind ends that point at each other so exactly are less likely than one bore. A loop whose sides are the
/// two ends, as strips of the wall were seen between them, is closed alike. What lies between two ends is
/// ruled; where that is `empty` for the most part, as scanners looked through it, the ends are two holes.
/// Bores whose walls meet, or have most of another loop on them, are left: there something else enters
/// (continued_space.hh).
/// `mesh`: facets outward. O(loops ^ 2 + their length).
Bores find_bores(const PolygonMesh& mesh, const BoundaryLoops& loops, double voxel_size,
                 const std::function<bool(const Vec3&)>& empty = {});

} // namespace hsdm
