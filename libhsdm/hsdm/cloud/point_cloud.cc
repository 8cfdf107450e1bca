#include "hsdm/point_cloud.hh"

#include "hsdm/core/chunks.hh"
#include "hsdm/errors.hh"

#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <atomic>
#include <functional>

namespace hsdm {
namespace {

template <class T>
void keep_only(std::vector<T>& values, const std::vector<Index>& kept) {
    if (values.empty()) return;
    for (std::size_t i = 0; i < kept.size(); ++i) values[i] = values[kept[i]];
    values.resize(kept.size());
}

} // namespace

bool all_finite(std::span<const Vec3> positions) {
    return tbb::parallel_reduce(
        tbb::blocked_range<std::size_t>(0, positions.size(), chunks::light), true,
        [&](const tbb::blocked_range<std::size_t>& range, bool finite) {
            for (std::size_t i = range.begin(); finite && i != range.end(); ++i)
                finite = is_finite(positions[i]);
            return finite;
        },
        std::logical_and<>());
}

Box bounds_of(std::span<const Vec3> positions) {
    return tbb::parallel_reduce(
        tbb::blocked_range<std::size_t>(0, positions.size(), 1 << 16), Box{},
        [&](const tbb::blocked_range<std::size_t>& range, Box box) {
            for (std::size_t i = range.begin(); i != range.end(); ++i) box.add(positions[i]);
            return box;
        },
        [](Box a, const Box& b) {
            a.add(b);
            return a;
        });
}

void check_arrays(const PointCloud& cloud) {
    const auto check = [&](const std::string& what, std::size_t count, bool may_lack) {
        if (count != cloud.size() && !(may_lack && count == 0))
            throw Error("the cloud holds " + std::to_string(count) + " " + what + " for "
                        + std::to_string(cloud.size()) + " points; give one for each, or leave them out");
    };
    check("normals", cloud.normals.size(), true);
    check("colours", cloud.colors.size(), true);
    check("numbers of sensors", cloud.sensor_of.size(), cloud.sensors.size() <= 1);
    for (const Scalar& scalar : cloud.scalars) check("values of " + scalar.name, scalar.values.size(), false);
}

Dropped drop_nonfinite(PointCloud& cloud) {
    check_arrays(cloud);
    Dropped dropped;
    std::atomic<std::size_t> bad_points = 0, bad_normals = 0;
    for_chunks(cloud.size(), chunks::light, [&](std::size_t begin, std::size_t end, std::size_t) {
        std::size_t points = 0, normals = 0;
        for (std::size_t i = begin; i != end; ++i) {
            if (!is_finite(cloud.positions[i])) {
                ++points;
            } else if (cloud.has_normals()) {
                Vec3& n = cloud.normals[i];
                if (is_finite(n) && n.sqrnorm() > 0) continue;
                n = Vec3(0, 0, 0);
                ++normals;
            }
        }
        bad_points += points;
        bad_normals += normals;
    });
    dropped.nonfinite = bad_points;
    dropped.bad_normals = bad_normals;
    if (dropped.nonfinite == 0) return dropped;

    const auto first = std::find_if_not(cloud.positions.begin(), cloud.positions.end(), is_finite);
    dropped.first_nonfinite = static_cast<std::size_t>(first - cloud.positions.begin());
    std::vector<Index> kept;
    kept.reserve(cloud.size() - dropped.nonfinite);
    for (std::size_t i = 0; i < cloud.size(); ++i)
        if (is_finite(cloud.positions[i])) kept.push_back(static_cast<Index>(i));
    keep_only(cloud.positions, kept);
    keep_only(cloud.normals, kept);
    keep_only(cloud.colors, kept);
    keep_only(cloud.sensor_of, kept);
    for (Scalar& scalar : cloud.scalars) keep_only(scalar.values, kept);
    return dropped;
}

} // namespace hsdm
