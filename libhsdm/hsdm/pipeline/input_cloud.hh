#pragma once
// The cloud that came in, whoever owns it.

#include "hsdm/octree/octree.hh"

namespace hsdm {

/// The caller's cloud, or one that we own and whose memory is freed as soon as it is no longer needed.
class InputCloud {
public:
    explicit InputCloud(const PointCloud& kept) : cloud_(&kept) {}
    explicit InputCloud(PointCloud&& left) : cloud_(&left), ours_(&left) {}
    InputCloud(const InputCloud&) = delete;
    InputCloud& operator=(const InputCloud&) = delete;

    /// Throws Error if the arrays of the cloud are of different lengths, so that one would be read beyond its
    /// end.
    void check() const;
    /// Drops points with coordinates that are not finite; if the caller's cloud has such, in a copy.
    void drop_nonfinite_points();
    const PointCloud& operator*() const { return *cloud_; }
    const Dropped& dropped() const { return dropped_; }
    /// Builds the octree; takes the normals along if we own the cloud.
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

} // namespace hsdm
