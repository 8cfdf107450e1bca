#include "hsdm/errors.hh"
#include "hsdm/io/formats.hh"
#include "hsdm/io/npy.hh"
#include "hsdm/io/text.hh"

#include <functional>
#include <numeric>

namespace hsdm::io {
namespace {

constexpr std::string_view npy_magic{"\x93NUMPY", 6};
/// More than the names of all columns that are allowed take; what is parsed takes many times its bytes.
constexpr double longest_header = 1 << 20;
constexpr int deepest_literal = 12; ///< fields in fields, of which each takes some of the stack

/// A value of the header, which is a literal of Python: a text, a number, a truth, or a list of values. Of a
/// dictionary the list has keys and values in turn.
struct Literal {
    enum class Kind { text, number, truth, list } kind = Kind::text;
    std::string text;
    std::size_t number = 0;
    std::vector<Literal> items;

    bool is_text() const { return kind == Kind::text; }
    bool is_list() const { return kind == Kind::list; }
};

class LiteralParser {
public:
    LiteralParser(const SourceBytes& source, std::string_view text, std::size_t offset)
        : source_(source), text_(text), offset_(offset) {}

    Literal parse() {
        Literal value = next(0);
        skip_blanks();
        if (at_ != text_.size()) fail("there is more behind its end");
        return value;
    }

private:
    [[noreturn]] void fail(const std::string& what) const {
        throw Error(source_.name(), "the NPY header cannot be read: " + what + " (at byte "
                                        + std::to_string(offset_ + at_) + "); save the array again");
    }
    void skip_blanks() {
        while (at_ < text_.size() && (is_blank(text_[at_]) || text_[at_] == '\n' || text_[at_] == '\0'))
            ++at_;
    }
    char peek() {
        skip_blanks();
        return at_ < text_.size() ? text_[at_] : '\0';
    }

    Literal next(int depth) {
        if (depth > deepest_literal) fail("lists within lists beyond what any array has");
        const char c = peek();
        if (c == '\'' || c == '"') return quoted_text(c);
        if (c == '(' || c == '[' || c == '{') return list(depth, c == '(' ? ')' : c == '[' ? ']' : '}');
        if (c >= '0' && c <= '9') return number();
        for (const std::string_view word : {"True", "False", "None"})
            if (text_.substr(at_).starts_with(word)) {
                at_ += word.size();
                return {Literal::Kind::truth, "", word == "True", {}};
            }
        fail(c == '\0' ? "it ends early" : "a value was expected");
    }

    Literal quoted_text(char quote) {
        Literal value;
        for (++at_; at_ < text_.size() && text_[at_] != quote; ++at_) {
            if (text_[at_] == '\\' && at_ + 1 < text_.size()) ++at_;
            value.text += text_[at_];
        }
        if (at_ == text_.size()) fail("a text does not end");
        ++at_;
        return value;
    }

    Literal list(int depth, char end) {
        Literal value{Literal::Kind::list, "", 0, {}};
        ++at_;
        while (peek() != end) {
            value.items.push_back(next(depth + 1));
            if (end == '}' && value.items.size() % 2 == 1) {
                if (peek() != ':') fail("a colon was expected");
                ++at_;
                continue;
            }
            if (peek() == ',')
                ++at_;
            else if (peek() != end)
                fail("a comma was expected");
        }
        ++at_;
        return value;
    }

    Literal number() {
        Literal value{Literal::Kind::number, "", 0, {}};
        const std::size_t begin = at_;
        while (at_ < text_.size() && text_[at_] >= '0' && text_[at_] <= '9') ++at_;
        const auto count = to_count(text_.substr(begin, at_ - begin));
        if (!count) fail("a number is too large");
        value.number = static_cast<std::size_t>(*count);
        if (at_ < text_.size() && text_[at_] == 'L') ++at_; // Python 2
        return value;
    }

    const SourceBytes& source_;
    std::string_view text_;
    std::size_t offset_; ///< of the text in the source
    std::size_t at_ = 0;
};

/// Elements as the header's `descr` spells them, taken apart.
class Elements {
public:
    Elements(const SourceBytes& source, NpyArray& array) : source_(source), array_(array) {}

