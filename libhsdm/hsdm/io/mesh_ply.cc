#include "hsdm/errors.hh"
#include "hsdm/io/cursor.hh"
#include "hsdm/io/mesh_readers.hh"
#include "hsdm/io/ply_header.hh"

#include <algorithm>

namespace hsdm::io {
namespace {

/// The values of a PLY body one after the other, whatever its encoding.
class PlyValues {
public:
    PlyValues(const Text& body, const PlyHeader& header)
        : body_(body),
          cursor_(body_),
          at_(body.begin),
          ascii_(header.encoding == PlyEncoding::ascii),
          big_endian_(header.encoding == PlyEncoding::big_endian) {}

    double next(PlyType type) {
        if (ascii_) {
            if (!cursor_.find_next()) cursor_.fail(cursor_.at(), "the file ends early; it was cut off");
            return cursor_.number("a number");
        }
        const std::size_t size = size_of(type);
        if (left() < size)
            throw Error(body_.file(), "the file ends early (at byte " + std::to_string(body_.source->size())
                                          + "); it was cut off");
        const char* at = at_;
        at_ += size;
        double value = 0;
        gather_of(type, big_endian_)(at, 0, 1, &value);
        return value;
    }

    std::size_t next_count(const PlyProperty& list) {
        const double count = next(list.count_type);
        const std::size_t least = ascii_ ? 1 : size_of(list.type);
        if (!(count >= 0) || count > static_cast<double>(left() / least + 1))
            throw Error(body_.file(), "a list " + list.name + " is longer than the rest of the file; "
                                          + "it was cut off, or is damaged");
        return static_cast<std::size_t>(count);
    }

    /// Throws unless the file is long enough for so many elements: what every allocation relies on.
    void check_size(const PlyElement& element) const {
        const std::size_t least = ascii_ ? 2 * element.properties.size() : element.least_size();
        if (least == 0 || element.count <= (left() + 1) / least) return;
        throw Error(body_.file(), "the file is too short for " + std::to_string(element.count) + " elements "
                                      + element.name + "; it was cut off, or its header counts wrong");
    }

    std::size_t left() const { return ascii_ ? cursor_.left() : static_cast<std::size_t>(body_.end - at_); }
    /// Where a message about the next value should point; null in a binary body.
    const char* place() {
        if (ascii_) cursor_.find_next();
        return ascii_ ? cursor_.at() : nullptr;
    }

private:
    Text body_;
    Cursor cursor_;
    const char* at_;
    bool ascii_, big_endian_;
};

VertexProperty::Type property_type(PlyType type) {
    switch (type) {
    case PlyType::uint8:
        return VertexProperty::Type::uint8;
    case PlyType::float32:
        return VertexProperty::Type::float32;
    case PlyType::uint32:
    case PlyType::float64:
        return VertexProperty::Type::float64;
    default:
        return VertexProperty::Type::int32;
    }
}

class PlyMeshReader {
public:
    PlyMeshReader(const Text& text, const PlyHeader& header)
        : text_(text), header_(header), values_(text.from(text.origin + header.size), header) {}

    PolygonMesh read() {
        for (const PlyElement& element : header_.elements) {
            values_.check_size(element);
            if (element.properties.empty()) continue;
            if (element.name == "vertex")
                read_vertices(element);
            else
                read_others(element);
        }
        if (!has_vertices_) throw Error(text_.file(), "the header names no element vertex; a mesh is needed");
        check_corners(text_, mesh_, facet_at_);
        return std::move(mesh_);
    }

private:
    void read_vertices(const PlyElement& element) {
        if (has_vertices_)
            throw Error(text_.file(), "the header names element vertex twice; export the mesh again");
        has_vertices_ = true;
        const auto count = static_cast<std::size_t>(element.count);
        if (count >= no_index)
            throw Error(text_.file(), "holds more vertices than can be numbered; split the file");
        auto find = [&](std::string_view name) {
            return std::any_of(element.properties.begin(), element.properties.end(),
                               [=](const PlyProperty& p) { return p.name == name && !p.is_list; });
        };
        if (!find("x") || !find("y") || !find("z"))
            throw Error(text_.file(), "the vertices have no properties x, y and z; export them as a mesh");
        mesh_.positions.resize(count);
        if (find("nx") && find("ny") && find("nz")) mesh_.normals.resize(count);
        std::vector<std::size_t> slot; // of each property, see store()
        for (const PlyProperty& p : element.properties) slot.push_back(slot_of(p, count));
        for (std::size_t v = 0; v < count; ++v)
            for (std::size_t i = 0; i < slot.size(); ++i) {
                const PlyProperty& p = element.properties[i];
                if (p.is_list)
                    for (std::size_t left = values_.next_count(p); left > 0; --left) values_.next(p.type);
                else
                    store(v, slot[i], values_.next(p.type));
            }
    }

    /// 0 to 2: position, 3 to 5: normal, beyond: a vertex property, made here.
    std::size_t slot_of(const PlyProperty& p, std::size_t count) {
        constexpr std::array<std::string_view, 6> names{"x", "y", "z", "nx", "ny", "nz"};
        const auto found = std::find(names.begin(), names.begin() + (mesh_.normals.empty() ? 3 : 6), p.name);
        if (p.is_list) return 0;
        if (found != names.begin() + (mesh_.normals.empty() ? 3 : 6))
            return static_cast<std::size_t>(found - names.begin());
        mesh_.properties.push_back({p.name, property_type(p.type), std::vector<double>(count)});
        return 5 + mesh_.properties.size();
    }

    void store(std::size_t v, std::size_t slot, double value) {
        if (slot < 3)
            mesh_.positions[v][slot] = value;
        else if (slot < 6)
            mesh_.normals[v][slot - 3] = value;
        else if (VertexProperty& p = mesh_.properties[slot - 6]; p.type == VertexProperty::Type::float32)
            p.values[v] =
                static_cast<double>(static_cast<float>(value)); // a decimal stands for the nearest float
        else
            p.values[v] = value;
    }

    /// Reads the remaining elements; only the corner lists of faces are kept.
    void read_others(const PlyElement& element) {
        const bool faces = element.name == "face";
        for (std::uint64_t i = 0; i < element.count; ++i) {
            if (const char* place = values_.place(); faces && place) facet_at_.push_back(place);
            for (const PlyProperty& p : element.properties) {
                const bool corners = faces && (p.name == "vertex_indices" || p.name == "vertex_index");
                for (std::size_t left = p.is_list ? values_.next_count(p) : 1; left > 0; --left) {
                    const double value = values_.next(p.type);
                    if (corners) mesh_.corners.push_back(to_index(value));
                }
            }
            if (faces) mesh_.first.push_back(static_cast<Index>(mesh_.corners.size()));
        }
    }

    const Text& text_;
    const PlyHeader& header_;
    PlyValues values_;
    PolygonMesh mesh_;
    std::vector<const char*> facet_at_;
    bool has_vertices_ = false;
};

} // namespace

PolygonMesh read_mesh_ply(const SourceBytes& bytes) {
    const Text text = with_line_end_of_header(Text(bytes));
    const PlyHeader header = read_ply_header(text);
    return PlyMeshReader(text, header).read();
}

} // namespace hsdm::io
