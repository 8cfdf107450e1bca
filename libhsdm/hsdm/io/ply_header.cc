#include "hsdm/io/ply_header.hh"

#include "hsdm/io/columns.hh"

#include <algorithm>

namespace hsdm::io {
namespace {

struct TypeName {
    std::string_view name;
    PlyType type;
};

constexpr TypeName type_names[] = {
    {"char", PlyType::int8},       {"int8", PlyType::int8},       {"uchar", PlyType::uint8},
    {"uint8", PlyType::uint8},     {"short", PlyType::int16},     {"int16", PlyType::int16},
    {"ushort", PlyType::uint16},   {"uint16", PlyType::uint16},   {"int", PlyType::int32},
    {"int32", PlyType::int32},     {"uint", PlyType::uint32},     {"uint32", PlyType::uint32},
    {"float", PlyType::float32},   {"float32", PlyType::float32}, {"double", PlyType::float64},
    {"float64", PlyType::float64},
};

/// `property list uchar int vertex_indices`: no line has more that count, of comments not even those.
constexpr std::size_t most_words = 5;

class HeaderReader {
public:
    explicit HeaderReader(const Text& text) : text_(text) {}

    PlyHeader read() {
        const char* at = text_.begin;
        if (trim(text_.line(at)) != "ply")
            text_.fail(text_.begin, "a PLY file begins with a line \"ply\"; check the format");
        bool has_format = false;
        while (at != text_.end) {
            line_ = at;
            words_.clear();
            std::string_view rest = trim(text_.line(at));
            for (; !rest.empty() && words_.size() < most_words; rest = trim(rest)) {
                const std::size_t length =
                    static_cast<std::size_t>(std::find_if(rest.begin(), rest.end(), is_blank) - rest.begin());
                words_.push_back(rest.substr(0, length));
                rest.remove_prefix(length);
            }
            if (words_.empty() || words_[0] == "comment" || words_[0] == "obj_info") continue;
            if (words_[0] == "end_header") {
                if (!has_format) fail("the header has no format line; export the file again");
                header_.size = static_cast<std::size_t>(at - text_.origin);
                return std::move(header_);
            }
            if (words_[0] == "format") {
                read_format();
                has_format = true;
            } else if (words_[0] == "element")
                read_element();
            else if (words_[0] == "property")
                read_property();
            else
                fail(io::quoted(words_[0]) + " is no word of a PLY header; correct or remove the line");
        }
        text_.fail(text_.end, "the header has no end_header; the file was cut off");
    }

private:
    [[noreturn]] void fail(const std::string& message) const { text_.fail(line_, message); }

    void read_format() {
        if (words_.size() < 2)
            fail("the format is missing; it is ascii, binary_little_endian or binary_big_endian");
        if (words_[1] == "ascii")
            header_.encoding = PlyEncoding::ascii;
        else if (words_[1] == "binary_little_endian")
            header_.encoding = PlyEncoding::little_endian;
        else if (words_[1] == "binary_big_endian")
            header_.encoding = PlyEncoding::big_endian;
        else
            fail("unknown format " + io::quoted(words_[1])
                 + "; known are ascii, binary_little_endian, binary_big_endian");
    }

    void read_element() {
        if (words_.size() < 3) fail("an element needs a name and a count; correct the header");
        const auto count = to_count(words_[2]);
        if (!count) fail(io::quoted(words_[2]) + " is no count of elements; correct the header");
        header_.elements.push_back({std::string(words_[1]), *count, {}});
    }

    PlyType type(std::string_view name) const {
        for (const TypeName& known : type_names)
            if (known.name == name) return known.type;
        fail("unknown property type " + io::quoted(name)
             + "; known are char uchar short ushort int uint float double");
    }

    void read_property() {
        if (header_.elements.empty()) fail("a property before the first element; correct the header");
        if (header_.elements.back().properties.size() == most_columns)
            fail("more than " + std::to_string(most_columns) + " properties of an element; leave some out");
        PlyProperty property;
        property.is_list = words_.size() > 1 && words_[1] == "list";
        if (words_.size() < (property.is_list ? 5u : 3u))
            fail("a property needs a type and a name; correct the header");
        if (property.is_list) {
            property.count_type = type(words_[2]);
            if (property.count_type >= PlyType::float32)
                fail("a list's count must be of an integer type; correct the header");
        }
        property.type = type(words_[property.is_list ? 3 : 1]);
        property.name = words_[property.is_list ? 4 : 2];
        header_.elements.back().properties.push_back(std::move(property));
    }

    const Text& text_;
    PlyHeader header_;
    const char* line_ = nullptr;
    std::vector<std::string_view> words_;
};

} // namespace

bool PlyElement::has_list() const {
    return std::any_of(properties.begin(), properties.end(), [](const PlyProperty& p) { return p.is_list; });
}

std::size_t PlyElement::least_size() const {
    std::size_t size = 0;
    for (const PlyProperty& property : properties)
        size += size_of(property.is_list ? property.count_type : property.type);
    return size;
}

Text with_line_end_of_header(Text text) {
    const char* end = std::find_if(text.begin, text.end, [](char c) { return c == '\n' || c == '\r'; });
    const bool only_returns = end != text.end && *end == '\r' && (end + 1 == text.end || end[1] != '\n');
    text.newline = only_returns ? '\r' : '\n';
    return text;
}

PlyHeader read_ply_header(const Text& text) {
    return HeaderReader(text).read();
}

} // namespace hsdm::io
