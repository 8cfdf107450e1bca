#include "hsdm/io/ply.hh"
#include "hsdm/io/rows.hh"

namespace hsdm::io {

PointCloud read_ply_ascii(const Text& text, const PlyHeader& header, std::size_t vertex,
                          const std::vector<Column>& columns) {
    const PlyElement& element = header.elements[vertex];
    const char* at = text.origin + header.size;
    for (std::size_t i = 0; i < vertex; ++i)
        at = after_rows(text.from(at), header.elements[i].count, false,
                        "lines of element " + header.elements[i].name);
    Text body = text.from(at);
    body.end = after_rows(body, element.count, false, "vertices");

    bool rows_behind = false;
    for (std::size_t i = vertex + 1; i < header.elements.size(); ++i)
        rows_behind |= header.elements[i].count > 0;
    if (!rows_behind && count_rows(text.from(body.end), false) > 0)
        text.fail(body.end, "a line behind the last of " + std::to_string(element.count)
                                + " vertices; the header's count is wrong, correct it");

    RowLayout layout;
    layout.origin = "the header names " + std::to_string(columns.size()) + " properties";
    layout.advice = "correct the line or the header";
    for (const PlyProperty& property : element.properties)
        layout.cells.push_back(property.is_list ? RowLayout::Cell::list : RowLayout::Cell::number);
    Rows rows(body, layout);
    const auto by_type = color_factor_by_type(element, columns);
    const double factor =
        by_type ? *by_type : rows.color_factor(columns, has_fractional_color(element, columns));
    return std::move(rows).to_cloud(columns, factor);
}

std::optional<Vec3> read_ply_sensor_ascii(const Text& text, const PlyHeader& header,
                                          const PlyCamera& camera) {
    Text body = text.from(text.origin + header.size);
    for (std::size_t i = 0; i <= camera.element; ++i) {
        const PlyElement& element = header.elements[i];
        const char* end = after_rows(body, element.count, false, "lines of element " + element.name);
        if (i == camera.element)
            body.end = end;
        else
            body.begin = end;
    }
    RowLayout layout;
    layout.cells.assign(header.elements[camera.element].properties.size(), RowLayout::Cell::number);
    layout.origin = "the header names " + std::to_string(layout.cells.size()) + " properties";
    layout.advice = "correct the line or the header";
    return sensor_of_camera(camera, Rows(body, layout).sample(1));
}

} // namespace hsdm::io
