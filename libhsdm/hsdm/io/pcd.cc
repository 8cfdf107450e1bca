#include "hsdm/core/chunks.hh"
#include "hsdm/errors.hh"
#include "hsdm/io/formats.hh"
#include "hsdm/io/lzf.hh"
#include "hsdm/io/ply.hh"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <memory>

namespace hsdm::io {
namespace {

/// As the header describes it; `count` values of it lie in a row.
struct PcdField {
    std::string name;
    std::size_t size = 4, count = 1;
    char type = 'F'; ///< I, U or F

    /// Red, green and blue packed into the lower bytes of one value.
    bool is_packed_color() const { return (name == "rgb" || name == "rgba") && size == 4 && count == 1; }
};

enum class PcdData { ascii, binary, compressed };

struct PcdHeader {
    std::vector<PcdField> fields;
    std::uint64_t points = 0;
    PcdData data = PcdData::ascii;
    std::optional<Vec3> viewpoint;
    std::size_t size = 0; ///< bytes from the start of the source to the data
};

constexpr std::array keywords{"VERSION", "FIELDS", "COLUMNS",   "SIZE",   "TYPE", "COUNT",
                              "WIDTH",   "HEIGHT", "VIEWPOINT", "POINTS", "DATA"};

bool is_keyword(std::string_view word) {
    return std::ranges::find(keywords, word) != keywords.end();
}

class PcdHeaderReader {
public:
    explicit PcdHeaderReader(const Text& text) : text_(text) {}

    PcdHeader read() {
        for (const char* at = text_.begin; at != text_.end;) {
            line_ = at;
            const std::string_view line = trim(text_.line(at));
            if (line.empty() || line.front() == '#') continue;
            words_ = fields(line, most_columns + 2);
            if (!is_keyword(words_[0]))
                fail(io::quoted(words_[0]) + " is no word of a PCD header; correct or remove the line");
            if (words_.size() < 2) fail(io::quoted(words_[0]) + " has no value; correct the header");
            read_line();
            if (words_[0] != "DATA") continue;
            check();
            header_.size = static_cast<std::size_t>(at - text_.origin);
            return header_;
        }
        text_.fail(text_.end, "the header has no line DATA; the file was cut off");
    }

private:
    [[noreturn]] void fail(const std::string& message) const { text_.fail(line_, message); }

    std::uint64_t count(std::size_t word) const {
        const auto value = to_count(words_[word]);
        if (!value) fail(io::quoted(words_[word]) + " is no count; correct the header");
        return *value;
    }

    /// The line has a value for every field.
    void check_one_for_each() const {
        if (words_.size() - 1 != header_.fields.size())
            fail(std::to_string(words_.size() - 1) + " values for " + std::to_string(header_.fields.size())
                 + " FIELDS; correct the header");
    }

    void read_line() {
        const std::string_view word = words_[0];
        std::vector<PcdField>& all = header_.fields;
        if (word == "FIELDS" || word == "COLUMNS") {
            if (words_.size() - 1 > most_columns)
                fail("more than " + std::to_string(most_columns) + " FIELDS; leave some out");
            all.resize(words_.size() - 1);
            for (std::size_t i = 0; i < all.size(); ++i) all[i].name = words_[i + 1];
        } else if (word == "SIZE" || word == "TYPE" || word == "COUNT") {
            check_one_for_each();
            for (std::size_t i = 0; i < all.size(); ++i) read_of_field(word, i + 1, all[i]);
        } else if (word == "WIDTH") {
            width_ = count(1);
        } else if (word == "HEIGHT") {
            height_ = count(1);
        } else if (word == "POINTS") {
            points_ = count(1);
        } else if (word == "VIEWPOINT") {
            read_viewpoint();
        } else if (word == "DATA") {
            if (words_[1] == "binary")
                header_.data = PcdData::binary;
            else if (words_[1] == "binary_compressed")
                header_.data = PcdData::compressed;
            else if (words_[1] != "ascii")
                fail("unknown data " + io::quoted(words_[1])
                     + "; known are ascii, binary and binary_compressed");
        }
    }

    void read_of_field(std::string_view word, std::size_t at, PcdField& field) const {
        if (word == "TYPE") {
            field.type = words_[at][0];
            if (words_[at].size() != 1 || std::string_view("IUF").find(field.type) == std::string_view::npos)
                fail("unknown type " + io::quoted(words_[at]) + "; known are I, U and F");
        } else {
            const std::uint64_t value = count(at);
            if (word == "COUNT" ? value > most_columns : value != 1 && value != 2 && value != 4 && value != 8)
                fail(io::quoted(words_[at]) + " is no " + lower(word) + " of a field; correct the header");
            (word == "COUNT" ? field.count : field.size) = static_cast<std::size_t>(value);
        }
    }

