#pragma once
// Completion: the surface that no scanner saw, as points with normals.

#include "hsdm/completion/completion_field.hh"

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
/// The same where the mesh's boundary loops are known. `empty`: is a place known to hold nothing, as a
/// scanner looked through it? The surface does not close it off.
CompletedPoints complete_surface(const PolygonMesh& mesh, const BoundaryLoops& loops, double voxel_size,
                                 Passing passing = Passing::ignored,
                                 const std::function<bool(const Vec3&)>& empty = {});

} // namespace hsdm
