#pragma once
// Two of surfaces and clouds: how far each is from the other.

#include "hsdm/quality/distance.hh"
#include "hsdm/quality/percentiles.hh"

namespace hsdm {

/// How closely to look.
struct CompareOptions {
    std::size_t samples = 200000; ///< points spread over the area of a mesh, > 0
};

/// The distances of a from b and of b from a.
struct Comparison {
    Distance a_to_b,                ///< of a from b, in the units of the two
        b_to_a;                     ///< of b from a
    Percentiles a_to_b_percentiles, ///< of the distances that the mean is taken of
        b_to_a_percentiles;         ///< the same of b from a
    double diagonal = 0;            ///< of the box around both, to normalise by
    /// Two-sided Hausdorff distance: the larger maximum.
    double hausdorff() const { return std::max(a_to_b.max, b_to_a.max); }
};

/// Either may be a cloud: a mesh without facets, whose positions are the points; distances to it are those to
/// its nearest point. A cloud's distances are taken from every point; a mesh's mean, rms and percentiles from
/// samples even over its area, its maximum from its vertices too; of a mesh without area all of them from its
/// vertices. `farthest` is an index into the cloud's points, the mesh's samples or those vertices. Throws
/// Error if either holds nothing or a coordinate that is not finite, or if both together are out of
/// CloudFrame::check_reach(), OptionError. O((a + b) log(a + b)), parallel.
Comparison compare(const PolygonMesh& a, const PolygonMesh& b, const CompareOptions& options = {});

/// The same for two clouds by their points, without a copy of them.
Comparison compare(std::span<const Vec3> a, std::span<const Vec3> b);

} // namespace hsdm
