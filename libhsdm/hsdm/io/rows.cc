#include "hsdm/io/rows.hh"

#include "hsdm/core/chunks.hh"
#include "hsdm/errors.hh"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace hsdm::io {
namespace {

using Cell = RowLayout::Cell;

struct RowError {
    enum Kind { none, not_a_number, too_short, too_long, bad_list } kind = none;
    const char* at = nullptr;
    std::size_t column = 0; ///< of the field at fault, from 0
};

/// Parses the lines of one piece of text. Stops at the first error.
class ChunkParser {
public:
    ChunkParser(const Text& text, const RowLayout& layout, const char* begin, const char* end)
        : text_(text), layout_(layout), newline_(text.newline), at_(begin), end_(end) {}

    void run(std::vector<double>& values) {
        const std::size_t columns = layout_.cells.size();
        values.reserve(static_cast<std::size_t>(end_ - at_) / 8 + columns);
        while (at_ != end_ && !error.kind) {
            skip_blanks();
            if (at_line_end() || at_comment()) {
                skip_line();
                continue;
            }
            const std::size_t filled = values.size();
            const bool complete = parse_row(values);
            if (error.kind == RowError::too_short && layout_.counts && error.column == 1)
                keep_count(values, filled);
            else if (complete)
                skip_line();
        }
    }

    RowError error;
    std::vector<Rows::Count> counts;

private:
    bool at_line_end() const { return at_ == end_ || *at_ == newline_; }
    bool at_comment() const {
        return layout_.comments && (*at_ == '#' || (*at_ == '/' && end_ - at_ > 1 && at_[1] == '/'));
    }
    void skip_blanks() {
        while (at_ != end_ && *at_ != newline_ && is_blank(*at_)) ++at_;
    }
    void skip_line() {
        at_ = text_.find_newline(at_);
        if (at_ != end_) ++at_;
    }
    bool field_ends(const char* at) const {
        return at == end_ || is_blank(*at) || is_separator(*at) || *at == newline_;
    }
    bool fail(RowError::Kind kind, const char* at, std::size_t column) {
        error = {kind, at, column};
        return false;
    }

    /// Moves behind a field and at most one separator; true if there was one.
    bool end_field(const char* field_end) {
        at_ = field_end;
        skip_blanks();
        if (at_line_end() || !is_separator(*at_)) return false;
        ++at_;
        skip_blanks();
        return true;
    }

    /// A number in quotation marks, which some programs put round every field of a table.
    const char* parse_quoted(double& value) const {
        if (!layout_.quotes || *at_ != '"') return nullptr;
        const char* const ends = parse_number(at_ + 1, end_, value);
        return ends && ends != end_ && *ends == '"' ? ends + 1 : nullptr;
    }

    bool skip_field() {
        if (const char* const ends = layout_.quotes ? end_of_quotes(at_, text_.find_newline(at_)) : nullptr)
            at_ = ends;
        while (!field_ends(at_)) ++at_;
        return end_field(at_);
    }

    bool parse_row(std::vector<double>& values) {
        const char* row = at_;
        bool separated = false;
        for (std::size_t column = 0; column < layout_.cells.size(); ++column) {
            double value = 0;
            const bool at_end = at_line_end() || at_comment();
            if (at_end && !separated) return fail(RowError::too_short, row, column);
            if (at_end || is_separator(*at_)) { // an empty field: a value that is not there
                value = std::numeric_limits<double>::quiet_NaN();
                separated = end_field(at_);
            } else if (layout_.cells[column] == Cell::skip) {
                separated = skip_field();
            } else {
                const char* field_end = parse_number(at_, end_, value);
                if (!field_end) field_end = parse_quoted(value);
                if (!field_end || !field_ends(field_end)) return fail(RowError::not_a_number, at_, column);
                separated = end_field(field_end);
                if (layout_.cells[column] == Cell::list && !skip_list(value, row, column)) return false;
            }
            values.push_back(value);
        }
        if (!layout_.more_allowed && !at_line_end() && !at_comment())
            return fail(RowError::too_long, row, layout_.cells.size());
        return true;
    }

