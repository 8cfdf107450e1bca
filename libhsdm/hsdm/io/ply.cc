#include "hsdm/io/ply.hh"

#include "hsdm/errors.hh"
#include "hsdm/io/formats.hh"

#include <algorithm>

namespace hsdm::io {
namespace {

std::vector<Column> columns_of(const Text& text, const PlyElement& vertex) {
    std::vector<std::string> names;
    for (const PlyProperty& property : vertex.properties)
        names.push_back(property.is_list ? "_" : property.name);
    auto columns = columns_from_names(names);
    if (!columns) {
        std::string present;
        for (const PlyProperty& property : vertex.properties)
            present += (present.empty() ? "" : ", ") + property.name;
        throw Error(text.file(), "the vertices have no properties x, y and z"
                                     + (present.empty() ? "" : ", only " + io::quoted(present))
                                     + "; export them as points");
    }
    return *columns;
}

} // namespace

bool has_fractional_color(const PlyElement& vertex, const std::vector<Column>& columns) {
    for (std::size_t i = 0; i < columns.size(); ++i)
        if (columns[i].role == Role::red) return vertex.properties[i].type >= PlyType::float32;
    return false;
}

std::optional<double> color_factor_by_type(const PlyElement& vertex, const std::vector<Column>& columns) {
    for (std::size_t i = 0; i < columns.size(); ++i) {
        if (columns[i].role < Role::red || columns[i].role > Role::blue) continue;
        if (vertex.properties[i].type == PlyType::uint8) return 1;
        if (vertex.properties[i].type == PlyType::uint16) return 1.0 / 257;
        return std::nullopt;
    }
    return 1;
}

namespace {

/// A file's header, as far as its vertices go.
struct PlyVertices {
    Text text; // the header's
    PlyHeader header;
    std::size_t vertex = 0; // among the elements

    const PlyElement& element() const { return header.elements[vertex]; }
};

PlyVertices find_vertices(const SourceBytes& bytes) {
    const bool head_suffices = bytes.head().find("end_header") != std::string_view::npos;
    const Text text = with_line_end_of_header(head_suffices ? Text::head_of(bytes) : Text(bytes));
    PlyVertices found{text, read_ply_header(text)};
    const std::vector<PlyElement>& elements = found.header.elements;
    while (found.vertex < elements.size() && elements[found.vertex].name != "vertex") ++found.vertex;
    if (found.vertex == elements.size())
        throw Error(bytes.name(), "the header names no element vertex; a point cloud is needed");
    const PlyElement& element = found.element();
    if (element.count == 0) throw Error(bytes.name(), "holds no points: the header says element vertex 0");
    if (element.count >= no_index && element.count / 3 <= bytes.size())
        throw Error(bytes.name(), "holds more points than can be numbered; split the file");
    return found;
}

} // namespace

std::optional<std::size_t> ply_rows(const SourceBytes& bytes) {
    if (!bytes.head().starts_with("ply")) return std::nullopt;
    const PlyVertices found = find_vertices(bytes);
    if (found.header.encoding == PlyEncoding::ascii || found.element().has_list()) return std::nullopt;
    return found.element().count;
}

bool read_ply_in_parts(const SourceBytes& bytes, std::size_t begin, std::size_t end, std::size_t points,
                       const std::function<void(PointCloud&&)>& visit) {
    if (!ply_rows(bytes)) return false;
    const PlyVertices found = find_vertices(bytes);
    const auto columns = columns_of(found.text, found.element());
    end = std::min<std::size_t>(end, found.element().count);
    const auto camera = find_camera(found.header);
    std::optional<Vec3> sensor;
    if (camera) sensor = read_ply_sensor_binary(bytes, found.header, *camera);
    for (std::size_t first = begin; first < end; first += points) {
        PointCloud part = read_ply_binary(bytes, found.header, found.vertex, columns,
                                          {first, std::min(points, end - first)});
        part.sensor = sensor;
        visit(std::move(part));
    }
    return true;
}

PointFile read_ply(const SourceBytes& bytes) {
    const PlyVertices found = find_vertices(bytes);
    const Text& text = found.text;
    const PlyHeader& header = found.header;
    const std::size_t vertex = found.vertex;
    const PlyElement& element = found.element();
    const auto columns = columns_of(text, element);
    PointFile file;
    file.format = "ply";
    const auto camera = find_camera(header);
    if (header.encoding == PlyEncoding::ascii) {
        const Text whole = with_line_end_of_header(Text(bytes));
        file.cloud = read_ply_ascii(whole, header, vertex, columns);
        if (camera) file.cloud.sensor = read_ply_sensor_ascii(whole, header, *camera);
    } else {
        file.cloud = read_ply_binary(bytes, header, vertex, columns);
        if (camera) file.cloud.sensor = read_ply_sensor_binary(bytes, header, *camera);
    }
    for (const PlyElement& other : header.elements)
        if (other.name == "face") file.faces = static_cast<std::size_t>(other.count);
    return file;
}

} // namespace hsdm::io
