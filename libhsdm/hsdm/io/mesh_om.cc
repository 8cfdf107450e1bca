#include "hsdm/errors.hh"
#include "hsdm/io/formats.hh"
#include "hsdm/io/mesh_readers.hh"
#include "hsdm/mesh/vertex_normals.hh"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>

namespace hsdm::io {
namespace {

// A header of 16 bytes: "OM", the kind of faces (T, Q, P), version (major * 32 + minor), the numbers of
// vertices, faces and edges. Then chunks, each with 16 bits in front, little-endian as everything:
//
//     bit  15 14 | 13 12 11 | 10    | 9      | 8 7 6 5 | 4 3 2  | 1     | 0
//          bits  | dim - 1  | float | signed | type    | entity | named | reserved
//
// Half-edges 2e and 2e + 1 are those of edge e. Since version 2 the faces are loops of half-edges.
enum Entity : unsigned { vertex = 0, mesh = 1, face = 2, edge = 4, half_edge = 6, sentinel = 7 };
enum Type : unsigned {
    position = 0,
    normal = 1,
    texture = 2,
    status = 3,
    color = 4,
    custom = 6,
    topology = 7
};

constexpr std::size_t header_size = 16;
constexpr unsigned loops_of_half_edges = 2 << 5;      // version 2.0
constexpr unsigned names_of_types = (2 << 5) + 2;     // version 2.2
constexpr unsigned deleted_bit = 1, feature_bit = 16; // of a status

template <class T>
T load(const char* at) {
    std::array<char, sizeof(T)> bytes;
    std::memcpy(bytes.data(), at, sizeof(T));
    if constexpr (std::endian::native == std::endian::big) std::reverse(bytes.begin(), bytes.end());
    return std::bit_cast<T>(bytes);
}

struct Chunk {
    explicit Chunk(unsigned bits)
        : named((bits >> 1 & 1) != 0),
          entity(bits >> 2 & 7),
          type(bits >> 5 & 15),
          is_float((bits >> 10 & 1) != 0),
          dim((bits >> 11 & 7) + 1),
          log_size(bits >> 14) {}

    /// Bytes of one number of a position, normal, texture coordinate or colour.
    std::size_t number_size() const { return (is_float ? 4u : 1u) << log_size; }
    /// Bytes of one index.
    std::size_t index_size() const { return std::size_t(1) << log_size; }

    bool named;
    unsigned entity, type;
    bool is_float;
    unsigned dim, log_size;
    std::string name, kind; ///< of a custom property and of its values' type
};

/// A property's values by the name that OpenMesh gives their type.
struct ValueType {
    std::string_view name;
    std::size_t size; ///< bytes
    VertexProperty::Type type;
    double (*load)(const char*);
};
template <class T>
constexpr ValueType value_type(std::string_view name, VertexProperty::Type type) {
    return {name, sizeof(T), type, [](const char* at) { return static_cast<double>(load<T>(at)); }};
}
constexpr ValueType value_types[] = {
    value_type<std::uint8_t>("uint8_t", VertexProperty::Type::uint8),
    value_type<std::int8_t>("int8_t", VertexProperty::Type::int32),
    value_type<std::int16_t>("int16_t", VertexProperty::Type::int32),
    value_type<std::uint16_t>("uint16_t", VertexProperty::Type::int32),
    value_type<std::int32_t>("int32_t", VertexProperty::Type::int32),
    value_type<std::uint32_t>("uint32_t", VertexProperty::Type::float64),
    value_type<float>("float", VertexProperty::Type::float32),
    value_type<double>("double", VertexProperty::Type::float64),
};

class OmReader {
public:
    explicit OmReader(const SourceBytes& bytes) : bytes_(bytes), rest_(bytes.view()) {}

