#pragma once
// Random solids to reconstruct, each with what its own function says the result should be.

#include "support/sample.hh"

namespace hsdm::support {

/// How large a solid's features are against the voxel. Decided by the solid's function, never by a result:
/// - ill_posed: two pieces of surface that face each other to 15 degrees do so nearer than 0.3 voxel. Edges
/// and
///   grooves sharper than 15 degrees, where primitives graze, are among these.
/// - large: none that face each other to 30 degrees do nearer than two voxels; the Euler characteristic is
/// that
///   of the solid grown and that of the solid shrunk by a voxel, so no neck, gap, hole or piece is thinner
///   than two; and two grids agree.
/// - thin: all others.
enum class FeatureSize { ill_posed, thin, large };

struct Trial {
    std::uint64_t seed;
    FeatureSize size;
    long euler; ///< of the solid's surface, if its features are large
    PointCloud cloud;
};

struct TrialOptions {
    double voxel = 1.0 / 16;
    double thinnest = 2.2, thickest = 5; ///< voxels: walls of the solids
    double points_per_voxel = 12;        ///< per squared voxel of surface: 3.5 spacings to a voxel's edge
};

/// random_solid(seed) as a trial. Deterministic.
Trial make_trial(std::uint64_t seed, const TrialOptions& options = {});

} // namespace hsdm::support
