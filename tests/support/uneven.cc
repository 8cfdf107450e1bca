#include "support/uneven.hh"

#include "support/random.hh"

#include <algorithm>

namespace hsdm::support {
namespace {

/// The points that pass a test.
template <class Test>
PointCloud kept_where(const PointCloud& cloud, Test&& test) {
    PointCloud kept;
    for (std::size_t i = 0; i < cloud.size(); ++i) {
        if (!test(cloud.positions[i])) continue;
        kept.positions.push_back(cloud.positions[i]);
        if (cloud.has_normals()) kept.normals.push_back(cloud.normals[i]);
    }
    return kept;
}

} // namespace

Vec3 scanner_beside(const PointCloud& cloud, const Vec3& side, double ratio) {
    const Vec3 way = side.normalized();
    double lo = Box::inf, hi = -Box::inf;
    for (const Vec3& p : cloud.positions) lo = std::min(lo, p | way), hi = std::max(hi, p | way);
    const double times = std::sqrt(ratio), near = (hi - lo) / (times - 1);
    const Box box = cloud.bounds();
    const Vec3 middle = (box.lo + box.hi) / 2;
    return middle + way * (hi + near - (middle | way));
}

PointCloud thinned_by_distance(const PointCloud& cloud, const Vec3& scanner, std::uint64_t seed) {
    Random random(seed);
    double nearest = Box::inf;
    for (const Vec3& p : cloud.positions) nearest = std::min(nearest, (p - scanner).sqrnorm());
    return kept_where(cloud,
                      [&](const Vec3& p) { return random.uniform() * (p - scanner).sqrnorm() <= nearest; });
}

PointCloud thinned_on_one_side(const PointCloud& cloud, const Vec3& side, double share, double ratio,
                               std::uint64_t seed) {
    Random random(seed);
    std::vector<double> along;
    for (const Vec3& p : cloud.positions) along.push_back(p | side);
    const auto cut =
        along.begin() + static_cast<std::ptrdiff_t>((1 - share) * static_cast<double>(along.size() - 1));
    std::nth_element(along.begin(), cut, along.end());
    return kept_where(cloud,
                      [&](const Vec3& p) { return (p | side) > *cut || random.uniform() * ratio < 1; });
}

} // namespace hsdm::support