    bool skip_list(double& count, const char* row, std::size_t column) {
        if (!(count >= 0 && count == std::floor(count))) return fail(RowError::bad_list, row, column);
        for (; count > 0; --count) {
            if (at_line_end()) return fail(RowError::too_short, row, column);
            skip_field();
        }
        return true;
    }

    /// Takes back a row of one number: it is the count of a block.
    void keep_count(std::vector<double>& values, std::size_t filled) {
        counts.push_back({error.at, values[filled], filled / layout_.cells.size()});
        values.resize(filled);
        error = {};
        skip_line();
    }

    const Text& text_;
    const RowLayout& layout_;
    const char newline_;
    const char* at_;
    const char* end_;
};

/// The field at `at`, for a message.
std::string_view field_at(const Text& text, const char* at) {
    const char* end = at;
    while (end != text.end && *end != text.newline && !is_blank(*end) && !is_separator(*end)) ++end;
    return {at, static_cast<std::size_t>(end - at)};
}

[[noreturn]] void report(const Text& text, const RowLayout& layout, const RowError& error) {
    const std::string found = std::to_string(error.column);
    const std::string column = std::to_string(error.column + 1);
    switch (error.kind) {
    case RowError::not_a_number:
        text.fail(error.at, io::quoted(field_at(text, error.at)) + " in column " + column
                                + " is not a number; " + layout.advice);
    case RowError::bad_list:
        text.fail(error.at, "the list in column " + column + " has no valid count; export the file again");
    case RowError::too_long:
        text.fail(error.at, "more columns than " + layout.origin + "; " + layout.advice);
    default:
        text.fail(error.at, "ends after " + found + (error.column == 1 ? " column, but " : " columns, but ")
                                + layout.origin + "; complete or remove the line");
    }
}

bool is_row(std::string_view line, bool comments) {
    line = trim(line);
    return !line.empty() && !(comments && line.front() == '#');
}

std::vector<std::uint64_t> rows_per_chunk(const Text& text,
                                          const std::vector<std::pair<const char*, const char*>>& chunks,
                                          bool comments) {
    std::vector<std::uint64_t> counts(chunks.size(), 0);
    for_each_task(chunks.size(), [&](std::size_t i) {
        Text chunk = text;
        chunk.begin = chunks[i].first;
        chunk.end = chunks[i].second;
        for (const char* at = chunk.begin; at != chunk.end;) counts[i] += is_row(chunk.line(at), comments);
    });
    return counts;
}

constexpr std::uint64_t few_rows = 8192;

/// Moves `at` behind the next `count` rows. Returns how many of them are not there.
std::uint64_t walk_rows(const Text& text, bool comments, std::uint64_t count, const char*& at) {
    while (count > 0 && at != text.end) count -= is_row(text.line(at), comments) ? 1 : 0;
    return count;
}

} // namespace

Rows::Rows(const Text& text, const RowLayout& layout) : columns_(layout.cells.size()) {
    const auto chunks = text.chunks();
    blocks_.resize(chunks.size());
    std::vector<RowError> errors(chunks.size());
    std::vector<std::vector<Count>> counts(chunks.size());
    for_each_task(chunks.size(), [&](std::size_t i) {
        ChunkParser parser(text, layout, chunks[i].first, chunks[i].second);
        parser.run(blocks_[i].values);
        errors[i] = parser.error;
        counts[i] = std::move(parser.counts);
    });
    for (std::size_t i = 0; i < chunks.size(); ++i) {
        if (errors[i].kind) report(text, layout, errors[i]);
        for (Count& count : counts[i]) {
            count.rows_before += size_;
            counts_.push_back(count);
        }
        blocks_[i].first_row = size_;
        size_ += blocks_[i].values.size() / columns_;
    }
    if (size_ >= no_index) throw Error(text.file(), "holds more points than can be numbered; split the file");
}

