#pragma once
// Points where their owner keeps them: the input of a reconstruction that copies none of them.

#include "hsdm/point_cloud.hh"

#include <cstddef>
#include <type_traits>

namespace hsdm {

/// What the numbers of an array are.
enum class NumberType : std::uint8_t { uint8, uint16, int32, float32, float64 };

/// The NumberType of a type.
template <class Number>
constexpr NumberType number_type() {
    constexpr bool is_integer =
        std::is_same_v<
            Number,
            std::uint8_t> || std::is_same_v<Number, std::uint16_t> || std::is_same_v<Number, std::int32_t>;
    static_assert(is_integer || std::is_same_v<Number, float> || std::is_same_v<Number, double>,
                  "numbers are std::uint8_t, std::uint16_t, std::int32_t, float or double");
    if constexpr (std::is_same_v<Number, std::uint8_t>) return NumberType::uint8;
    if constexpr (std::is_same_v<Number, std::uint16_t>) return NumberType::uint16;
    if constexpr (std::is_same_v<Number, std::int32_t>) return NumberType::int32;
    if constexpr (std::is_same_v<Number, float>) return NumberType::float32;
    return NumberType::float64;
}

/// Somebody else's array, of structs or of plain numbers: row i begins i * stride bytes after the first, at
/// any address. How many numbers a row has, one after the other, follows from what the array is taken for.
struct StridedSpan {
    StridedSpan() = default;
    /// Rows whose first number is `*first` in the first row; `stride` in bytes.
    template <class Number>
    StridedSpan(const Number* first, std::size_t rows, std::size_t bytes)
        : data(first), count(rows), stride(bytes), type(number_type<Number>()) {}

    const void* data = nullptr;            ///< the first row's first number
    std::size_t count = 0;                 ///< rows; 0: there is no such array
    std::size_t stride = 0;                ///< bytes from row to row, at least those of a row
    NumberType type = NumberType::float64; ///< of all numbers
};

/// One more value per point, as Scalar.
struct ScalarView {
    std::string name;      ///< of the mesh's property
    StridedSpan values;    ///< rows of one number of any type
    bool is_label = false; ///< integers that must not be averaged
};

/// A PointCloud that lies elsewhere. The arrays must stay as they are as long as they are looked at.
///
///     struct Hit { float x, y, z, nx, ny, nz; std::uint8_t rgba[4]; };
///     std::vector<Hit> hits = ...;
///     hsdm::PointView view{.positions = {&hits[0].x, hits.size(), sizeof(Hit)},
///                          .normals = {&hits[0].nx, hits.size(), sizeof(Hit)}};
struct PointView {
    StridedSpan positions{};           ///< rows of three float or double, in the cloud's units
    StridedSpan normals{};             ///< the same, as PointCloud::normals
    StridedSpan colors{};              ///< rows of std::uint8_t, or of float or double in [0, 1]
    int color_channels = 4;            ///< 3: red, green, blue, and opaque; 4: alpha too
    std::vector<ScalarView> scalars{}; ///< further values
    std::optional<Vec3> sensor{};      ///< where the scanner stood, if that is known
    std::span<const Vec3> sensors{};   ///< as PointCloud::sensors
    StridedSpan sensor_of{};           ///< rows of one integer, as PointCloud::sensor_of

    /// Number of points.
    std::size_t size() const { return positions.count; }
    /// Whether there are normals, of whatever length.
    bool has_normals() const { return normals.count > 0; }
};

/// The arrays of a cloud, which must outlive the view.
PointView view_of(const PointCloud& cloud);

/// Throws Error if an array has neither a row for each point nor, where it may be missing, none; if it is
/// null, its rows overlap or its numbers are of a type that it cannot have. Every function that takes a view
/// begins with it.
void check_view(const PointView& view);

} // namespace hsdm