    /// Zeros stand for an unknown one.
    void read_viewpoint() {
        if (words_.size() < 4) fail("VIEWPOINT needs a position; correct the header");
        Vec3 at;
        for (unsigned k = 0; k < 3; ++k) {
            const auto value = to_number(words_[k + 1]);
            if (!value) fail(io::quoted(words_[k + 1]) + " is no number; correct the header");
            at[k] = *value;
        }
        if (std::isfinite(at.sqrnorm()) && at.sqrnorm() > 0) header_.viewpoint = at;
    }

    void check() {
        if (header_.fields.empty()) fail("the header has no line FIELDS; correct it");
        std::size_t values = 0;
        for (const PcdField& field : header_.fields) {
            values += field.count;
            if (field.type == 'F' && field.size < 4)
                fail("field " + io::quoted(field.name) + " is of type F and size "
                     + std::to_string(field.size) + "; correct the header");
        }
        if (values > most_columns)
            fail("a point of " + std::to_string(values) + " values, more than " + std::to_string(most_columns)
                 + "; leave out descriptors");
        if (!points_ && !width_) fail("the header has neither POINTS nor WIDTH; correct it");
        std::uint64_t grid = 0;
        if (width_ && __builtin_mul_overflow(*width_, height_, &grid))
            fail("WIDTH times HEIGHT is more than can be counted; correct the header");
        header_.points = points_ ? *points_ : grid;
        if (points_ && width_ && *points_ != grid)
            fail("POINTS is " + std::to_string(*points_) + ", WIDTH times HEIGHT " + std::to_string(grid)
                 + "; correct the header");
        if (header_.points == 0) throw Error(text_.file(), "holds no points: the header says 0");
    }

