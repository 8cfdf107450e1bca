#pragma once
// Facets over leaves of different size, cut and joined anew over the same vertices.

#include "hsdm/simplify/remeshed_groups.hh"
#include "hsdm/simplify/tolerance_envelope.hh"

#include <span>

namespace hsdm {

enum class Diagonals { may_flip, stay };

struct RemeshCounts {
    std::size_t flipped = 0; ///< diagonals laid the other way
    std::size_t joined = 0;  ///< pairs of triangles that became quads
};

/// Cuts quads into triangles, lays diagonals where they are near the fine surface (so along creases) and
/// otherwise so that triangles are well shaped, and joins flat pairs of triangles to convex quads, those
/// first that are nearest to rectangles. What is in the band round the fine surface, or no more than its
/// tolerance off a plane, counts as on it. A 2-manifold remains one with the same vertices; facets of which
/// all vertices are `settled`, and those of more than four corners, stay. At the end quads with a reflex
/// corner, wherever they are, are cut in two. O(corners log corners).
///
/// `before`: what became of another mesh's facets, with the same surface and kind of diagonals; where this
/// one has the same it becomes the same, and only what changed, and what is beside it, is looked at; unless
/// that does not go together, when all is looked at. It is replaced by what this mesh's became.
RemeshCounts remesh_by_flips(PolygonMesh& mesh, ToleranceEnvelope& fine,
                             std::span<const std::uint8_t> settled, Diagonals diagonals,
                             RemeshedGroups& before);
RemeshCounts remesh_by_flips(PolygonMesh& mesh, ToleranceEnvelope& fine,
                             std::span<const std::uint8_t> settled,
                             Diagonals diagonals = Diagonals::may_flip);

} // namespace hsdm
