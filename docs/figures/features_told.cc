// What the modules say of a mesh and leave its shape: classes and normals of vertices.

#include "figures.hh"
#include "marked_view.hh"

#include "steps.hh"

#include "hsdm/features/features.hh"
#include "hsdm/mesh/to_mesh.hh"
#include "hsdm/mesh/vertex_normals.hh"
#include "hsdm/spatial/transfer_attributes.hh"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

namespace hsdm::figures {
namespace {

bool is_seen(const PolyMesh& mesh, OpenMesh::SmartVertexHandle v, const SolidView& view) {
    const auto faces = v.faces();
    return std::any_of(faces.begin(), faces.end(), [&](const auto f) { return view.faces(mesh.normal(f)); });
}

/// The listed normals of the vertices that are seen.
void draw_needles(Canvas& canvas, PolyMesh& mesh, const SolidView& view) {
    constexpr double length = 0.07; // a little more than an edge
    const auto count =
        OpenMesh::getProperty<OpenMesh::VertexHandle, std::uint8_t>(mesh, normal_count_property);
    const auto normals = OpenMesh::getProperty<OpenMesh::VertexHandle, VertexNormalsT<PolyMesh>>(
        mesh, vertex_normals_property);
    std::vector<std::array<Vec2, 2>> needles;
    for (const auto v : mesh.vertices())
        for (std::size_t k = 0; k < count[v]; ++k)
            if (view.faces(normals[v][k]))
                needles.push_back({view(mesh.point(v)), view(mesh.point(v) + length * normals[v][k])});
    canvas.lines(needles, {.stroke = colour::blue, .width = 1});
}

/// From blue over white to orange, for -1 to 1.
std::string shade(double value) {
    const double pale = 1 - std::min(1.0, std::abs(value));
    const std::array<double, 3> full =
        value < 0 ? std::array<double, 3>{0, 114, 178} : std::array<double, 3>{230, 159, 0};
    std::array<char, 8> text{};
    std::array<unsigned, 3> part{};
    for (std::size_t k = 0; k < 3; ++k)
        part[k] = static_cast<unsigned>(std::lround(full[k] + pale * (255 - full[k]))) & 255u;
    std::snprintf(text.data(), text.size(), "#%02x%02x%02x", part[0], part[1], part[2]);
    return text.data();
}

/// Few points of the slice, with a value that waves over it.
PointCloud waving_points() {
    PointCloud cloud = scan(support::box({1.2, 0.6, 0.6}) & support::cylinder(0.5, 1), 900);
    Scalar wave{"wave", {}, false};
    for (const Vec3& p : cloud.positions) wave.values.push_back(std::sin(9 * p[0]) * std::cos(7 * p[2]));
    cloud.scalars.push_back(wave);
    return cloud;
}

} // namespace

Canvas draw_carried() {
    PolyMesh mesh = slice();
    const std::vector<Vec3> frame = places_of(mesh);
    const PointCloud cloud = waving_points();
    Canvas canvas(620, 340);
    draw_marked(canvas, mesh, frame, 14, "values of 900 points");
    const SolidView view = marked_view(frame, 14);
    for (std::size_t i = 0; i < cloud.size(); ++i)
        if (view.faces(cloud.normals[i]))
            canvas.circle(view(cloud.positions[i]), 3,
                          {.stroke = colour::black, .width = 0.4, .fill = shade(cloud.scalars[0].values[i])});
    transfer_attributes(cloud, mesh);
    const auto wave = OpenMesh::getProperty<OpenMesh::VertexHandle, double>(mesh, "wave");
    const PolygonMesh polygons = to_polygons(mesh);
    const auto fill = [&](std::size_t f) {
        double sum = 0;
        for (const Index v : polygons.facet(f)) sum += wave[OpenMesh::VertexHandle(static_cast<int>(v))];
        return shade(sum / static_cast<double>(polygons.facet(f).size()));
    };
    draw_marked(canvas, mesh, frame, 319, "carried to the vertices", fill);
    return canvas;
}

Canvas draw_classes() {
    PolyMesh mesh = slice();
    const std::vector<Vec3> frame = places_of(mesh);
    Canvas canvas(470, 340);
    draw_marked(canvas, mesh, frame, 14, "sharp edges and classes of vertices");
    const SolidView view = marked_view(frame, 14);
    const auto classes =
        OpenMesh::getProperty<OpenMesh::VertexHandle, std::uint8_t>(mesh, vertex_class_property);
    const Style edge{.stroke = colour::none, .fill = colour::orange},
        corner{.stroke = colour::none, .fill = colour::blue};
    for (const auto v : mesh.vertices()) {
        if (!is_seen(mesh, v, view)) continue;
        if (classes[v] == static_cast<std::uint8_t>(VertexClass::edge))
            canvas.circle(view(mesh.point(v)), 2.5, edge);
        if (classes[v] == static_cast<std::uint8_t>(VertexClass::corner))
            canvas.circle(view(mesh.point(v)), 4.5, corner);
    }
    using Mark = Entry::Mark;
    const std::array<Entry, 3> entries = {
        Entry{Mark::line, {.stroke = colour::red, .width = 1.8}, "sharp edge"},
        Entry{Mark::dot, edge, "class edge", 2.5}, Entry{Mark::dot, corner, "class corner", 4.5}};
    canvas.legend({330, 30}, entries);
    return canvas;
}

Canvas draw_normals() {
    PolyMesh mesh = noisy_slice();
    const std::vector<Vec3> frame = places_of(slice());
    Canvas canvas(620, 340);
    for (const int rounds : {0, 5}) {
        smooth_normals(mesh, {.rounds = rounds});
        const double left = rounds == 0 ? 14 : 319;
        draw_marked(canvas, mesh, frame, left,
                    rounds == 0 ? "normals of a noisy mesh" : "after five rounds; no point has moved");
        draw_needles(canvas, mesh, marked_view(frame, left));
    }
    return canvas;
}

} // namespace hsdm::figures
