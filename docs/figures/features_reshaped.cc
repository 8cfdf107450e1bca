// A mesh whose vertices follow filtered normals, and one whose facets are divided, with creases kept.

#include "figures.hh"
#include "solid_view.hh"
#include "steps.hh"

#include "support/random.hh"

#include "hsdm/features/features.hh"
#include "hsdm/mesh/to_mesh.hh"
#include "hsdm/mesh/vertex_normals.hh"
#include "hsdm/reconstruct.hh"
#include "hsdm/stages/decimate_mesh.hh"

#include <array>
#include <utility>

namespace hsdm::figures {
namespace {

/// A slice of a shaft: creases that are straight, and round ones, which meet in eight corners.
PolyMesh slice() {
    return reconstruct(scan(support::box({1.2, 0.6, 0.6}) & support::cylinder(0.5, 1), 60000), {.depth = 4})
        .mesh;
}

const std::string ground = "#ececec";
const Style edge_style{.stroke = "#777777", .width = 0.6};
const Style crease_style{.stroke = colour::red, .width = 1.8};
const Vec3 towards(0.7, 0.9, 0.75);

/// A mesh with its marks; those that do not face the viewer are left out.
void draw_marked(Canvas& canvas, const PolyMesh& mesh, const std::vector<Vec3>& frame, double left,
                 const std::string& name) {
    const SolidView view(frame, towards, {left, 14}, 290);
    const PolygonMesh polygons = to_polygons(mesh);
    view.draw(
        canvas, polygons, [](std::size_t) { return ground; }, edge_style);
    std::vector<std::array<Vec2, 2>> creases;
    for (const auto e : mesh.edges()) {
        if (!e.feature()
            || !(view.faces(mesh.normal(e.h0().face())) || view.faces(mesh.normal(e.h1().face()))))
            continue;
        creases.push_back({view(mesh.point(e.v0())), view(mesh.point(e.v1()))});
    }
    canvas.lines(creases, crease_style);
    canvas.text({left + 145, 328}, name, 13, "middle");
}

std::vector<Vec3> places_of(const PolyMesh& mesh) {
    return {mesh.points(), mesh.points() + mesh.n_vertices()};
}

} // namespace

Canvas draw_smoothed() {
    PolyMesh mesh = slice();
    const std::vector<Vec3> frame = places_of(mesh);
    support::Random random(3);
    OpenMesh::VPropHandleT<std::uint8_t> classes;
    mesh.get_property_handle(classes, vertex_class_property);
    for (const auto v : mesh.vertices())
        if (mesh.property(classes, v) != static_cast<std::uint8_t>(VertexClass::corner))
            mesh.set_point(v, mesh.point(v) + 0.009 * random.gauss3());
    mesh.update_face_normals();
    Canvas canvas(620, 340);
    draw_marked(canvas, mesh, frame, 14, "noise of a seventh of an edge");
    smooth_vertices(mesh, {.rounds = 3, .corner_angle = 2}); // noise turns creases by more than 60 degrees
    draw_marked(canvas, mesh, frame, 319, "smoothed");
    return canvas;
}

Canvas draw_divided() {
    PolyMesh mesh = slice();
    const std::vector<Vec3> frame = places_of(mesh);
    decimate_mesh(mesh, {.facets = mesh.n_faces() / 4});
    Canvas canvas(930, 340);
    draw_marked(canvas, mesh, frame, 14, "decimated: " + std::to_string(mesh.n_faces()) + " triangles");
    subdivide(mesh);
    draw_marked(canvas, mesh, frame, 319, "divided once: " + std::to_string(mesh.n_faces()));
    subdivide(mesh);
    draw_marked(canvas, mesh, frame, 624, "twice: " + std::to_string(mesh.n_faces()));
    return canvas;
}

} // namespace hsdm::figures
