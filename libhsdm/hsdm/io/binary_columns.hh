#pragma once
// Columns of numbers in binary files -> the columns of a cloud, in parallel.

#include "hsdm/io/columns.hh"
#include "hsdm/io/source_bytes.hh"
#include "hsdm/io/stored_type.hh"

#include <optional>

namespace hsdm::io {

/// Where the numbers of a column lie: the first at byte `first` of the source, the others `stride` apart.
struct BinaryColumn {
    const SourceBytes* source = nullptr;
    std::size_t first = 0, stride = 0;
    StoredType type = StoredType::float64;
    bool big_endian = false;
    double scale = 1, offset = 0; ///< a number stands for number * scale + offset
};

/// The cloud that `count` rows of such columns make. `values` has one entry per column (of those to be
/// skipped it does not matter what), all of which must lie within their sources. Without `color_factor` it is
/// that of the largest colour, fractions being told by the type. Columns whose rows lie together are read
/// piece by piece, so that a large file is not held in memory. Throws Error if a source cannot be read.
PointCloud read_columns(std::span<const BinaryColumn> values, const std::vector<Column>& columns,
                        std::size_t count, std::optional<double> color_factor = std::nullopt);

/// Whether some number of the column is not zero. Parallel.
bool is_any_nonzero(const BinaryColumn& values, std::size_t count);

/// At most `most` rows spread evenly, for decisions.
std::vector<double> sample_rows(std::span<const BinaryColumn> values, std::size_t count, std::size_t most);

} // namespace hsdm::io
