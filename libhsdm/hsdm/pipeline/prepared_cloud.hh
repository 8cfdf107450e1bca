#pragma once
// Phase 1 of a reconstruction: a cloud's frame, its octree and what is known of it.

#include "hsdm/cloud/cloud_frame.hh"
#include "hsdm/normals/smooth_points.hh"
#include "hsdm/octree/octree.hh"
#include "hsdm/pipeline/input_cloud.hh"
#include "hsdm/pipeline/phases.hh"

#include <optional>

namespace hsdm {

/// Phase 1 with its report.
class PreparedCloud {
public:
    PreparedCloud(InputCloud& input, const ReconstructOptions& options, const Phases& phases);

    /// Normals, where the method needs some and the cloud has none or they are not wanted.
    void provide_normals(const PointCloud& cloud, const Phases& phases);

    /// Turns given normals to one side if their signs contradict each other, and measures the noise where
    /// there seems to be much.
    void check_given_normals(const PointCloud& cloud, const Phases& phases);

    /// The depth the options ask for or spacing and noise suggest, in a cube that fits; notes it in the
    /// report.
    int choose_resolution(const ReconstructOptions& options);

    /// Moves the points onto their surface where noise is no longer small against voxels of this depth: there
    /// it would decide topology. Less noisy ones stay where they are, which creases are crisper for. What was
    /// moved for its normals has little noise left.
    void smooth_for_depth(int depth, const Phases& phases);

    /// Have points been moved off the places where the cloud has them, and may they be?
    bool has_moved() const { return moved_; }
    bool may_move() const { return noise_ > 0; }

    /// Once the last facets are made nobody asks for them.
    void release_normals() { octree.normals = std::vector<Vec3>(); }

    CloudFrame frame;
    Octree octree;
    Report report; // lengths and box as the octree has them, until they are told

private:
    /// Outliers make a cloud look sparser and larger than its surface is.
    void note_outliers(const Discarded& outliers);

    std::optional<Vec3> sensor_of(const PointCloud& cloud) const;

    void note_smoothing(const SmoothReport& smoothed);

    /// Puts the points in the smallest cube of 2^N voxels of this size around their box, N in [1, 16];
    /// returns N.
    int fit_voxels(double voxel_size);

    std::size_t far_away_ = 0; // points removed before all else
    double noise_ = 0;         // standard deviation, if it is large
    bool moved_ = false;       // the points, because of it
};

} // namespace hsdm
