#pragma once
// The cloud that came in, whoever owns it.

#include "hsdm/octree/octree.hh"

namespace hsdm {

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
    void drop_nonfinite_points();
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

} // namespace hsdm
