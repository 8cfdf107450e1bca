#include "hsdm/errors.hh"
#include "hsdm/io/formats.hh"
#include "hsdm/io/rows.hh"

#include <algorithm>
#include <cmath>

namespace hsdm::io {
namespace {

/// The lines before the first row, and the row's number of columns.
struct Prelude {
    const char* first_row = nullptr;
    std::size_t columns = 0;
    std::vector<std::string> names; ///< of a header line, which may be a comment
    const char* names_at = nullptr;
    bool names_in_comment = false;
    std::optional<std::uint64_t> count;
    const char* count_at = nullptr;
};

/// The names of a header line: split at semicolons, commas or tabs if it has any (names may then hold
/// blanks), else at blanks.
std::vector<std::string> split_names(std::string_view line) {
    char separator = ' ';
    for (char candidate : {'\t', ',', ';'})
        if (line.find(candidate) != std::string_view::npos) separator = candidate;
    const std::string_view inner = trim(line);
    const auto indent = static_cast<std::size_t>(inner.data() - line.data());
    line =
        separator == '\t' ? line.substr(0, indent + inner.size()) : inner; // a leading tab ends an empty name
    std::vector<std::string> names;
    while (names.size() <= most_columns) {
        const std::size_t end = std::min(line.find(separator), line.size());
        std::string_view name = trim(line.substr(0, end));
        if (name.size() > 1 && name.front() == name.back() && (name.front() == '"' || name.front() == '\''))
            name = name.substr(1, name.size() - 2);
        if (separator != ' ' || !name.empty()) names.emplace_back(name);
        if (end == line.size()) break;
        line.remove_prefix(end + 1);
    }
    if (names.size() > 1 && names.back().empty()) names.pop_back(); // a trailing separator
    return names;
}

std::string_view unquoted(std::string_view cell) {
    const bool quoted = cell.size() > 1 && cell.front() == '"' && cell.back() == '"';
    return quoted ? cell.substr(1, cell.size() - 2) : cell;
}

std::size_t comment_mark(std::string_view line) {
    if (line.starts_with("//")) return 2;
    return line.starts_with('#') ? 1 : 0;
}

/// The line less what stands in quotation marks.
std::string without_quotes(std::string_view line) {
    std::string rest;
    while (!line.empty()) {
        const char* const ends = end_of_quotes(line.data(), line.data() + line.size());
        if (!ends) rest += line.front();
        line.remove_prefix(ends ? static_cast<std::size_t>(ends - line.data()) : 1);
    }
    return rest;
}

/// A comma that is the decimal separator shows by a second separator beside it, and by no point anywhere.
bool has_decimal_comma(std::string_view line) {
    if (line.find(',') == std::string_view::npos || line.find('.') != std::string_view::npos) return false;
    if (line.find(';') != std::string_view::npos) return true;
    bool pending_blank = false; // a blank behind a field, with no comma seen yet
    char last = ',';
    for (char c : trim(line)) {
        if (is_blank(c)) {
            pending_blank |= last != ',';
            continue;
        }
        if (pending_blank && c != ',') return true;
        pending_blank = false;
        last = c;
    }
    return false;
}

class PreludeReader {
public:
    PreludeReader(const Text& text, const std::vector<Column>& asked) : text_(text), asked_(asked) {}

