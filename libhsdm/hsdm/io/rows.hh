#pragma once
// Rows of numbers, parsed in parallel by lines.

#include "hsdm/io/columns.hh"
#include "hsdm/io/text.hh"

#include <cstdint>
#include <string>
#include <vector>

namespace hsdm::io {

/// How a row is made up.
struct RowLayout {
    enum class Cell : std::uint8_t {
        number,
        skip, ///< any one field; reads as 0
        list, ///< a count and as many fields; reads as 0
    };
    std::vector<Cell> cells;
    bool more_allowed = false; ///< whether a row may go on behind its cells
    bool comments = false;     ///< whether `#` and `//` end a line
    bool quotes = false;       ///< whether fields may stand in quotation marks
    bool counts = false;       ///< whether a line with one number counts the rows of a block
    /// For messages: where the number of cells comes from ("line 3 has 6"), and what to do about a bad field.
    std::string origin, advice;
};

/// The numbers of all rows, in blocks as they were parsed.
class Rows {
public:
    /// A line with one number, and how many rows come before it.
    struct Count {
        const char* at;
        double value;
        std::size_t rows_before;
    };

    /// Parses all lines of `text`, without empty ones and comments. Throws Error for the first bad line.
    Rows(const Text& text, const RowLayout& layout);

    std::size_t size() const { return size_; }
    std::size_t columns() const { return columns_; }
    const std::vector<Count>& counts() const { return counts_; }

    /// At most `most` rows spread evenly, for decisions.
    std::vector<double> sample(std::size_t most) const;
    /// color_factor() of all values whose column has a colour role; `fractions` as there.
    double color_factor(const std::vector<Column>& columns, bool fractions) const;
    /// The cloud these rows make; frees the rows on the way.
    PointCloud to_cloud(const std::vector<Column>& columns, double color_factor) &&;
    /// The cloud whose first half of rows are positions and whose second half are normals.
    PointCloud to_cloud_by_halves() const;

private:
    struct Block {
        std::vector<double> values;
        std::size_t first_row = 0;
    };
    const double* row(std::size_t index) const;

    std::vector<Block> blocks_;
    std::vector<Count> counts_;
    std::size_t columns_, size_ = 0;
};

/// Where the line begins that follows the first `count` rows of `text` (lines neither empty nor, if
/// `comments`, starting with '#'). Throws Error at the end of the file if there are fewer, naming `what` the
/// rows are and the number found. Parallel.
const char* after_rows(const Text& text, std::uint64_t count, bool comments, const std::string& what);
/// The number of such rows.
std::uint64_t count_rows(const Text& text, bool comments);

} // namespace hsdm::io
