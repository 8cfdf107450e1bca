#pragma once
// What stands in strided rows.

#include "hsdm/point_view.hh"

#include <cstring>

namespace hsdm {

/// Where a row begins; at no special address.
inline const std::byte* row_of(const StridedSpan& rows, std::size_t i) {
    return static_cast<const std::byte*>(rows.data) + i * rows.stride;
}

/// Three numbers, float or double.
inline Vec3 vec3_at(const StridedSpan& rows, std::size_t i) {
    if (rows.type == NumberType::float64) {
        Vec3 wide;
        std::memcpy(wide.data(), row_of(rows, i), 3 * sizeof(double));
        return wide;
    }
    float narrow[3];
    std::memcpy(narrow, row_of(rows, i), sizeof narrow);
    return {narrow[0], narrow[1], narrow[2]};
}

/// Number k of a row, whatever its type.
double number_at(const StridedSpan& rows, std::size_t i, std::size_t k);
/// The same of a colour as a byte: fractions of 1 if they are float or double, where what is no number is 0.
double channel_at(const StridedSpan& colors, std::size_t i, std::size_t k);

/// Vectors as rows.
StridedSpan rows_of(std::span<const Vec3> vectors);

/// Rows whose coordinates are not all finite, and the first of them. O(n), parallel.
struct NonfiniteRows {
    std::size_t count = 0;
    std::size_t first = 0; ///< if there is one
};
NonfiniteRows find_nonfinite(const StridedSpan& positions);
/// The box of the finite positions; empty if there are none. O(n), parallel.
Box finite_bounds(const StridedSpan& positions);

} // namespace hsdm
