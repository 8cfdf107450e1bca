#include "hsdm/cloud/cloud_frame.hh"

#include "hsdm/core/parallel_sort.hh"
#include "hsdm/errors.hh"

#include <cmath>

namespace hsdm {
namespace {

/// Within these powers of two even the twentieth power of a length stays far from the ends of a double.
constexpr int plain_exponent = 30;
constexpr int least_exponent = -1000, most_exponent = 1020;
constexpr int limit_exponent = 1022; // largest whose reciprocal is still a normal number

} // namespace

CloudFrame::CloudFrame(const Box& cloud) {
    // on quarters, because the difference of two finite numbers may overflow
    constexpr double quarter = 0.25;
    double extent = 0;
    for (unsigned k = 0; k < 3; ++k) extent = std::max(extent, quarter * cloud.hi[k] - quarter * cloud.lo[k]);
    if (!(extent > 0)) return; // empty, or one point: for the octree to refuse
    const int exponent = std::clamp(std::ilogb(extent) + 2, -limit_exponent, limit_exponent);
    if (std::abs(exponent) > plain_exponent) unit_ = std::ldexp(1.0, exponent);
}

void CloudFrame::check_reach() const {
    const int exponent = std::ilogb(unit_);
    if (exponent < least_exponent || exponent > most_exponent)
        throw Error("the cloud is about 2^" + std::to_string(exponent)
                    + " across, out of reach of double precision; scale it");
}

CloudFrame CloudFrame::without_cuts() const {
    CloudFrame frame;
    frame.unit_ = unit_;
    return frame;
}

Index CloudFrame::stretch_of_uncut(double uncut, unsigned axis) const {
    const auto& stretches = stretches_[axis];
    const auto after = std::upper_bound(stretches.begin(), stretches.end(), uncut,
                                        [](double x, const Stretch& s) { return x < s.first; });
    return static_cast<Index>(after - stretches.begin());
}

Index CloudFrame::stretch_of(double work, unsigned axis) const {
    const auto& stretches = stretches_[axis];
    const double x = work + widest_ / 2; // the middle of a kept gap separates its two sides
    const auto after =
        std::upper_bound(stretches.begin(), stretches.end(), x,
                         [](double value, const Stretch& s) { return value < s.first - s.shift; });
    return static_cast<Index>(after - stretches.begin());
}

std::array<Index, 3> CloudFrame::stretch_of_uncut(const Vec3& uncut) const {
    return {stretch_of_uncut(uncut[0], 0), stretch_of_uncut(uncut[1], 1), stretch_of_uncut(uncut[2], 2)};
}

std::array<Index, 3> CloudFrame::stretch_of(const Vec3& work) const {
    return {stretch_of(work[0], 0), stretch_of(work[1], 1), stretch_of(work[2], 2)};
}

Vec3 CloudFrame::to_work(const Vec3& cloud) const {
    Vec3 p = unit_ == 1 ? cloud : cloud * (1 / unit_);
    for (unsigned k = 0; k < 3; ++k)
        if (const Index stretch = stretch_of_uncut(p[k], k); stretch > 0)
            p[k] -= stretches_[k][stretch - 1].shift;
    return p;
}

Vec3 CloudFrame::changed_to_cloud(const Vec3& work) const {
    Vec3 p = work;
    for (unsigned k = 0; k < 3; ++k)
        if (const Index stretch = stretch_of(work[k], k); stretch > 0)
            p[k] += stretches_[k][stretch - 1].shift;
    return unit_ == 1 ? p : p * unit_;
}

double CloudFrame::cut_gaps(unsigned axis, std::vector<double>& coordinates, double widest) {
    if (coordinates.empty()) return 0;
    parallel_sort(coordinates);
    widest_ = widest;
    double shift = 0, begin = coordinates.front(), longest = 0;
    for (std::size_t i = 1; i < coordinates.size(); ++i) {
        const double gap = coordinates[i] - coordinates[i - 1];
        if (!(gap > widest)) continue;
        shift += gap - widest;
        stretches_[axis].push_back({coordinates[i], shift});
        longest = std::max(longest, coordinates[i - 1] - begin);
        begin = coordinates[i];
    }
    return std::max(longest, coordinates.back() - begin);
}

} // namespace hsdm