    Prelude read() {
        const char* first_text = nullptr;
        for (const char* at = text_.begin; at != text_.end;) {
            const char* line_begin = at;
            const std::string_view whole = text_.line(at), line = trim(whole);
            if (line.empty()) continue;
            if (const std::size_t mark = comment_mark(line)) {
                keep_names(trim(line.substr(mark)), line_begin, true);
            } else if (is_row(trim(without_comment(line)), line_begin)) {
                prelude_.first_row = line_begin;
                return prelude_;
            } else if (!prelude_.count || prelude_.count_at != line_begin) {
                if (!first_text) first_text = line_begin;
                keep_names(whole, line_begin, false);
            }
        }
        if (prelude_.count)
            text_.fail(prelude_.count_at, "a count of points and no point after it; the file was cut off");
        if (!first_text) throw Error(text_.file(), "holds no points; expected lines of x y z");
        const char* at = first_text;
        text_.fail(first_text, io::quoted(trim(text_.line(at)))
                                   + " and what follows hold no point; expected lines of x y z");
    }

private:
    /// True for the first row of numbers; notes a count on the way. Throws if the line is neither a row nor
    /// wholly text.
    bool is_row(std::string_view line, const char* at) {
        const auto cells = fields(line, std::max(asked_.size(), most_columns) + 1);
        std::size_t numbers = 0, first_bad = cells.size();
        for (std::size_t i = 0; i < cells.size(); ++i) {
            const bool needed = asked_.empty() || (i < asked_.size() && asked_[i].role != Role::skip);
            if (!needed || cells[i].empty()) continue;
            if (to_number(unquoted(cells[i])))
                ++numbers;
            else
                first_bad = std::min(first_bad, i);
        }
        if (numbers == 0) return false;
        if (has_decimal_comma(without_quotes(line)))
            text_.fail(at, "commas beside other separators look like decimal commas; write 1.5 for 1,5, or "
                           "separate columns in one way only");
        if (first_bad < cells.size())
            text_.fail(at, io::quoted(cells[first_bad]) + " in column " + std::to_string(first_bad + 1)
                               + " is not a number; correct it, or name the columns and give this one as _");
        if (cells.size() == 1 && !prelude_.count && to_count(cells[0])) {
            prelude_.count = to_count(cells[0]);
            prelude_.count_at = at;
            return false;
        }
        prelude_.columns = cells.size();
        // The header's last column may be empty in the first row.
        if (is_separator(line.back()) && prelude_.names.size() == cells.size() + 1) ++prelude_.columns;
        // Header and rows may be indented by a tab.
        if (*at == '\t' && prelude_.names.size() == prelude_.columns + 1 && prelude_.names.front().empty())
            prelude_.names.erase(prelude_.names.begin());
        check_width(cells.size(), at);
        return true;
    }

    void check_width(std::size_t width, const char* at) const {
        if (asked_.empty() && width > most_columns)
            text_.fail(at, "more than " + std::to_string(most_columns)
                               + " columns; name the first of them, up to those that are wanted");
        const std::size_t needed = asked_.empty() ? 3 : asked_.size();
        if (width >= needed) return;
        text_.fail(at,
                   std::to_string(width) + (width == 1 ? " column, but " : " columns, but ")
                       + (asked_.empty() ? "x, y and z are needed; complete the line"
                                         : std::to_string(needed) + " were named; name those the file has"));
    }

    void keep_names(std::string_view line, const char* at, bool comment) {
        auto names = split_names(line);
        if (names.size() > most_columns || (comment && !columns_from_names(names))) return;
        prelude_.names = std::move(names);
        prelude_.names_at = at;
        prelude_.names_in_comment = comment;
    }

