#include "hsdm/pipeline/input_cloud.hh"

#include "hsdm/errors.hh"

namespace hsdm {

void InputCloud::check() const {
    if (view_.size() >= no_index)
        throw Error("the cloud holds " + std::to_string(view_.size())
                    + " points; fewer than 2^32 - 1 can be told apart");
    check_view(view_);
}

void InputCloud::find_nonfinite_points() {
    nonfinite_ = find_nonfinite(view_.positions);
    if (2 * nonfinite_.count > view_.size())
        throw Error(std::to_string(nonfinite_.count) + " of " + std::to_string(view_.size())
                    + " points have coordinates that are not finite; check how the file was exported");
}

Octree InputCloud::take_octree(OctreeOptions options) {
    options.skip_nonfinite = nonfinite_.count > 0;
    if (!ours_) return build_octree(view_, options);
    view_.normals = StridedSpan();
    return build_octree_taking_normals(*ours_, options);
}

void InputCloud::release_attributes() {
    if (!ours_) return;
    forget(ours_->colors, view_.colors);
    ours_->scalars = std::vector<Scalar>();
    view_.scalars.clear();
}

} // namespace hsdm
