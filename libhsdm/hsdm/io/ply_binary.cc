#include "hsdm/errors.hh"
#include "hsdm/io/binary_columns.hh"
#include "hsdm/io/ply.hh"

#include <algorithm>
#include <cmath>

namespace hsdm::io {
namespace {

/// A property as the body reads it.
struct Field {
    std::size_t offset; ///< within the element, if it has no list
    std::size_t size;
    Gather gather;              ///< of the value, or of a list's count
    std::size_t list_item_size; ///< 0: no list
};

class BinaryBody {
public:
    BinaryBody(const SourceBytes& bytes, const PlyHeader& header)
        : bytes_(bytes), at_(header.size), big_endian_(header.encoding == PlyEncoding::big_endian) {}

    std::size_t at() const { return at_; }
    std::size_t left() const { return bytes_.size() - at_; }

    std::vector<Field> fields(const PlyElement& element) const {
        std::vector<Field> result;
        std::size_t offset = 0;
        for (const PlyProperty& property : element.properties) {
            const PlyType type = property.is_list ? property.count_type : property.type;
            result.push_back({offset, size_of(type), gather_of(type, big_endian_),
                              property.is_list ? size_of(property.type) : 0});
            offset += size_of(type);
        }
        return result;
    }

    /// Throws unless the file is long enough for the element's count: what every allocation relies on.
    void check_size(const PlyElement& element) const {
        const std::size_t size = element.least_size();
        if (size == 0 || element.count <= left() / size) return;
        throw Error(bytes_.name(), "the file ends after " + std::to_string(left() / size) + " of "
                                       + std::to_string(element.count) + " elements " + element.name
                                       + " (at byte " + std::to_string(bytes_.size())
                                       + "); it was cut off, or its header counts wrong");
    }

    void skip(const PlyElement& element) {
        check_size(element);
        if (!element.has_list()) {
            at_ += element.count * element.least_size();
            return;
        }
        const auto layout = fields(element);
        for (std::uint64_t i = 0; i < element.count; ++i) read_element(layout, element, i, nullptr);
    }

    /// Moves over one element, and writes its values to `row` (0 for a list) unless that is null.
    void read_element(const std::vector<Field>& layout, const PlyElement& element, std::uint64_t index,
                      double* row) {
        const char* data = bytes_.view().data();
        for (const Field& field : layout) {
            if (left() < field.size) fail_cut_off(element, index);
            double value;
            field.gather(data + at_, 0, 1, &value);
            at_ += field.size;
            if (field.list_item_size) {
                if (value < 0)
                    throw Error(bytes_.name(), "a list of negative length in element " + element.name + " "
                                                   + std::to_string(index) + " (at byte "
                                                   + std::to_string(at_) + "); export the file again");
                const auto items = static_cast<std::size_t>(value);
                if (items > left() / field.list_item_size) fail_cut_off(element, index);
                at_ += items * field.list_item_size;
                value = 0;
            }
            if (row) *row++ = value;
        }
    }

    /// The values of the next element, which has no list.
    std::vector<double> row(const PlyElement& element) const {
        check_size(element);
        std::vector<char> scratch(element.least_size());
        const char* data = bytes_.piece(at_, scratch.size(), scratch.data());
        std::vector<double> values(element.properties.size());
        const std::vector<Field> layout = fields(element);
        for (std::size_t i = 0; i < values.size(); ++i)
            layout[i].gather(data + layout[i].offset, 0, 1, &values[i]);
        return values;
    }

private:
    [[noreturn]] void fail_cut_off(const PlyElement& element, std::uint64_t index) const {
        throw Error(bytes_.name(), "the file ends in element " + element.name + " " + std::to_string(index)
                                       + " of " + std::to_string(element.count) + " (at byte "
                                       + std::to_string(bytes_.size())
                                       + "); it was cut off, or its header counts wrong");
    }