    PolygonMesh read() {
        read_header();
        while (!rest_.empty() && read_chunk()) {
        }
        if (counts_[vertex] > 0 && result_.positions.empty()) fail("no positions of the vertices are in it");
        if (version_ >= loops_of_half_edges) {
            follow_loops();
            find_sharp_edges();
        }
        if (result_.corners.size() >= no_index)
            throw Error(bytes_.name(), "holds more corners than can be numbered; split the file");
        check_corners(Text(bytes_), result_, {});
        const bool no_normals = std::all_of(result_.normals.begin(), result_.normals.end(),
                                            [](const Vec3& n) { return n == Vec3(0, 0, 0); });
        if (no_normals) result_.normals.clear();
        return std::move(result_);
    }

    /// OpenMesh writes deleted vertices too, and the mesh has them: faces go by their numbers.
    bool is_deleted(std::size_t v) const { return has_status(vertex, v, deleted_bit); }

private:
    struct HalfEdge {
        std::int64_t next, to;
    };

    [[noreturn]] void fail(const std::string& what) const {
        throw Error(bytes_.name(), what + "; the file is damaged, export the mesh again");
    }

    /// The next bytes, of which so many must be left: what every allocation relies on.
    const char* take(std::uint64_t count) {
        if (count > rest_.size())
            throw Error(bytes_.name(), "the file ends early (at byte " + std::to_string(bytes_.size())
                                           + "); it was cut off");
        const char* const at = rest_.data();
        rest_.remove_prefix(static_cast<std::size_t>(count));
        return at;
    }

    template <class T>
    T next() {
        return load<T>(take(sizeof(T)));
    }

    std::string next_name() {
        const std::size_t length = next<std::uint8_t>();
        return {take(length), length};
    }

    /// An index of 1, 2, 4 or 8 bytes; negative for none.
    static std::int64_t load_index(const char* at, std::size_t size) {
        return size == 1   ? load<std::int8_t>(at)
               : size == 2 ? load<std::int16_t>(at)
               : size == 4 ? load<std::int32_t>(at)
                           : load<std::int64_t>(at);
    }

    void read_header() {
        const char* const header = take(header_size);
        kind_ = header[2];
        version_ = static_cast<unsigned char>(header[3]);
        if (version_ >> 5 > 2)
            fail("is of version " + std::to_string(version_ >> 5) + "." + std::to_string(version_ & 31)
                 + " of .om, which is not known");
        counts_[vertex] = load<std::uint32_t>(header + 4);
        counts_[face] = load<std::uint32_t>(header + 8);
        counts_[edge] = load<std::uint32_t>(header + 12);
        counts_[half_edge] = 2 * counts_[edge];
        counts_[mesh] = 1;
        if (counts_[vertex] >= no_index)
            throw Error(bytes_.name(), "holds more vertices than can be numbered; split the file");
    }

    /// False at the sentinel, which is the last.
    bool read_chunk() {
        Chunk chunk(next<std::uint16_t>());
        if (chunk.named) chunk.name = next_name();
        if (chunk.named && version_ >= names_of_types) chunk.kind = next_name();
        if (chunk.entity == sentinel) return false;
        if (chunk.entity != vertex && chunk.entity != face && chunk.entity != edge
            && chunk.entity != half_edge && chunk.entity != mesh)
            fail("something that is neither vertices, faces, edges nor a mesh is in it");
        switch (chunk.type) {
        case custom:
            read_custom(chunk);
            break;
        case status:
            read_status(chunk);
            break;
        case topology:
            read_topology(chunk);
            break;
        case position:
        case normal:
        case texture:
        case color:
            read_vectors(chunk);
            break;
        default:
            fail("a chunk of the unknown type " + std::to_string(chunk.type) + " is in it");
        }
        return true;
    }