    const Text& text_;
    const std::vector<Column>& asked_;
    Prelude prelude_;
};

std::string line_number(const Text& text, const char* at) {
    return "line " + std::to_string(text.line_of(at));
}

RowLayout layout_of(const Text& text, const Prelude& prelude, const std::vector<Column>& asked,
                    TableKind kind) {
    RowLayout layout;
    layout.comments = true;
    layout.quotes = true;
    layout.counts = kind == TableKind::pts;
    layout.advice = "correct the line, or name the columns and give this one as _";
    layout.origin = line_number(text, prelude.first_row) + " has " + std::to_string(prelude.columns);
    layout.cells.assign(prelude.columns, RowLayout::Cell::number);
    if (!asked.empty()) {
        layout.cells.resize(asked.size());
        for (std::size_t i = 0; i < asked.size(); ++i)
            if (asked[i].role == Role::skip) layout.cells[i] = RowLayout::Cell::skip;
        layout.more_allowed = true;
        layout.origin = std::to_string(asked.size()) + " columns were named";
    }
    return layout;
}

/// Finds the columns' roles, by the most reliable source there is: the caller, a header line, the values.
/// `told` is set in the last case, if more than positions had to be guessed.
std::vector<Column> find_columns(const Text& text, const Prelude& prelude, const Rows& rows, TableKind kind,
                                 const std::vector<Column>& asked, std::string& told) {
    if (!asked.empty()) return asked;
    const bool fitting = prelude.names.size() == rows.columns();
    const auto named = columns_from_names(prelude.names);
    if (named && fitting) return *named;
    if (named && !prelude.names_in_comment)
        text.fail(prelude.names_at, "names " + std::to_string(prelude.names.size()) + " columns, but "
                                        + line_number(text, prelude.first_row) + " has "
                                        + std::to_string(rows.columns())
                                        + "; correct the header or remove it");
    constexpr std::size_t sample_size = 4096;
    auto columns = columns_from_values(rows.sample(sample_size), rows.columns(), kind == TableKind::pts);
    if (kind == TableKind::xyzrgb && columns.size() == 6) { // fractions too, which no values tell of
        for (std::size_t k = 0; k < 3; ++k)
            columns[3 + k].role = static_cast<Role>(static_cast<std::size_t>(Role::red) + k);
        return columns;
    }
    for (std::size_t i = 0; fitting && i < columns.size(); ++i)
        if (columns[i].role == Role::scalar && !prelude.names[i].empty()) columns[i].name = prelude.names[i];
    if (columns.size() > 3) told = list_of(columns);
    return columns;
}

std::string rows_text(double count) {
    std::string text = std::to_string(static_cast<std::uint64_t>(count));
    return text + (count == 1 ? " point" : " points");
}

/// Every count must be that of the rows up to the next count or the end.
void check_counts(const Text& text, const Prelude& prelude, const Rows& rows) {
    std::vector<Rows::Count> counts;
    if (prelude.count) counts.push_back({prelude.count_at, static_cast<double>(*prelude.count), 0});
    counts.insert(counts.end(), rows.counts().begin(), rows.counts().end());
    for (std::size_t i = 0; i < counts.size(); ++i) {
        const std::size_t end = i + 1 < counts.size() ? counts[i + 1].rows_before : rows.size();
        const auto found = static_cast<double>(end - counts[i].rows_before);
        if (!(counts[i].value >= 0 && counts[i].value == std::floor(counts[i].value)))
            text.fail(counts[i].at, "a line with one number that is no count; complete or remove it");
        if (counts[i].value != found)
            text.fail(counts[i].at,
                      "the count does not fit: "
                          + (counts[i].value < 1e18 ? rows_text(counts[i].value) : "very many points")
                          + " announced, " + rows_text(found)
                          + " found; correct the count, or read a complete file");
    }
}

} // namespace

PointFile read_table(const SourceBytes& bytes, TableKind kind, const std::string& columns) {
    const Text text(bytes);
    const std::vector<Column> asked = columns.empty() ? std::vector<Column>{} : parse_columns(columns);
    const Prelude prelude = PreludeReader(text, asked).read();
    Rows rows(text.from(prelude.first_row), layout_of(text, prelude, asked, kind));

    PointFile file;
    const auto count = static_cast<double>(prelude.count.value_or(0));
    if (prelude.count && asked.empty() && rows.columns() == 3 && kind != TableKind::pts
        && static_cast<double>(rows.size()) == 2 * count) {
        file.format = "pwn"; // positions, then as many normals
        file.cloud = rows.to_cloud_by_halves();
        return file;
    }
    if (kind == TableKind::pwn && prelude.count && rows.columns() == 3
        && static_cast<double>(rows.size()) != count)
        text.fail(prelude.count_at, rows_text(count) + " announced, but the file has "
                                        + std::to_string(rows.size())
                                        + " lines; as many positions and then as many normals must follow");
    check_counts(text, prelude, rows);
    const auto roles = find_columns(text, prelude, rows, kind, asked, file.columns);
    const double factor = rows.color_factor(roles, false);
    file.cloud = std::move(rows).to_cloud(roles, factor);
    file.format = kind == TableKind::pts ? "pts" : kind == TableKind::pwn ? "pwn" : "xyz";
    return file;
}

} // namespace hsdm::io
