#include "hsdm/io/binary_columns.hh"

#include "hsdm/core/chunks.hh"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <memory>

namespace hsdm::io {
namespace {

constexpr std::size_t block_rows = 1024; // a column of them fits the first-level cache

/// Columns of one source whose numbers lie in common rows, so that one piece of the source holds a block of
/// all.
struct CommonRows {
    const SourceBytes* source = nullptr;
    std::size_t begin = 0, end = 0; ///< of the first row
    std::size_t stride = 0;
    std::vector<std::size_t> columns;
};

/// A column joins the last rows if these do not become longer than their stride by it.
std::vector<CommonRows> rows_of(std::span<const BinaryColumn> values, const std::vector<Column>& columns) {
    std::vector<CommonRows> all;
    for (std::size_t c = 0; c < columns.size(); ++c) {
        if (columns[c].role == Role::skip) continue;
        const BinaryColumn& column = values[c];
        const std::size_t end = column.first + size_of(column.type);
        if (!all.empty() && all.back().source == column.source && all.back().stride == column.stride) {
            CommonRows& last = all.back();
            const std::size_t from = std::min(last.begin, column.first), to = std::max(last.end, end);
            if (to - from <= last.stride) {
                last.begin = from;
                last.end = to;
                last.columns.push_back(c);
                continue;
            }
        }
        all.push_back({column.source, column.first, end, column.stride, {c}});
    }
    return all;
}

/// Calls use(column, first row, numbers) for every block of every column that is used, in parallel. Columns
/// are gathered block by block: the bytes of a block pass through the cache once.
template <class Use>
void for_each_block(std::span<const BinaryColumn> values, const std::vector<Column>& columns,
                    std::size_t count, const Use& use) {
    const std::vector<CommonRows> all = rows_of(values, columns);
    std::size_t longest = 0;
    for (const CommonRows& rows : all)
        longest = std::max(longest, std::max(rows.stride, rows.end - rows.begin));
    const std::size_t blocks = (count + block_rows - 1) / block_rows;
    for_chunks(blocks, 16, [&](std::size_t begin, std::size_t end, std::size_t) {
        std::array<double, block_rows> numbers;
        const std::unique_ptr<char[]> scratch(new char[std::min(block_rows, count) * longest]);
        for (std::size_t block = begin; block != end; ++block) {
            const std::size_t first = block * block_rows, size = std::min(block_rows, count - first);
            for (const CommonRows& rows : all) {
                const char* bytes =
                    rows.source->piece(rows.begin + first * rows.stride,
                                       (size - 1) * rows.stride + rows.end - rows.begin, scratch.get());
                for (const std::size_t c : rows.columns) {
                    const BinaryColumn& column = values[c];
                    gather_of(column.type, column.big_endian)(bytes + (column.first - rows.begin),
                                                              column.stride, size, numbers.data());
                    if (column.scale != 1 || column.offset != 0)
                        for (std::size_t i = 0; i < size; ++i)
                            numbers[i] = numbers[i] * column.scale + column.offset;
                    use(c, first, std::span<const double>(numbers.data(), size));
                }
            }
        }
    });
}

double largest_of(std::span<const double> values) {
    double max = 0;
    for (double value : values) max = std::max(max, std::isfinite(value) ? value : 0);
    return max;
}

double factor_by_values(std::span<const BinaryColumn> values, const std::vector<Column>& columns,
                        std::size_t count) {
    std::vector<Column> colors = columns;
    bool fractions = false;
    for (std::size_t c = 0; c < columns.size(); ++c) {
        if (!is_color(columns[c]))
            colors[c].role = Role::skip;
        else
            fractions |= values[c].type >= StoredType::float32;
    }
    std::vector<double> maxima((count + block_rows - 1) / block_rows, 0);
    for_each_block(values, colors, count, [&](std::size_t, std::size_t first, auto numbers) {
        maxima[first / block_rows] = std::max(maxima[first / block_rows], largest_of(numbers));
    });
    return color_factor(largest_of(maxima), fractions);
}

} // namespace

PointCloud read_columns(std::span<const BinaryColumn> values, const std::vector<Column>& columns,
                        std::size_t count, std::optional<double> factor) {
    const bool colored = std::any_of(columns.begin(), columns.end(), is_color);
    if (!factor) factor = colored ? factor_by_values(values, columns, count) : 1;
    CloudColumns cloud(columns, count, *factor);
    for_each_block(values, columns, count, [&](std::size_t c, std::size_t first, auto numbers) {
        cloud.store(c, first, numbers.size(), numbers.data(), 1);
    });
    return cloud.finish();
}

bool is_any_nonzero(const BinaryColumn& values, std::size_t count) {
    const auto sample = sample_rows({&values, 1}, count, block_rows); // most columns are told by it
    if (std::ranges::any_of(sample, [](double number) { return number != 0; })) return true;
    std::atomic<bool> found = false;
    for_each_block({&values, 1}, {{Role::scalar, ""}}, count, [&](std::size_t, std::size_t, auto numbers) {
        if (std::any_of(numbers.begin(), numbers.end(), [](double number) { return number != 0; }))
            found = true;
    });
    return found;
}

std::vector<double> sample_rows(std::span<const BinaryColumn> values, std::size_t count, std::size_t most) {
    std::vector<double> rows;
    const std::size_t sampled = std::min(most, count);
    std::array<char, sizeof(double)> scratch;
    for (std::size_t i = 0; i < sampled; ++i)
        for (const BinaryColumn& column : values) {
            const std::size_t row = i * (count / sampled) + i * (count % sampled) / sampled;
            const char* at = column.source->piece(column.first + row * column.stride, size_of(column.type),
                                                  scratch.data());
            double number = 0;
            gather_of(column.type, column.big_endian)(at, 0, 1, &number);
            rows.push_back(number * column.scale + column.offset);
        }
    return rows;
}

} // namespace hsdm::io