    void add(const Literal& description) {
        array_.structured = description.is_list();
        array_.element = add_type(description, "", 1);
        if (array_.element == 0) fail("has elements without a byte; save arrays of numbers");
    }

private:
    [[noreturn]] void fail(const std::string& what) const { throw Error(source_.name(), what); }

    std::size_t product(std::size_t a, std::size_t b) const {
        std::size_t result = 0;
        if (__builtin_mul_overflow(a, b, &result)) fail("has elements of more bytes than can be counted");
        return result;
    }

    /// Returns the bytes of `count` of the type; their numbers lie from offset_ on.
    std::size_t add_type(const Literal& type, const std::string& name, std::size_t count) {
        if (type.is_text()) return add_simple(type.text, name, count);
        if (!type.is_list()) fail("has a header with a type that is none; save the array again");
        if (count != 1) fail("has fields of several records each, which are not read; save them one by one");
        const std::size_t begin = offset_;
        for (const Literal& field : type.items) add_field(field, name);
        return offset_ - begin;
    }

    /// (name, type), (name, type, shape); the name may be a pair of title and name.
    void add_field(const Literal& field, const std::string& outer) {
        const std::vector<Literal>& parts = field.items;
        if (!field.is_list() || parts.size() < 2 || parts.size() > 3)
            fail("has a header with a field that is none; save the array again");
        const Literal& own = parts[0].is_list() && parts[0].items.size() == 2 ? parts[0].items[1] : parts[0];
        std::size_t count = 1;
        if (parts.size() == 3) {
            if (parts[2].kind == Literal::Kind::number) count = parts[2].number;
            for (const Literal& size : parts[2].items) count = product(count, size.number);
        }
        const std::string name = outer.empty() ? own.text : outer + '_' + own.text;
        const std::size_t begin = offset_, bytes = add_type(parts[1], name, count);
        if (__builtin_add_overflow(begin, bytes, &offset_))
            fail("has elements of more bytes than can be counted");
    }

    /// `<f8`: byte order, kind, bytes.
    std::size_t add_simple(const std::string& type, const std::string& name, std::size_t count) {
        const bool has_order = type.find_first_of("<>|=") == 0;
        const std::string_view rest = std::string_view(type).substr(has_order);
        const char kind = rest.empty() ? '?' : rest[0];
        const auto size = rest.empty() ? std::nullopt : to_count(rest.substr(1));
        if (kind == 'O')
            fail("holds Python objects, which are not read; save an array of numbers (astype(float))");
        if (!size) fail("has elements of type " + io::quoted(type) + ", which is not known; save numbers");
        const std::size_t bytes = product(static_cast<std::size_t>(*size), kind == 'U' ? 4 : 1);
        if (const auto number = stored_type(kind, bytes)) {
            if (array_.fields.size() == most_columns || count > most_columns)
                fail("has more than " + std::to_string(most_columns) + " fields; leave some out");
            array_.fields.push_back({name, offset_, *number, type[0] == '>', count});
        } else if (kind == 'f' || kind == 'c') { // texts, times and padding are passed by
            fail("has elements of type " + io::quoted(type)
                 + ", which is not read; convert them with astype(float)");
        }
        return product(bytes, count);
    }

    static std::optional<StoredType> stored_type(char kind, std::size_t bytes) {
        const bool is_signed = kind == 'i';
        if (kind == 'b' && bytes == 1) return StoredType::uint8;
        if (kind == 'f' && bytes == 4) return StoredType::float32;
        if (kind == 'f' && bytes == 8) return StoredType::float64;
        if (kind != 'i' && kind != 'u') return std::nullopt;
        if (bytes == 1) return is_signed ? StoredType::int8 : StoredType::uint8;
        if (bytes == 2) return is_signed ? StoredType::int16 : StoredType::uint16;
        if (bytes == 4) return is_signed ? StoredType::int32 : StoredType::uint32;
        if (bytes == 8) return is_signed ? StoredType::int64 : StoredType::uint64;
        return std::nullopt;
    }