const double* Rows::row(std::size_t index) const {
    auto block = std::upper_bound(blocks_.begin(), blocks_.end(), index,
                                  [](std::size_t i, const Block& b) { return i < b.first_row; });
    --block;
    return block->values.data() + (index - block->first_row) * columns_;
}

std::vector<double> Rows::sample(std::size_t most) const {
    std::vector<double> values;
    const std::size_t count = std::min(most, size_);
    for (std::size_t i = 0; i < count; ++i) {
        const double* first = row(i * size_ / count);
        values.insert(values.end(), first, first + columns_);
    }
    return values;
}

double Rows::color_factor(const std::vector<Column>& columns, bool fractions) const {
    double max = 0;
    for (std::size_t c = 0; c < columns_; ++c) {
        if (columns[c].role < Role::red || columns[c].role > Role::blue) continue;
        for (const Block& block : blocks_)
            for (std::size_t i = c; i < block.values.size(); i += columns_) {
                max = std::max(max, std::isfinite(block.values[i]) ? block.values[i] : 0);
                fractions |= block.values[i] != std::floor(block.values[i]);
            }
    }
    return io::color_factor(max, fractions);
}

PointCloud Rows::to_cloud(const std::vector<Column>& columns, double factor) && {
    CloudColumns cloud(columns, size_, factor);
    for_each_task(blocks_.size(), [&](std::size_t i) {
        const Block& block = blocks_[i];
        if (block.values.empty()) return;
        for (std::size_t c = 0; c < columns_; ++c)
            cloud.store(c, block.first_row, block.values.size() / columns_, block.values.data() + c,
                        columns_);
        std::vector<double>().swap(blocks_[i].values);
    });
    return cloud.finish();
}

PointCloud Rows::to_cloud_by_halves() const {
    PointCloud cloud;
    const std::size_t half = size_ / 2;
    cloud.positions.resize(half);
    cloud.normals.resize(half);
    for_each_task(blocks_.size(), [&](std::size_t b) {
        const Block& block = blocks_[b];
        for (std::size_t i = 0; i * columns_ < block.values.size(); ++i) {
            const double* v = block.values.data() + i * columns_;
            const std::size_t index = block.first_row + i;
            (index < half ? cloud.positions[index] : cloud.normals[index - half]) = Vec3(v[0], v[1], v[2]);
        }
    });
    return cloud;
}

std::uint64_t count_rows(const Text& text, bool comments) {
    const auto counts = rows_per_chunk(text, text.chunks(), comments);
    return std::accumulate(counts.begin(), counts.end(), std::uint64_t(0));
}

/// Walks over few rows; counts more of them in parallel pieces, twice as many each time. So the cost follows
/// the rows to be skipped and not the rest of the file; a header may name very many.
const char* after_rows(const Text& text, std::uint64_t count, bool comments, const std::string& what) {
    const char* at = text.begin;
    std::uint64_t left = walk_rows(text, comments, std::min(count, few_rows), at);
    left += count - std::min(count, few_rows);
    for (std::size_t size = std::size_t(1) << 21; left > 0 && at != text.end; size *= 2) {
        Text part = text.from(at);
        if (static_cast<std::size_t>(text.end - at) > size) part.end = text.find_newline(at + size);
        const auto chunks = part.chunks();
        const auto counts = rows_per_chunk(part, chunks, comments);
        std::size_t chunk = 0;
        while (chunk < chunks.size() && counts[chunk] < left) left -= counts[chunk++];
        at = chunk < chunks.size() ? chunks[chunk].first : part.end;
        if (chunk < chunks.size()) left = walk_rows(text, comments, left, at);
    }
    if (left > 0)
        text.fail(text.end, "the file ends after " + std::to_string(count - left) + " of "
                                + std::to_string(count) + " " + what
                                + "; it was cut off, or its header counts wrong");
    return at;
}

} // namespace hsdm::io
