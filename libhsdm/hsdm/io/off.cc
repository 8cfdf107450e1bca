#include "hsdm/errors.hh"
#include "hsdm/io/formats.hh"
#include "hsdm/io/rows.hh"

#include <algorithm>

namespace hsdm::io {
namespace {

/// What the keyword says each vertex has, e.g. `CNOFF`: [ST][C][N][4][n]OFF.
struct OffKeyword {
    bool texture = false, colors = false, normals = false;
    std::string_view rest; ///< what stands behind the keyword in its line
};

OffKeyword read_keyword(const Text& text, const char* line_begin, std::string_view line) {
    OffKeyword keyword;
    const std::size_t off = line.find("OFF");
    std::string_view letters = line.substr(0, off);
    keyword.rest = trim(line.substr(off + 3));
    if (letters.starts_with("ST")) {
        keyword.texture = true;
        letters.remove_prefix(2);
    }
    for (char letter : letters) {
        if (letter == 'C')
            keyword.colors = true;
        else if (letter == 'N')
            keyword.normals = true;
        else
            text.fail(line_begin, io::quoted(line.substr(0, off + 3))
                                      + " has vertices that are not x y z; export the file as OFF");
    }
    if (keyword.rest.starts_with("BINARY"))
        text.fail(line_begin, "binary OFF files are not read; export the file as text");
    return keyword;
}

std::vector<Column> columns_of(const OffKeyword& keyword, const Rows& rows) {
    const std::size_t count = rows.columns(), texture = keyword.texture ? 2 : 0;
    if (!keyword.colors && !keyword.normals && !texture)
        return columns_from_values(rows.sample(4096), count, false);
    std::vector<Role> roles{Role::x, Role::y, Role::z};
    if (keyword.normals) roles.insert(roles.end(), {Role::nx, Role::ny, Role::nz});
    if (keyword.colors) roles.insert(roles.end(), {Role::red, Role::green, Role::blue});
    if (keyword.colors && count == roles.size() + 1 + texture) roles.push_back(Role::alpha);
    std::vector<Column> columns(std::max(count, roles.size()));
    for (std::size_t i = 0; i < roles.size(); ++i) columns[i].role = roles[i];
    return columns;
}

class OffReader {
public:
    explicit OffReader(const Text& text) : text_(text), at_(text.begin) {}

    PointFile read() {
        read_counts();
        PointFile file;
        file.format = "off";
        file.faces = static_cast<std::size_t>(faces_);
        Text body = text_.from(at_);
        body.end = after_rows(body, vertices_, true, "vertices");

        const char* first_row = body.begin;
        const std::string_view first = next_line(first_row);
        RowLayout layout;
        layout.comments = true;
        const std::size_t width = fields(without_comment(first), most_columns + 1).size();
        if (width > most_columns)
            text_.fail(line_, "more than " + std::to_string(most_columns)
                                  + " numbers for a vertex; correct the line");
        layout.cells.assign(std::max<std::size_t>(3, width), RowLayout::Cell::number);
        layout.origin = "the first vertex has " + std::to_string(layout.cells.size());
        layout.advice = "correct the line, or the count of vertices in the header";
        Rows rows(body, layout);
        if (rows.size() != vertices_) throw Error(text_.file(), "empty vertex lines; export the file again");
        const auto columns = columns_of(keyword_, rows);
        if (columns.size() > rows.columns())
            text_.fail(body.begin, "the vertices have " + std::to_string(rows.columns())
                                       + " numbers, too few for the keyword in the first line; correct it");
        const double factor = rows.color_factor(columns, false);
        file.cloud = std::move(rows).to_cloud(columns, factor);
        return file;
    }

private:
    /// The next line that is neither empty nor a comment, without its end; moves `at` behind it.
    std::string_view next_line(const char*& at) {
        while (at != text_.end) {
            line_ = at;
            const std::string_view line = trim(text_.line(at));
            if (!line.empty() && line.front() != '#') return line;
        }
        text_.fail(text_.end, "the file ends within its header; it was cut off");
    }

    void read_counts() {
        std::string_view line = next_line(at_);
        if (is_off_keyword(line)) {
            keyword_ = read_keyword(text_, line_, line);
            line = keyword_.rest;
            if (line.empty() || line.front() == '#') line = next_line(at_);
        }
        const auto counts = fields(without_comment(line), 2);
        const auto vertices = counts.size() < 2 ? std::nullopt : to_count(counts[0]);
        const auto faces = counts.size() < 2 ? std::nullopt : to_count(counts[1]);
        if (!vertices || !faces)
            text_.fail(line_, io::quoted(line)
                                  + " are not the numbers of vertices, faces and edges; correct the header");
        if (*vertices == 0) text_.fail(line_, "holds no points: the header says 0 vertices");
        vertices_ = *vertices;
        faces_ = *faces;
    }

    const Text& text_;
    const char* at_;
    const char* line_ = nullptr;
    OffKeyword keyword_;
    std::uint64_t vertices_ = 0, faces_ = 0;
};

} // namespace

bool is_off_keyword(std::string_view line) {
    const std::size_t off = line.find("OFF");
    return off <= 6 && line.find_first_not_of("STCN4n") >= off;
}

PointFile read_off(const SourceBytes& bytes) {
    const Text text(bytes);
    return OffReader(text).read();
}

} // namespace hsdm::io
