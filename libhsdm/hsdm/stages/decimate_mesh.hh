#pragma once
// Fewer facets, with sharp edges and boundaries kept: quadric error metrics in OpenMesh's decimater.

#include "hsdm/mesh_types.hh"

#include <cstddef>
#include <limits>

namespace hsdm {

/// Decimation ends when as few facets are left as asked for, or when no collapse is left that the bound and
/// the sharp edges allow.
struct DecimationOptions {
    std::size_t facets = 0; ///< triangles to come down to
    /// > 0: no vertex of the mesh given comes to lie farther than this from the triangles that take its
    /// place, in the mesh's units.
    double max_error = std::numeric_limits<double>::infinity();
    double crease_angle = 0.61; ///< radians, (0, pi): no unmarked edge becomes sharper (35 degrees)
    double corner_angle = 1.05; ///< radians, (0, pi): no crease or boundary turns by more where a vertex goes
};

struct DecimationCounts {
    std::size_t before = 0; ///< triangles that the facets were cut into
    std::size_t after = 0;  ///< triangles left
};

/// Cuts the mesh's facets into triangles (triangle_mesh) and collapses edges of the least quadric error
/// (Garland, Heckbert 1997), onto one of their ends, as long as the options and ModFeatureT allow. Sharp
/// edges are those with the status bit `feature`; they and the boundary count as if a plane stood on them, so
/// that curved ones keep their shape. Elements are numbered anew. O(n log n). Throws OptionError.
DecimationCounts decimate_mesh(PolyMesh& mesh, const DecimationOptions& options);

} // namespace hsdm