    void read_vectors(const Chunk& chunk) {
        const std::size_t size = chunk.number_size(), step = chunk.dim * size;
        const auto count = static_cast<std::size_t>(counts_[chunk.entity]);
        const char* const data = take(counts_[chunk.entity] * step);
        if (chunk.entity != vertex || chunk.type == texture) return;
        if (chunk.type == color) {
            if (size == 1 && chunk.dim >= 3) read_colors(data, step, count);
            return;
        }
        if (chunk.dim != 3 || !chunk.is_float || size > 8)
            fail("vertices without three coordinates are in it");
        std::vector<Vec3>& to = chunk.type == position ? result_.positions : result_.normals;
        to.resize(count);
        for (std::size_t v = 0; v < count; ++v)
            for (std::size_t i = 0; i < 3; ++i) {
                const char* const at = data + v * step + i * size;
                to[v][i] = size == 4 ? static_cast<double>(load<float>(at)) : load<double>(at);
            }
    }

    void read_colors(const char* data, std::size_t step, std::size_t count) {
        for (std::size_t i = 0; i < std::min(step, color_properties.size()); ++i)
            add_property({color_properties[i], VertexProperty::Type::uint8, std::vector<double>(count)},
                         [&](std::size_t v) { return static_cast<unsigned char>(data[v * step + i]); });
    }

    /// OpenMesh writes 32 bits, whatever the chunk says of their size.
    void read_status(const Chunk& chunk) {
        const char* const data = take(4 * counts_[chunk.entity]);
        std::vector<std::uint32_t>& to = status_[chunk.entity];
        to.resize(static_cast<std::size_t>(counts_[chunk.entity]));
        for (std::size_t i = 0; i < to.size(); ++i) to[i] = load<std::uint32_t>(data + 4 * i);
    }

    void read_topology(const Chunk& chunk) {
        const std::size_t size = chunk.index_size();
        const auto count = static_cast<std::size_t>(counts_[chunk.entity]);
        if (chunk.entity == face && version_ < loops_of_half_edges) return read_corner_lists(size);
        if (chunk.entity == half_edge) {
            const char* const data = take(3 * size * counts_[half_edge]);
            half_edges_.resize(count);
            for (std::size_t h = 0; h < count; ++h)
                half_edges_[h] = {load_index(data + 3 * size * h, size),
                                  load_index(data + 3 * size * h + size, size)};
            return;
        }
        const char* const data = take(size * counts_[chunk.entity]);
        if (chunk.entity != face) return;
        side_of_.resize(count);
        for (std::size_t f = 0; f < count; ++f) side_of_[f] = load_index(data + size * f, size);
    }

    /// Faces as versions before 2 write them.
    void read_corner_lists(std::size_t size) {
        for (std::uint64_t f = 0; f < counts_[face]; ++f) {
            const std::size_t corners = kind_ == 'T' ? 3 : kind_ == 'Q' ? 4 : next<std::uint16_t>();
            const char* const data = take(corners * size);
            for (std::size_t c = 0; c < corners; ++c)
                result_.corners.push_back(to_index(static_cast<double>(
                    size == 1   ? load<std::uint8_t>(data + c)
                    : size == 2 ? load<std::uint16_t>(data + 2 * c)
                                : static_cast<std::uint64_t>(load_index(data + size * c, size)))));
            result_.first.push_back(static_cast<Index>(result_.corners.size()));
        }
    }

    void read_custom(const Chunk& chunk) {
        const std::size_t size = next<std::uint32_t>();
        const char* const data = take(size);
        if (chunk.entity != vertex || chunk.name.empty()) return;
        const auto count = static_cast<std::size_t>(counts_[vertex]);
        for (const ValueType& type : value_types) {
            const bool is_triple =
                chunk.name == vertex_normals_property && chunk.kind == std::string(type.name) + "[3][3]";
            if (chunk.kind != type.name && !is_triple) continue;
            const std::size_t step = (is_triple ? 9 : 1) * type.size;
            if (size != step * count)
                fail("values of " + io::quoted(chunk.name) + " are missing or too many");
            for (std::size_t i = 0; i < step / type.size; ++i)
                add_property({is_triple ? vertex_normal_component(i) : chunk.name,
                              is_triple ? VertexProperty::Type::float32 : type.type,
                              std::vector<double>(count)},
                             [&](std::size_t v) { return type.load(data + v * step + i * type.size); });
        }
    }

