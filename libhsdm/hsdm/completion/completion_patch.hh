#pragma once
// The missing surface as a net of quads that the mesh's border holds.

#include "hsdm/completion/completion_field.hh"

namespace hsdm {

/// Quads with a vertex in each lattice cell that the surface passes (surface nets: Gibson, 1998): the missing
/// surface, and the mesh some cells around its border.
struct CompletionPatch {
    PolygonMesh net;                   ///< quads, facing outward
    std::vector<Vec3> normals;         ///< of held vertices: the mesh's
    std::vector<std::uint8_t> held;    ///< per vertex: does it lie on the mesh?
    std::vector<std::uint8_t> missing; ///< per quad: is it of the missing surface?
};

/// The patch between the field's two sides, held by a mesh with that border. O(grid points).
CompletionPatch completion_patch(const CompletionField& field, const PolygonMesh& mesh,
                                 const BoundaryLoops& border);

/// Moves the vertices that are not held: to a membrane over the border first; then to a thin plate, which
/// continues the slope of the mesh where the membrane leaves it at less than 58 degrees, and meets it in a
/// crease elsewhere (after Kobbelt, Campagna, Vorsatz, Seidel, Interactive multi-resolution modeling, 1998).
/// Vertices that would enter known space, and some around them, stay where the field put them.
void fair(CompletionPatch& patch, const KnownSpace& space = {});

/// The same for a patch that fairing would take through the mesh or through itself: vertices that would pass
/// there, and some around them, stay where the field put them, which is beside the mesh. No nearer to what is
/// missing than fair() where that crosses little, as the field keeps far from the mesh.
void fair_beside(const PolygonMesh& mesh, CompletionPatch& patch, const KnownSpace& space = {});

} // namespace hsdm
