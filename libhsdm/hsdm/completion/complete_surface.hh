#pragma once
// Completion: the surface that no scanner saw, as points with normals.

#include "hsdm/completion/completion_field.hh"

#include <functional>
#include <limits>

namespace hsdm {

struct CompletedPoints {
    std::vector<Vec3> positions;
    std::vector<Vec3> normals; ///< per point, unit, outward
};

/// Points of the surface that closes a mesh (an oriented 2-manifold, facets outward) where it has boundary
/// loops: it separates inside from outside, joins loops that face each other, and continues the mesh's slope
/// or meets it in a crease. Three points to a voxel each way. None for a closed mesh. O(facets + missing
/// area). Throws OptionError for a voxel size that is not positive, or less than the mesh's extent over 2^17.
CompletedPoints complete_surface(const PolygonMesh& mesh, double voxel_size);
/// What becomes of a completion that would pass through the mesh or through itself.
enum class Passing {
    ignored, ///< it passes: where that is little, what makes facets of the points mends it
    stopped, ///< there it stays beside the mesh, less smooth and farther from what is missing; no bores
};
struct CompleteOptions {
    Passing passing = Passing::ignored;
    /// Is a place known to hold nothing, as a scanner looked through it? The surface does not close it off.
    std::function<bool(const Vec3&)> empty{};
    std::size_t most_bytes = std::numeric_limits<std::size_t>::max(); ///< that it may take beside the mesh
};
/// The same where the mesh's boundary loops are known. Throws Error if it takes more memory, as reckoned.
CompletedPoints complete_surface(const PolygonMesh& mesh, const BoundaryLoops& loops, double voxel_size,
                                 const CompleteOptions& options = {});

} // namespace hsdm
