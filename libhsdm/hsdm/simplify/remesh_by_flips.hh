#pragma once
// Remeshes facets over leaves of different size by edge flips and by joining triangles, over the same
// vertices.

#include "hsdm/simplify/remeshed_groups.hh"
#include "hsdm/simplify/tolerance_envelope.hh"

#include <span>

namespace hsdm {

enum class Diagonals { may_flip, stay };

struct RemeshCounts {
    std::size_t flipped = 0; ///< diagonals flipped
    std::size_t joined = 0;  ///< pairs of triangles joined to quads
};

/// Cuts quads into triangles, flips diagonals so that they lie on the fine surface (so along creases) and
/// else so that triangles are well shaped, and joins flat pairs of triangles to convex quads, those nearest
/// to rectangles first. Diagonals in the envelope `fine`, or of quads no more than its tolerance off a plane,
/// count as on the surface. A 2-manifold remains one with the same vertices. Facets of which all vertices are
/// `fixed`, and those of more than four corners, stay. At the end quads with a reflex corner, wherever they
/// are, are cut in two. O(corners log corners).
///
/// `before`: the groups of another mesh that was remeshed with the same surface and `diagonals`. Groups of
/// facets that this mesh has too (find_unchanged) get the same result without being looked at, only changed
/// facets and those beside them are remeshed; if the results do not fit together, all are. On return it holds
/// the groups of this mesh.
RemeshCounts remesh_by_flips(PolygonMesh& mesh, const ToleranceEnvelope& fine,
                             std::span<const std::uint8_t> fixed, Diagonals diagonals,
                             RemeshedGroups& before);
RemeshCounts remesh_by_flips(PolygonMesh& mesh, const ToleranceEnvelope& fine,
                             std::span<const std::uint8_t> fixed, Diagonals diagonals = Diagonals::may_flip);

} // namespace hsdm
