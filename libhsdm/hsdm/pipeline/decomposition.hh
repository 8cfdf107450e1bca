#pragma once
// Phase 1 of a reconstruction: the cloud that came in, its frame, its octree and what is known of it.

#include "hsdm/cloud/cloud_frame.hh"
#include "hsdm/normals/smooth_points.hh"
#include "hsdm/octree/octree.hh"
#include "hsdm/pipeline/phases.hh"

#include <optional>

namespace hsdm {

/// As options are written in reports and messages.
std::string text_of(double value);

/// The caller's cloud, or one that is left to us, which gives its memory back as soon as nobody asks for it.
class InputCloud {
public:
    explicit InputCloud(const PointCloud& kept) : cloud_(&kept) {}
    explicit InputCloud(PointCloud&& left) : cloud_(&left), ours_(&left) {}
    InputCloud(const InputCloud&) = delete;
    InputCloud& operator=(const InputCloud&) = delete;

    /// Throws Error for a cloud that would be read beyond its end.
    void check() const;
    /// In a copy of our own, if it is the caller's and has such points.
    void drop_nonfinite_points() {
        if (all_finite(cloud_->positions)) return;
        const std::size_t count = cloud_->size();
        if (!ours_) {
            copy_ = *cloud_;
            cloud_ = ours_ = &copy_;
        }
        dropped_ = drop_nonfinite(*ours_);
        if (2 * dropped_.nonfinite > count)
            throw Error(std::to_string(dropped_.nonfinite) + " of " + std::to_string(count)
                        + " points have coordinates that are not finite; check how the file was exported");
    }
    const PointCloud& operator*() const { return *cloud_; }
    const Dropped& dropped() const { return dropped_; }
    /// The normals go with it, if they are ours.
    Octree take_octree(const OctreeOptions& options) {
        return ours_ ? build_octree_taking_normals(*ours_, options) : build_octree(*cloud_, options);
    }
    void release_positions() {
        if (ours_) ours_->positions = std::vector<Vec3>();
    }
    void release_attributes() {
        if (!ours_) return;
        ours_->colors = decltype(ours_->colors)();
        ours_->scalars = std::vector<Scalar>();
    }

private:
    const PointCloud* cloud_;
    PointCloud* ours_ = nullptr;
    PointCloud copy_;
    Dropped dropped_;
};

/// Phase 1 with its report.
class Decomposition {
public:
    Decomposition(InputCloud& input, const ReconstructOptions& options, const Phases& phases);

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
