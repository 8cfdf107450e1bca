#pragma once
// A noisy cloud's points moved onto the surface that they scatter about.

#include "hsdm/core/occurrences.hh"
#include "hsdm/normals/constants.hh"
#include "hsdm/normals/outliers.hh"

namespace hsdm {

struct SmoothOptions {
    /// >= 0, in spacings: a cloud with less noise (standard deviation) stays as it is
    double least_noise = smoothing::least_noise;
    /// > 1: ratio of a moved point's reach to the median reach of its neighbours beyond which it was left
    /// between two sheets and is removed
    double most_stretch = distance_outliers::doubtful_stretch;
};

struct SmoothReport {
    double noise = 0;    ///< standard deviation in the cloud's units; 0 if no point was moved
    Occurrences between; ///< points removed because they came to lie on no sheet
};

/// Takes the noise out of a noisy cloud and renews its neighbours; leaves other clouds alone. O(n), parallel.
/// Throws OptionError.
SmoothReport smooth_noise(Octree& octree, Neighbors& neighbors, const SmoothOptions& options = {});

/// Does it take out noise of that standard deviation (in the cloud's units)? Throws OptionError.
bool is_noisy(const Octree& octree, double noise, const SmoothOptions& options = {});

/// The same for a known standard deviation of the noise (> 0), however small. Points are moved with
/// smooth_points; those that came to lie between sheets, farther from others than these from each other, are
/// removed (twice, because some lie there in pairs). Normals stay with their points. `neighbors` becomes that
/// of the points left, whatever it held before. O(n), parallel. Throws OptionError.
SmoothReport smooth_known_noise(Octree& octree, double noise, Neighbors& neighbors,
                                const SmoothOptions& options = {});

/// The outliers among moved points that the last function removes.
OutlierOptions outliers_between_sheets(const SmoothOptions& options = {});

/// Moves every point onto the plane fitted to its surroundings, along the plane's normal. The surroundings
/// reach four standard deviations of the noise (in the cloud's units, > 0), farther if that holds too few
/// points for a steady plane; points more than four deviations off the plane belong to another sheet. Sums
/// over voxels, whose edge follows that reach, stand for the points, so the cost does not depend on how many
/// points they hold. The moves tell what the noise was: if clearly less, it is all done again with that. Then
/// points are moved along the normals until they lie in the middle of where they came from: a plane through a
/// bent sheet lies on its hollow side. Of an octree without normals whose points scatter about a sheet as
/// about the two sides of a wall they are moved onto these (docs/normals.md, Noise). The octree's points are
/// sorted anew. Returns the noise, of two sheets that of each. O(n), parallel.
double smooth_points(Octree& octree, double noise);

} // namespace hsdm