    const SourceBytes& source_;
    NpyArray& array_;
    std::size_t offset_ = 0;
};

/// The header's text, whose length is a number of 2 bytes in version 1, of 4 since.
std::string_view header_text(const SourceBytes& bytes) {
    const std::string_view head = bytes.head();
    const auto cut_off = [&](std::size_t wanted) {
        throw Error(bytes.name(), "the file ends within its NPY header (at byte "
                                      + std::to_string(bytes.size()) + " of " + std::to_string(wanted)
                                      + "); it was cut off");
    };
    if (head.size() < 10) cut_off(10);
    const auto version = static_cast<unsigned char>(head[6]);
    if (version < 1 || version > 3)
        throw Error(bytes.name(), "NPY version " + std::to_string(version)
                                      + " is not known (at byte 6); save the array with another NumPy");
    const std::size_t begin = version == 1 ? 10 : 12;
    if (head.size() < begin) cut_off(begin);
    double length = 0;
    gather_of(version == 1 ? StoredType::uint16 : StoredType::uint32, false)(head.data() + 8, 0, 1, &length);
    if (length > longest_header)
        throw Error(bytes.name(), "an NPY header of " + std::to_string(static_cast<std::size_t>(length))
                                      + " bytes (at byte 8), which no array of numbers needs; save it again");
    const std::size_t end = begin + static_cast<std::size_t>(length);
    if (end > bytes.size()) cut_off(end);
    return (end <= head.size() ? head : bytes.view()).substr(begin, end - begin);
}

} // namespace

std::size_t NpyArray::elements() const {
    return std::accumulate(shape.begin(), shape.end(), std::size_t(1), std::multiplies<>());
}

std::size_t NpyArray::width() const {
    return structured || shape.size() < 2 ? 1 : shape.back();
}

std::size_t NpyArray::rows() const {
    return width() == 0 ? 0 : elements() / width();
}

std::string NpyArray::shape_words() const {
    std::string words;
    for (const std::size_t size : shape) words += (words.empty() ? "" : ", ") + std::to_string(size);
    return '(' + words + (shape.size() == 1 ? ",)" : ")");
}

bool is_npy(const SourceBytes& bytes) {
    return bytes.head().starts_with(npy_magic);
}

NpyArray read_npy_header(const SourceBytes& bytes, std::size_t total) {
    if (!is_npy(bytes))
        throw Error(bytes.name(), "an NPY file begins with \"\\x93NUMPY\"; this one does not, check it");
    const std::string_view text = header_text(bytes);
    const std::size_t begin = static_cast<unsigned char>(bytes.head()[6]) == 1 ? 10 : 12;
    const Literal header = LiteralParser(bytes, text, begin).parse();
    const Literal *type = nullptr, *shape = nullptr;
    NpyArray array;
    array.data_at = begin + text.size();
    for (std::size_t i = 0; header.is_list() && i + 1 < header.items.size(); i += 2) {
        const Literal& value = header.items[i + 1];
        if (header.items[i].text == "descr") type = &value;
        if (header.items[i].text == "shape") shape = &value;
        if (header.items[i].text == "fortran_order") array.fortran = value.number != 0;
    }
    if (!type || !shape || !shape->is_list())
        throw Error(bytes.name(), "the NPY header lacks descr or shape (at byte " + std::to_string(begin)
                                      + "); save the array again");
    Elements(bytes, array).add(*type);
    std::size_t size = array.element;
    for (const Literal& dimension : shape->items) {
        array.shape.push_back(dimension.number);
        if (__builtin_mul_overflow(size, dimension.number, &size))
            throw Error(bytes.name(), "the NPY header announces more elements than can be counted (at byte "
                                          + std::to_string(begin) + "); save the array again");
    }
    const std::size_t found = total - array.data_at;
    if (found < size)
        throw Error(bytes.name(), "the file ends after " + std::to_string(found) + " of "
                                      + std::to_string(size) + " bytes of the array " + array.shape_words()
                                      + " (at byte " + std::to_string(total)
                                      + "); it was cut off, or its header counts wrong");
    if (found > size)
        throw Error(bytes.name(), std::to_string(found - size) + " bytes behind the array "
                                      + array.shape_words() + " (at byte "
                                      + std::to_string(array.data_at + size)
                                      + "); save one array a file, or several as NPZ");
    return array;
}

} // namespace hsdm::io