    template <class Value>
    void add_property(VertexProperty property, const Value& value) {
        for (std::size_t v = 0; v < property.values.size(); ++v)
            property.values[v] = static_cast<double>(value(v));
        result_.properties.push_back(std::move(property));
    }

    bool has_status(Entity entity, std::size_t i, unsigned bit) const {
        const auto& found = status_[entity];
        return i < found.size() && (found[i] & bit) != 0;
    }

    /// Faces from their half-edges. Each half-edge has one face, so there are no more corners than
    /// half-edges.
    void follow_loops() {
        if (side_of_.size() != counts_[face] || half_edges_.size() != counts_[half_edge])
            fail("faces or edges are missing");
        for (std::size_t f = 0; f < side_of_.size(); ++f) {
            if (has_status(face, f, deleted_bit)) continue;
            std::int64_t h = side_of_[f];
            do {
                if (h < 0 || static_cast<std::uint64_t>(h) >= half_edges_.size()
                    || result_.corners.size() >= half_edges_.size())
                    fail("the half-edges of face " + std::to_string(f) + " form no loop");
                const HalfEdge& side = half_edges_[static_cast<std::size_t>(h)];
                result_.corners.push_back(to_index(static_cast<double>(side.to)));
                h = side.next;
            } while (h != side_of_[f]);
            result_.first.push_back(static_cast<Index>(result_.corners.size()));
        }
    }

    void find_sharp_edges() {
        for (std::size_t e = 0; e < status_[edge].size(); ++e) {
            if (!has_status(edge, e, feature_bit) || has_status(edge, e, deleted_bit)) continue;
            const Index from = to_index(static_cast<double>(half_edges_[2 * e + 1].to));
            const Index to = to_index(static_cast<double>(half_edges_[2 * e].to));
            if (std::max(from, to) >= counts_[vertex]) fail("an edge has a vertex that is not there");
            result_.sharp_edges.push_back({std::min(from, to), std::max(from, to)});
        }
    }

    const SourceBytes& bytes_;
    std::string_view rest_;
    char kind_ = 'P';
    unsigned version_ = 0;
    std::array<std::uint64_t, 8> counts_{};              ///< by entity
    std::array<std::vector<std::uint32_t>, 8> status_{}; ///< by entity
    std::vector<HalfEdge> half_edges_;
    std::vector<std::int64_t> side_of_; ///< per face, one of its half-edges
    PolygonMesh result_;
};

} // namespace

bool is_om(const SourceBytes& bytes) {
    const std::string_view head = bytes.head();
    return head.size() >= header_size && head.starts_with("OM")
           && (head[2] == 'T' || head[2] == 'Q' || head[2] == 'P')
           && head.substr(0, header_size).find('\0') != std::string_view::npos;
}

PolygonMesh read_mesh_om(const SourceBytes& bytes) {
    return OmReader(bytes).read();
}

PointFile read_om(const SourceBytes& bytes) {
    OmReader reader(bytes);
    PolygonMesh mesh = reader.read();
    const auto drop_deleted = [&](std::vector<Vec3>& of_vertex) {
        std::size_t kept = 0;
        for (std::size_t v = 0; v < of_vertex.size(); ++v)
            if (!reader.is_deleted(v)) of_vertex[kept++] = of_vertex[v];
        of_vertex.resize(kept);
    };
    drop_deleted(mesh.positions);
    drop_deleted(mesh.normals);
    PointFile file;
    file.format = "om";
    file.faces = mesh.facet_count();
    if (mesh.positions.empty()) throw Error(bytes.name(), "holds no points: there is no vertex in it");
    file.cloud.positions = std::move(mesh.positions);
    file.cloud.normals = std::move(mesh.normals);
    return file;
}

} // namespace hsdm::io
