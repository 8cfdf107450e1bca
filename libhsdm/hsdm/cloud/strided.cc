#include "hsdm/cloud/strided.hh"

#include "hsdm/core/chunks.hh"
#include "hsdm/errors.hh"

#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

namespace hsdm {
namespace {

template <class Number>
double number_in(const std::byte* row, std::size_t k) {
    Number number;
    std::memcpy(&number, row + k * sizeof(Number), sizeof(Number));
    return static_cast<double>(number);
}

bool is_floating(NumberType type) {
    return type == NumberType::float32 || type == NumberType::float64;
}

std::size_t bytes_of(NumberType type) {
    switch (type) {
    case NumberType::uint8:
        return 1;
    case NumberType::uint16:
        return 2;
    case NumberType::int32:
    case NumberType::float32:
        return 4;
    default:
        return 8;
    }
}

/// Throws Error unless the array can be read as `points` rows of `width` numbers.
void check_rows(const std::string& what, const StridedSpan& rows, std::size_t width, std::size_t points,
                bool may_lack) {
    if (rows.count != points && !(may_lack && rows.count == 0))
        throw Error("the cloud holds " + std::to_string(rows.count) + " " + what + " for "
                    + std::to_string(points) + " points; give one for each, or leave them out");
    if (rows.count == 0) return;
    if (rows.data == nullptr)
        throw Error("the cloud's " + what + " are a null pointer; give the address of the first, or leave "
                    + "them out");
    const std::size_t bytes = width * bytes_of(rows.type);
    if (rows.stride < bytes)
        throw Error("the cloud's " + what + " are " + std::to_string(rows.stride)
                    + " bytes apart, and each takes " + std::to_string(bytes)
                    + "; give the stride in bytes, such as the size of a struct");
}

void check_type(bool fits, const std::string& what, const std::string& types) {
    if (!fits) throw Error("the cloud's " + what + " must be " + types + "; convert them");
}

} // namespace

double number_at(const StridedSpan& rows, std::size_t i, std::size_t k) {
    const std::byte* const row = row_of(rows, i);
    switch (rows.type) {
    case NumberType::uint8:
        return number_in<std::uint8_t>(row, k);
    case NumberType::uint16:
        return number_in<std::uint16_t>(row, k);
    case NumberType::int32:
        return number_in<std::int32_t>(row, k);
    case NumberType::float32:
        return number_in<float>(row, k);
    default:
        return number_in<double>(row, k);
    }
}

double channel_at(const StridedSpan& colors, std::size_t i, std::size_t k) {
    constexpr double full = 255;
    const double value = number_at(colors, i, k);
    if (!is_floating(colors.type)) return value;
    const double scaled = std::round(full * value);
    return scaled > 0 ? std::min(scaled, full) : 0;
}

StridedSpan rows_of(std::span<const Vec3> vectors) {
    StridedSpan rows;
    rows.data = vectors.data();
    rows.count = vectors.size();
    rows.stride = sizeof(Vec3);
    return rows;
}

NonfiniteRows find_nonfinite(const StridedSpan& positions) {
    return tbb::parallel_reduce(
        tbb::blocked_range<std::size_t>(0, positions.count, chunks::light), NonfiniteRows{},
        [&](const tbb::blocked_range<std::size_t>& range, NonfiniteRows found) {
            for (std::size_t i = range.begin(); i != range.end(); ++i)
                if (!is_finite(vec3_at(positions, i)) && found.count++ == 0) found.first = i;
            return found;
        },
        [](const NonfiniteRows& a, const NonfiniteRows& b) {
            return NonfiniteRows{a.count + b.count, a.count > 0 ? a.first : b.first};
        });
}

Box finite_bounds(const StridedSpan& positions) {
    return tbb::parallel_reduce(
        tbb::blocked_range<std::size_t>(0, positions.count, 1 << 16), Box{},
        [&](const tbb::blocked_range<std::size_t>& range, Box box) {
            for (std::size_t i = range.begin(); i != range.end(); ++i)
                if (const Vec3 p = vec3_at(positions, i); is_finite(p)) box.add(p);
            return box;
        },
        [](Box a, const Box& b) {
            a.add(b);
            return a;
        });
}

PointView view_of(const PointCloud& cloud) {
    PointView view;
    view.positions = rows_of(cloud.positions);
    view.normals = rows_of(cloud.normals);
    if (!cloud.colors.empty()) view.colors = {cloud.colors.front().data(), cloud.colors.size(), 4};
    for (const Scalar& s : cloud.scalars)
        view.scalars.push_back({s.name, {s.values.data(), s.values.size(), sizeof(double)}, s.is_label});
    view.sensor = cloud.sensor;
    view.sensors = cloud.sensors;
    view.sensor_of = {cloud.sensor_of.data(), cloud.sensor_of.size(), sizeof(std::int32_t)};
    return view;
}

void check_view(const PointView& view) {
    const std::size_t points = view.size();
    check_rows("positions", view.positions, 3, points, false);
    check_type(is_floating(view.positions.type), "positions", "float or double");
    check_rows("normals", view.normals, 3, points, true);
    check_type(is_floating(view.normals.type), "normals", "float or double");
    if (view.color_channels != 3 && view.color_channels != 4)
        throw Error("the cloud's colours have " + std::to_string(view.color_channels)
                    + " channels; 3 are red, green and blue, 4 alpha too");
    check_rows("colours", view.colors, static_cast<std::size_t>(view.color_channels), points, true);
    check_type(is_floating(view.colors.type) || view.colors.type == NumberType::uint8, "colours",
               "bytes, or float or double from 0 to 1");
    check_rows("numbers of sensors", view.sensor_of, 1, points, view.sensors.size() <= 1);
    check_type(!is_floating(view.sensor_of.type) || view.sensor_of.count == 0, "numbers of sensors",
               "integers");
    for (const ScalarView& scalar : view.scalars)
        check_rows("values of " + scalar.name, scalar.values, 1, points, false);
}

} // namespace hsdm
