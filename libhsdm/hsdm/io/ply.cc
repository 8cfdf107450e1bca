#include "hsdm/io/ply.hh"

#include "hsdm/errors.hh"
#include "hsdm/io/formats.hh"

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

PointFile read_ply(const SourceBytes& bytes) {
    const bool head_suffices = bytes.head().find("end_header") != std::string_view::npos;
    const Text text = with_line_end_of_header(head_suffices ? Text::head_of(bytes) : Text(bytes));
    const PlyHeader header = read_ply_header(text);
    std::size_t vertex = 0;
    while (vertex < header.elements.size() && header.elements[vertex].name != "vertex") ++vertex;
    if (vertex == header.elements.size())
        throw Error(bytes.name(), "the header names no element vertex; a point cloud is needed");
    const PlyElement& element = header.elements[vertex];
    if (element.count == 0) throw Error(bytes.name(), "holds no points: the header says element vertex 0");
    if (element.count >= no_index && element.count / 3 <= bytes.size())
        throw Error(bytes.name(), "holds more points than can be numbered; split the file");

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
