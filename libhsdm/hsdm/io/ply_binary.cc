#include "hsdm/core/chunks.hh"
#include "hsdm/errors.hh"
#include "hsdm/io/ply.hh"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <memory>

namespace hsdm::io {
namespace {

static_assert(std::endian::native == std::endian::little || std::endian::native == std::endian::big);

/// One value at any address, from the file's byte order.
template <class T, bool swap>
T load(const char* at) {
    std::array<char, sizeof(T)> bytes;
    std::memcpy(bytes.data(), at, sizeof(T));
    if constexpr (swap) std::reverse(bytes.begin(), bytes.end());
    return std::bit_cast<T>(bytes);
}

template <class T, bool swap>
void gather(const char* at, std::size_t stride, std::size_t count, double* out) {
    for (std::size_t i = 0; i < count; ++i) out[i] = static_cast<double>(load<T, swap>(at + i * stride));
}

/// Reads `count` values that lie `stride` bytes apart.
using Gather = void (*)(const char* at, std::size_t stride, std::size_t count, double* out);

template <bool swap>
Gather gather_of(PlyType type) {
    switch (type) {
    case PlyType::int8:
        return gather<std::int8_t, swap>;
    case PlyType::uint8:
        return gather<std::uint8_t, swap>;
    case PlyType::int16:
        return gather<std::int16_t, swap>;
    case PlyType::uint16:
        return gather<std::uint16_t, swap>;
    case PlyType::int32:
        return gather<std::int32_t, swap>;
    case PlyType::uint32:
        return gather<std::uint32_t, swap>;
    case PlyType::float32:
        return gather<float, swap>;
    case PlyType::float64:
        return gather<double, swap>;
    }
    return nullptr;
}

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
        : bytes_(bytes),
          at_(header.size),
          swap_((header.encoding == PlyEncoding::big_endian)
                == (std::endian::native == std::endian::little)) {}

    std::size_t at() const { return at_; }
    std::size_t left() const { return bytes_.size() - at_; }

    std::vector<Field> fields(const PlyElement& element) const {
        std::vector<Field> result;
        std::size_t offset = 0;
        for (const PlyProperty& property : element.properties) {
            const PlyType type = property.is_list ? property.count_type : property.type;
            result.push_back({offset, size_of(type), swap_ ? gather_of<true>(type) : gather_of<false>(type),
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
    bool swap_;
};

constexpr std::size_t block_rows = 1024; // a column of them fits the first-level cache

/// Vertices of one size, as they lie in the source.
struct FixedVertices {
    const SourceBytes& bytes;
    std::size_t offset, stride, count;
    std::vector<Field> layout;
};

/// Calls use(column, first, values) for every block of every column that is used, in parallel.
template <class Use>
void for_each_block(const FixedVertices& vertices, const std::vector<Column>& columns, const Use& use) {
    const std::size_t blocks = (vertices.count + block_rows - 1) / block_rows;
    for_chunks(blocks, 16, [&](std::size_t begin, std::size_t end, std::size_t) {
        std::array<double, block_rows> values;
        const std::size_t stride = vertices.stride;
        const std::unique_ptr<char[]> scratch(new char[std::min(block_rows, vertices.count) * stride]);
        for (std::size_t block = begin; block != end; ++block) {
            const std::size_t first = block * block_rows, rows = std::min(block_rows, vertices.count - first);
            const char* bytes =
                vertices.bytes.piece(vertices.offset + first * stride, rows * stride, scratch.get());
            for (std::size_t c = 0; c < columns.size(); ++c) {
                if (columns[c].role == Role::skip) continue;
                vertices.layout[c].gather(bytes + vertices.layout[c].offset, stride, rows, values.data());
                use(c, first, std::span<const double>(values.data(), rows));
            }
        }
    });
}

double largest(std::span<const double> values) {
    double max = 0;
    for (double value : values) max = std::max(max, std::isfinite(value) ? value : 0);
    return max;
}

bool is_color(const Column& column) {
    return column.role >= Role::red && column.role <= Role::blue;
}

/// Columns are gathered block by block: the bytes of a block pass through the cache once.
PointCloud read_fixed(const FixedVertices& vertices, const PlyElement& element,
                      const std::vector<Column>& columns) {
    auto factor = color_factor_by_type(element, columns);
    if (!factor) {
        std::vector<Column> colors = columns;
        for (Column& column : colors)
            if (!is_color(column)) column.role = Role::skip;
        std::vector<double> maxima((vertices.count + block_rows - 1) / block_rows, 0);
        for_each_block(vertices, colors, [&](std::size_t, std::size_t first, auto values) {
            maxima[first / block_rows] = std::max(maxima[first / block_rows], largest(values));
        });
        factor = color_factor(largest(maxima), has_fractional_color(element, columns));
    }
    CloudColumns cloud(columns, vertices.count, *factor);
    for_each_block(vertices, columns, [&](std::size_t c, std::size_t first, auto values) {
        cloud.store(c, first, values.size(), values.data(), 1);
    });
    return cloud.finish();
}

/// Vertices that hold lists: one after the other, as only the one before says where the next begins.
PointCloud read_varying(BinaryBody& body, const PlyElement& vertex, const std::vector<Column>& columns) {
    const auto layout = body.fields(vertex);
    const std::size_t width = columns.size(), count = static_cast<std::size_t>(vertex.count);
    auto factor = color_factor_by_type(vertex, columns);
    std::vector<double> rows(std::min(block_rows, count) * width);
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
    for (std::size_t first = 0; first < count; first += block_rows) {
        const std::size_t filled = std::min(block_rows, count - first);
        for (std::size_t i = 0; i < filled; ++i)
            body.read_element(layout, vertex, first + i, &rows[i * width]);
        for (std::size_t c = 0; c < width; ++c) cloud.store(c, first, filled, &rows[c], width);
    }
    return cloud.finish();
}

} // namespace

PointCloud read_ply_binary(const SourceBytes& bytes, const PlyHeader& header, std::size_t vertex,
                           const std::vector<Column>& columns) {
    const PlyElement& element = header.elements[vertex];
    BinaryBody body(bytes, header);
    for (std::size_t i = 0; i < vertex; ++i) body.skip(header.elements[i]);
    body.check_size(element);
    if (element.has_list()) return read_varying(body, element, columns);

    const std::size_t rest = body.left() - static_cast<std::size_t>(element.count) * element.least_size();
    if (vertex + 1 == header.elements.size() && rest >= element.least_size())
        throw Error(bytes.name(), std::to_string(rest) + " bytes behind the last of "
                                      + std::to_string(element.count)
                                      + " vertices; the header's count is wrong, correct it");
    return read_fixed({bytes, body.at(), element.least_size(), static_cast<std::size_t>(element.count),
                       body.fields(element)},
                      element, columns);
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
