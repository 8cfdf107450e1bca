#pragma once
// A noisy cloud's points moved onto the surface that they scatter about.

#include "hsdm/core/discarded.hh"
#include "hsdm/normals/constants.hh"
#include "hsdm/normals/neighbors.hh"

namespace hsdm {

struct SmoothOptions {
    /// >= 0, in spacings: a cloud with less (standard deviation) stays as it is
    double least_noise = smoothing::least_noise;
    /// > 1: of a moved point's reach against the median reach of its neighbours; beyond, it was left between
    /// two sheets
    double most_stretch = smoothing::most_stretch;
};

struct SmoothReport {
    double noise = 0;  ///< standard deviation in the cloud's units; 0 if no point was moved
    Discarded between; ///< points removed because they came to lie on no sheet
};

/// Makes a noisy cloud one of little noise, with its neighbours; leaves others alone. O(n), parallel. Throws
/// OptionError.
SmoothReport smooth_noise(Octree& octree, Neighbors& neighbors, const SmoothOptions& options = {});

/// The same for a standard deviation of the noise that is known (> 0), however small. Points are moved with
/// smooth_points, and those that came to lie between sheets, farther from the others than these from each
/// other, are removed (twice, since some lie there in twos). Normals stay with their points. Returns the
/// neighbours of those left in `neighbors`, whatever it held before. O(n), parallel. Throws OptionError.
SmoothReport smooth_known_noise(Octree& octree, double noise, Neighbors& neighbors,
                                const SmoothOptions& options = {});

/// Moves every point along the normal of the plane that its surroundings lie about, onto that plane. The
/// surroundings reach four standard deviations of the noise (in the cloud's units, > 0), farther where that
/// holds too few points for a steady plane; what lies four deviations off the plane is of another sheet. They
/// are sums over voxels whose edge follows that reach, so the cost does not depend on how many points they
/// hold. How far points moved says what the noise was: if it was clearly less, it is done again with that.
/// The octree's points are sorted anew. Returns the noise. O(n), parallel.
double smooth_points(Octree& octree, double noise);

} // namespace hsdm
