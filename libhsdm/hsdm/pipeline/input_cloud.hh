#pragma once
// The cloud that came in, whoever owns it.

#include "hsdm/cloud/strided.hh"
#include "hsdm/octree/octree.hh"

namespace hsdm {

/// The caller's arrays, read where they are, or a cloud that we own and whose memory is freed as soon as it
/// is no longer needed. Points that are not finite stay where they are and are skipped.
class InputCloud {
public:
    explicit InputCloud(const PointView& kept) : view_(kept) {}
    explicit InputCloud(PointCloud&& left) : view_(view_of(left)), ours_(&left) {}
    InputCloud(const InputCloud&) = delete;
    InputCloud& operator=(const InputCloud&) = delete;

    /// Throws Error if the arrays of the cloud do not fit together, so that one would be read where it is
    /// not.
    void check() const;
    /// Looks for points with coordinates that are not finite. Throws Error if most are such.
    void find_nonfinite_points();
    const PointView& operator*() const { return view_; }
    const NonfiniteRows& nonfinite() const { return nonfinite_; }
    /// Points that are finite.
    std::size_t finite_size() const { return view_.size() - nonfinite_.count; }
    /// Builds the octree of the finite points; takes the normals along if we own the cloud.
    Octree take_octree(OctreeOptions options);
    void release_positions() {
        if (ours_) forget(ours_->positions, view_.positions);
    }
    void release_attributes();

private:
    template <class Array>
    static void forget(Array& array, StridedSpan& rows) {
        array = Array();
        rows = StridedSpan();
    }

    PointView view_;
    PointCloud* ours_ = nullptr;
    NonfiniteRows nonfinite_;
};

} // namespace hsdm
