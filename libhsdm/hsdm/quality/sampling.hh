#pragma once
// How a cloud samples its surface: how densely, how evenly, and how much of it is on no surface at all.

#include "hsdm/point_cloud.hh"
#include "hsdm/quality/percentiles.hh"

namespace hsdm {

/// How closely to look.
struct SamplingOptions {
    int neighbors = 8; ///< nearest others whose mean distance tells of outliers, [1, 64]
    /// medians of that mean distance over the cloud, > 1: farther off a point is isolated. No more than one
    /// in a thousand points of scans without outliers is three medians off, and 85 of 100 strays are.
    double isolation = 3;
    /// places that are looked at, evenly taken along a space-filling curve if there are more; > 0
    std::size_t most = 1000000;
};

/// Lengths are in the cloud's units. Points at one place count once, but for `duplicates`.
struct Sampling {
    double spacing = 0;         ///< side of the square of surface that each point stands for
    Percentiles nearest;        ///< of the distances from each place to the nearest other
    std::size_t duplicates = 0; ///< points at exactly the place of an earlier one
    double isolated = 0;        ///< share of places whose neighbours are more than `isolation` medians away
    /// share of places whose neighbours are farther than the cloud's mean and three standard deviations: the
    /// statistical outliers of Rusu et al. 2008. Gross outliers hide others here, for they widen the
    /// deviation.
    double statistical_outliers = 0;
};

/// Measures a cloud; all but `duplicates` is zero if it has no two places. O(n log n), parallel, the same
/// bits for any number of threads. Throws OptionError, Error as check_arrays() and for coordinates that are
/// not finite or a cloud that is out of reach of double precision.
Sampling measure_sampling(const PointCloud& cloud, const SamplingOptions& options = {});

} // namespace hsdm
