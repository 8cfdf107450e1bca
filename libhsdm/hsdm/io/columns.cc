#include "hsdm/io/columns.hh"

#include "hsdm/core/huge_pages.hh"

#include <algorithm>
#include <cmath>

namespace hsdm::io {
namespace {

/// The sample that roles are told from.
struct Sample {
    std::span<const double> values;
    std::size_t columns;
    std::size_t rows() const { return values.size() / columns; }
    double at(std::size_t row, std::size_t column) const { return values[row * columns + column]; }
};

/// True if nearly all vectors that are there (not zero, not NaN) have length 1 within what two decimals of
/// rounding leave; a few outliers among them do not make a colour of a normal.
bool are_unit_vectors(const Sample& sample, std::size_t first) {
    std::size_t unit = 0, other = 0;
    for (std::size_t row = 0; row < sample.rows(); ++row) {
        const double length =
            std::hypot(sample.at(row, first), sample.at(row, first + 1), sample.at(row, first + 2));
        if (std::abs(length - 1) < 0.03)
            ++unit;
        else if (length != 0 && std::isfinite(length))
            ++other;
    }
    return unit > 0 && other * 20 <= unit;
}

bool are_bytes(const Sample& sample, std::size_t column) {
    for (std::size_t row = 0; row < sample.rows(); ++row) {
        const double value = sample.at(row, column);
        if (!(value >= 0 && value <= 255 && value == std::floor(value))) return false;
    }
    return true;
}

struct Range {
    double min, max;
};

Range range_of(const Sample& sample, std::size_t column) {
    Range range{sample.at(0, column), sample.at(0, column)};
    for (std::size_t row = 1; row < sample.rows(); ++row) {
        range.min = std::min(range.min, sample.at(row, column));
        range.max = std::max(range.max, sample.at(row, column));
    }
    return range;
}

/// Gives colour roles to columns first .. end, all bytes: three are red, green, blue. A fourth behind them is
/// alpha if it is 255 throughout, a class or the like if it stays small while they do not; else the first of
/// the four is an intensity.
void assign_colors(std::vector<Column>& columns, const Sample& sample, std::size_t first, std::size_t end,
                   bool scan) {
    if (end - first == 4) {
        const Range last = range_of(sample, first + 3);
        const bool small = last.max < 32 && range_of(sample, first).max >= 32;
        if (!scan && last.min == 255)
            columns[first + 3].role = Role::alpha;
        else if (scan || !small)
            columns[first++].name = "intensity";
    }
    columns[first].role = Role::red;
    columns[first + 1].role = Role::green;
    columns[first + 2].role = Role::blue;
}

/// Vec3's constructor leaves memory untouched, so that the threads that fill it are the first to write it.
void resize_for_writing(std::vector<Vec3>& vectors, std::size_t count) {
    vectors.resize(count);
    advise_huge_pages(vectors.data(), count * sizeof(Vec3));
}

} // namespace

std::vector<Column> columns_from_values(std::span<const double> rows, std::size_t count, bool scan) {
    const Sample sample{rows, count};
    std::vector<Column> columns(count);
    for (std::size_t i = 0; i < count; ++i) columns[i] = {Role::scalar, "column_" + std::to_string(i + 1)};
    columns[0].role = Role::x;
    columns[1].role = Role::y;
    columns[2].role = Role::z;
    if (count == 4) columns[3].name = "intensity";

    for (std::size_t i = 3; i + 3 <= count; ++i)
        if (are_unit_vectors(sample, i)) {
            columns[i].role = Role::nx;
            columns[i + 1].role = Role::ny;
            columns[i + 2].role = Role::nz;
            break;
        }
    for (std::size_t i = 3; i + 3 <= count; ++i) {
        std::size_t end = i;
        while (end < count && columns[end].role == Role::scalar && are_bytes(sample, end)) ++end;
        if (end - i >= 3) {
            assign_colors(columns, sample, i, end, scan);
            break;
        }
    }
    return columns;
}

double color_factor(double max_value, bool fractions) {
    if (fractions && max_value <= 1) return 255;
    return max_value <= 255 ? 1 : 1.0 / 257;
}

CloudColumns::CloudColumns(std::vector<Column> columns, std::size_t points, double factor)
    : columns_(std::move(columns)), scalar_(columns_.size()), color_factor_(factor) {
    resize_for_writing(cloud_.positions, points);
    for (std::size_t i = 0; i < columns_.size(); ++i) {
        switch (columns_[i].role) {
        case Role::nx:
            resize_for_writing(cloud_.normals, points);
            break;
        case Role::red:
            cloud_.colors.resize(points, {0, 0, 0, 255});
            break;
        case Role::scalar:
            scalar_[i] = cloud_.scalars.size();
            cloud_.scalars.push_back({columns_[i].name, std::vector<double>(points), false});
            break;
        default:
            break;
        }
    }
}

void CloudColumns::store(std::size_t column, std::size_t first, std::size_t count, const double* values,
                         std::size_t stride) {
    const Role role = columns_[column].role;
    if (role == Role::skip) return;
    if (role == Role::scalar) {
        double* out = cloud_.scalars[scalar_[column]].values.data() + first;
        for (std::size_t i = 0; i < count; ++i) out[i] = values[i * stride];
    } else if (role <= Role::nz) {
        const bool position = role <= Role::z;
        Vec3* out = (position ? cloud_.positions : cloud_.normals).data() + first;
        const auto axis =
            static_cast<std::size_t>(role) - static_cast<std::size_t>(position ? Role::x : Role::nx);
        for (std::size_t i = 0; i < count; ++i) out[i][axis] = values[i * stride];
    } else {
        const auto channel = static_cast<std::size_t>(role) - static_cast<std::size_t>(Role::red);
        for (std::size_t i = 0; i < count; ++i) {
            const double value = std::round(values[i * stride] * color_factor_);
            // Written so that NaN becomes 0.
            cloud_.colors[first + i][channel] =
                value > 0 ? static_cast<std::uint8_t>(std::min(value, 255.0)) : std::uint8_t(0);
        }
    }
}

PointCloud CloudColumns::finish() {
    for (Scalar& scalar : cloud_.scalars)
        scalar.is_label = is_label_name(scalar.name)
                          && std::all_of(scalar.values.begin(), scalar.values.end(), [](double value) {
                                 return value == std::floor(value) && std::abs(value) < 9e15;
                             });
    return std::move(cloud_);
}

} // namespace hsdm::io