    const SourceBytes& bytes_;
    std::size_t at_; ///< offset in the source
    bool big_endian_;
};

constexpr std::size_t list_rows = 1024; // a column of them fits the first-level cache

double largest(std::span<const double> values) {
    double max = 0;
    for (double value : values) max = std::max(max, std::isfinite(value) ? value : 0);
    return max;
}

/// Vertices of one size.
PointCloud read_fixed(const SourceBytes& bytes, const PlyHeader& header, std::size_t offset,
                      const PlyElement& element, const std::vector<Column>& columns, const PlyRows& rows) {
    const std::size_t all = static_cast<std::size_t>(element.count), first = std::min(all, rows.first);
    offset += first * element.least_size();
    std::vector<BinaryColumn> values;
    for (const PlyProperty& property : element.properties) {
        values.push_back({&bytes, offset, element.least_size(), property.type,
                          header.encoding == PlyEncoding::big_endian});
        offset += size_of(property.type);
    }
    return read_columns(values, columns, std::min(all - first, rows.count),
                        color_factor_by_type(element, columns));
}

/// Vertices that hold lists: one after the other, as only the one before says where the next begins.
PointCloud read_varying(BinaryBody& body, const PlyElement& vertex, const std::vector<Column>& columns) {
    const auto layout = body.fields(vertex);
    const std::size_t width = columns.size(), count = static_cast<std::size_t>(vertex.count);
    auto factor = color_factor_by_type(vertex, columns);
    std::vector<double> rows(std::min(list_rows, count) * width);
    if (!factor) {
        double max = 0;
        BinaryBody scan = body;
        for (std::size_t i = 0; i < count; ++i) {
            scan.read_element(layout, vertex, i, rows.data());
            for (std::size_t c = 0; c < width; ++c)
                if (is_color(columns[c])) max = std::max(max, largest({&rows[c], 1}));
        }
        factor = color_factor(max, has_fractional_color(vertex, columns));
    }
    CloudColumns cloud(columns, count, *factor);
    for (std::size_t first = 0; first < count; first += list_rows) {
        const std::size_t filled = std::min(list_rows, count - first);
        for (std::size_t i = 0; i < filled; ++i)
            body.read_element(layout, vertex, first + i, &rows[i * width]);
        for (std::size_t c = 0; c < width; ++c) cloud.store(c, first, filled, &rows[c], width);
    }
    return cloud.finish();
}

bool is_all_zero(std::string_view bytes) {
    return bytes.find_first_not_of('\0') == std::string_view::npos;
}

} // namespace

PointCloud read_ply_binary(const SourceBytes& bytes, const PlyHeader& header, std::size_t vertex,
                           const std::vector<Column>& columns, const PlyRows& rows) {
    const PlyElement& element = header.elements[vertex];
    BinaryBody body(bytes, header);
    for (std::size_t i = 0; i < vertex; ++i) body.skip(header.elements[i]);
    body.check_size(element);
    if (element.has_list()) return read_varying(body, element, columns);

    const std::size_t rest = body.left() - static_cast<std::size_t>(element.count) * element.least_size();
    if (vertex + 1 == header.elements.size() && rest >= element.least_size()
        && !(header.padded && is_all_zero(bytes.view().substr(bytes.size() - rest))))
        throw Error(bytes.name(), std::to_string(rest) + " bytes behind the last of "
                                      + std::to_string(element.count)
                                      + " vertices; the header's count is wrong, correct it");
    return read_fixed(bytes, header, body.at(), element, columns, rows);
}

std::optional<Vec3> read_ply_sensor_binary(const SourceBytes& bytes, const PlyHeader& header,
                                           const PlyCamera& camera) {
    BinaryBody body(bytes, header);
    for (std::size_t i = 0; i < camera.element; ++i) {
        if (header.elements[i].has_list()) return std::nullopt; // every list would have to be read to pass it
        body.skip(header.elements[i]);
    }
    return sensor_of_camera(camera, body.row(header.elements[camera.element]));
}

} // namespace hsdm::io
