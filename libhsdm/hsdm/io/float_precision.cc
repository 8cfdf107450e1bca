#include "hsdm/io/float_precision.hh"

#include "hsdm/cloud/cloud_frame.hh"
#include "hsdm/point_cloud.hh"

#include <cmath>
#include <limits>

namespace hsdm {

/// Lengths are taken in the frame's unit, since their squares must be numbers.
double moved_by_floats(std::span<const Vec3> positions, const Vec3& shift) {
    Box box = bounds_of(positions);
    box.lo -= shift, box.hi -= shift; // no rounding changes which is the least
    const double unit = CloudFrame(box).unit();
    const double diagonal = (box.hi / unit - box.lo / unit).norm();
    double most = 0;
    for (const Vec3& position : positions) {
        const Vec3 p = position - shift;
        Vec3 moved;
        for (unsigned k = 0; k < 3; ++k)
            moved[k] = (static_cast<double>(static_cast<float>(p[k])) - p[k]) / unit;
        if (const double way = moved.norm(); !(way <= most)) most = way;
    }
    if (most == 0) return 0;
    return diagonal > 0 && std::isfinite(most) ? most / diagonal : std::numeric_limits<double>::infinity();
}

Vec3 recentring_shift(std::span<const Vec3> positions) {
    const Box box = bounds_of(positions);
    const double unit = CloudFrame(box).unit();
    const double diagonal = (box.hi / unit - box.lo / unit).norm() * unit;
    Vec3 shift(0, 0, 0);
    if (!(diagonal > 0) || !std::isfinite(diagonal)) return shift;
    const double step = diagonal >= 1 ? std::pow(10, std::floor(std::log10(diagonal)))
                                      : std::ldexp(1, static_cast<int>(std::floor(std::log2(diagonal))));
    for (unsigned k = 0; k < 3; ++k) {
        const double middle = box.lo[k] / 2 + box.hi[k] / 2;
        if (std::abs(middle) > diagonal) shift[k] = std::round(middle / step) * step;
    }
    return shift;
}

} // namespace hsdm