    const Text& text_;
    PcdHeader header_;
    std::optional<std::uint64_t> width_, points_;
    std::uint64_t height_ = 1;
    const char* line_ = nullptr;
    std::vector<std::string_view> words_;
};

PlyType type_of(const PcdField& field) {
    if (field.type == 'F') return field.size == 4 ? PlyType::float32 : PlyType::float64;
    const bool is_signed = field.type == 'I';
    if (field.size == 1) return is_signed ? PlyType::int8 : PlyType::uint8;
    if (field.size == 2) return is_signed ? PlyType::int16 : PlyType::uint16;
    if (field.size == 4) return is_signed ? PlyType::int32 : PlyType::uint32;
    return is_signed ? PlyType::int64 : PlyType::uint64;
}

/// The values of a field as a binary file has them: colours are their bytes.
void add_binary(const PcdField& field, const std::string& name, std::vector<PlyProperty>& properties) {
    const auto add = [&](const std::string& called, PlyType type) {
        properties.push_back({called, type, false, {}});
    };
    if (field.is_packed_color()) {
        for (const char* component : {"blue", "green", "red"}) add(component, PlyType::uint8);
        add(field.name == "rgba" ? "alpha" : "_", PlyType::uint8);
    } else {
        add(name, type_of(field));
    }
}

/// The points as the only element of a PLY file: its body is laid out alike.
PlyHeader ply_header_of(const PcdHeader& pcd) {
    PlyElement point{"point", pcd.points, {}};
    for (const PcdField& field : pcd.fields)
        for (std::size_t k = 0; k < field.count; ++k) {
            const bool alone = field.count == 1 || field.name == "_";
            const std::string name = alone ? field.name : field.name + "_" + std::to_string(k);
            if (pcd.data == PcdData::ascii)
                point.properties.push_back({name, type_of(field), false, {}});
            else
                add_binary(field, name, point.properties);
        }
    PlyHeader ply;
    ply.encoding = pcd.data == PcdData::ascii ? PlyEncoding::ascii : PlyEncoding::little_endian;
    ply.elements.push_back(std::move(point));
    ply.size = pcd.data == PcdData::compressed ? 0 : pcd.size;
    ply.padded = true; // as PCL leaves room for what it has in memory between the fields
    return ply;
}

/// The points one after the other, from `fields` that hold the values of all points each.
std::unique_ptr<char[]> interleave(const char* values, const PcdHeader& pcd, std::size_t row) {
    const auto count = static_cast<std::size_t>(pcd.points);
    std::unique_ptr<char[]> points(new char[count * row]);
    for_chunks(count, chunks::quick, [&](std::size_t begin, std::size_t end, std::size_t) {
        std::size_t offset = 0; // in a point
        for (const PcdField& field : pcd.fields) {
            const std::size_t size = field.size * field.count;
            const char* from = values + offset * count;
            for (std::size_t i = begin; i != end; ++i)
                std::memcpy(points.get() + i * row + offset, from + i * size, size);
            offset += size;
        }
    });
    return points;
}

/// The points of a compressed file, laid out as in a binary one without its header. `row`: bytes of a point.
SourceBytes expand(const SourceBytes& bytes, const PcdHeader& pcd, std::size_t row) {
    std::string_view packed = bytes.view().substr(pcd.size);
    std::array<std::uint32_t, 2> sizes{}; // of the packed and of the expanded values
    static_assert(std::endian::native == std::endian::little, "the order of the file's bytes");
    if (packed.size() < sizeof sizes) throw Error(bytes.name(), "ends behind its header; it was cut off");
    std::memcpy(sizes.data(), packed.data(), sizeof sizes);
    packed.remove_prefix(sizeof sizes);
    if (packed.size() < sizes[0])
        throw Error(bytes.name(), "the file ends after " + std::to_string(packed.size()) + " of "
                                      + std::to_string(sizes[0]) + " compressed bytes; it was cut off");
    packed = packed.substr(0, sizes[0]);
    // Both before anything is allocated: neither number is to be trusted.
    if (sizes[1] % row != 0 || sizes[1] / row != pcd.points || sizes[1] / lzf_most_expansion > packed.size())
        throw Error(bytes.name(), std::to_string(sizes[0]) + " compressed bytes for "
                                      + std::to_string(sizes[1]) + " bytes do not fit "
                                      + std::to_string(pcd.points) + " points of " + std::to_string(row)
                                      + "; the file is damaged, export it again");
    const std::unique_ptr<char[]> values(new char[sizes[1]]);
    if (!expand_lzf(packed, {values.get(), sizes[1]}))
        throw Error(bytes.name(), "the compressed data are damaged; export the file again");
    return SourceBytes::of(interleave(values.get(), pcd, row), sizes[1], bytes.name());
}

PointCloud read_body(const SourceBytes& bytes, const PcdHeader& pcd, const PlyHeader& header,
                     const std::vector<Column>& columns) {
    if (pcd.data == PcdData::ascii)
        return read_ply_ascii(with_line_end_of_header(Text(bytes)), header, 0, columns);
    if (pcd.data == PcdData::binary) return read_ply_binary(bytes, header, 0, columns);
    return read_ply_binary(expand(bytes, pcd, header.elements[0].least_size()), header, 0, columns);
}

/// Text has a packed colour as one number, of a floating type by its bits.
void unpack_color(const PcdField& field, PointCloud& cloud) {
    const auto packed = std::ranges::find(cloud.scalars, field.name, &Scalar::name);
    if (packed == cloud.scalars.end()) return;
    cloud.colors.reserve(packed->values.size());
    for (double value : packed->values) {
        std::uint32_t bits = 0;
        if (field.type == 'F')
            bits = std::bit_cast<std::uint32_t>(static_cast<float>(value));
        else if (std::abs(value) <= 4294967295.0)
            bits = static_cast<std::uint32_t>(static_cast<std::int64_t>(value));
        const auto byte = [bits](int shift) { return static_cast<std::uint8_t>(bits >> shift); };
        cloud.colors.push_back(
            {byte(16), byte(8), byte(0), field.name == "rgba" ? byte(24) : std::uint8_t{255}});
    }
    cloud.scalars.erase(packed);
}

} // namespace

bool is_pcd(const Text& text) {
    for (const char* at = text.begin; at != text.end;) {
        const std::string_view line = trim(text.line(at));
        if (line.starts_with("# .PCD")) return true;
        if (line.empty() || line.front() == '#') continue;
        const auto words = fields(line, 2);
        return words.size() > 1 && (words[0] == "VERSION" || words[0] == "FIELDS");
    }
    return false;
}

PointFile read_pcd(const SourceBytes& bytes) {
    const bool head_suffices = bytes.head().find("\nDATA ") != std::string_view::npos;
    const Text text = with_line_end_of_header(head_suffices ? Text::head_of(bytes) : Text(bytes));
    const PcdHeader pcd = PcdHeaderReader(text).read();
    const PlyHeader header = ply_header_of(pcd);
    const PlyElement& point = header.elements[0];
    if (point.count >= no_index && point.count / 3 <= bytes.size())
        throw Error(bytes.name(), "holds more points than can be numbered; split the file");
    std::vector<std::string> names;
    for (const PlyProperty& property : point.properties) names.push_back(property.name);
    const auto columns = columns_from_names(names);
    if (!columns) throw Error(bytes.name(), "the points have no fields x, y and z; export them as points");

    PointFile file;
    file.format = "pcd";
    file.cloud = read_body(bytes, pcd, header, *columns);
    for (const PcdField& field : pcd.fields)
        if (pcd.data == PcdData::ascii && field.is_packed_color() && file.cloud.colors.empty())
            unpack_color(field, file.cloud);
    file.cloud.sensor = pcd.viewpoint;
    file.nonfinite = drop_nonfinite(file.cloud).nonfinite; // pixels without a measurement
    if (file.cloud.size() == 0) throw Error(bytes.name(), "holds no points: no coordinates are finite");
    return file;
}

} // namespace hsdm::io
