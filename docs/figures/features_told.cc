// What the modules say of a mesh and leave its shape: classes and normals of vertices.

#include "figures.hh"
#include "marked_view.hh"

#include "hsdm/features/features.hh"
#include "hsdm/mesh/vertex_normals.hh"

#include <algorithm>
#include <array>

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

} // namespace

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
