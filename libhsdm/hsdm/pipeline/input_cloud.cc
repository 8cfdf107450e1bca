#include "hsdm/pipeline/input_cloud.hh"

#include "hsdm/errors.hh"

namespace hsdm {

void InputCloud::check() const {
    const PointCloud& cloud = *cloud_;
    if (cloud.size() >= no_index)
        throw Error("the cloud holds " + std::to_string(cloud.size())
                    + " points; fewer than 2^32 - 1 can be told apart");
    check_arrays(cloud);
}

void InputCloud::drop_nonfinite_points() {
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

} // namespace hsdm
