#include "marked_view.hh"

#include "steps.hh"

#include "support/random.hh"

#include "hsdm/mesh/to_mesh.hh"
#include "hsdm/mesh/vertex_normals.hh"
#include "hsdm/reconstruct.hh"

#include <array>

namespace hsdm::figures {
namespace {

const std::string ground = "#ececec";
const Style edge_style{.stroke = "#777777", .width = 0.6};
const Style crease_style{.stroke = colour::red, .width = 1.8};
const Vec3 towards(0.7, 0.9, 0.75);

} // namespace

PolyMesh slice() {
    return reconstruct(scan(support::box({1.2, 0.6, 0.6}) & support::cylinder(0.5, 1), 60000), {.depth = 4})
        .mesh;
}

PolyMesh noisy_slice() {
    PolyMesh mesh = slice();
    support::Random random(3);
    OpenMesh::VPropHandleT<std::uint8_t> classes;
    mesh.get_property_handle(classes, vertex_class_property);
    for (const auto v : mesh.vertices())
        if (mesh.property(classes, v) != static_cast<std::uint8_t>(VertexClass::corner))
            mesh.set_point(v, mesh.point(v) + 0.009 * random.gauss3());
    mesh.update_face_normals();
    return mesh;
}

std::vector<Vec3> places_of(const PolyMesh& mesh) {
    return {mesh.points(), mesh.points() + mesh.n_vertices()};
}

SolidView marked_view(const std::vector<Vec3>& frame, double left) {
    return SolidView(frame, towards, {left, 14}, 290);
}

void draw_marked(Canvas& canvas, const PolyMesh& mesh, const std::vector<Vec3>& frame, double left,
                 const std::string& name, const std::function<std::string(std::size_t)>& fill) {
    const SolidView view = marked_view(frame, left);
    const auto grey = [](std::size_t) { return ground; };
    view.draw(canvas, to_polygons(mesh), fill ? fill : grey, edge_style);
    const auto seen = [&](OpenMesh::SmartHalfedgeHandle h) {
        return !h.is_boundary() && view.faces(mesh.normal(h.face()));
    };
    std::vector<std::array<Vec2, 2>> creases;
    for (const auto e : mesh.edges())
        if (e.feature() && (seen(e.h0()) || seen(e.h1())))
            creases.push_back({view(mesh.point(e.v0())), view(mesh.point(e.v1()))});
    canvas.lines(creases, crease_style);
    canvas.text({left + 145, 328}, name, 13, "middle");
}

} // namespace hsdm::figures
