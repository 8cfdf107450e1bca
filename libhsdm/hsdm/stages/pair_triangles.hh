#pragma once
// Triangles to quads, as modellers want them.

#include "hsdm/mesh_types.hh"

#include <cstddef>

namespace hsdm {

struct PairingOptions {
    /// radians, (0, pi): pairs that bend more at their common edge stay two triangles. 20 degrees.
    double max_bend = 0.35;
    /// radians, (0, pi/2]: a quad's corners differ by less from right angles. 60 degrees.
    double max_skew = 1.05;
};

/// Joins pairs of triangles to convex quads, first those whose corners are nearest to right angles, never
/// across an edge with the status bit `feature`. Facets are numbered anew. Returns the number of quads made.
/// O(n log n). Throws OptionError.
std::size_t pair_triangles(PolyMesh& mesh, const PairingOptions& options = {});

} // namespace hsdm
