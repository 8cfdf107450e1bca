// What the modules do to a mesh's vertices and facets, with creases kept.

#include "figures.hh"
#include "marked_view.hh"

#include "hsdm/features/HoleFillerT.hh"
#include "hsdm/features/features.hh"
#include "hsdm/stages/decimate_mesh.hh"

#include <utility>

namespace hsdm::figures {
namespace {

/// Removes the facets about a place.
void cut_hole(PolyMesh& mesh, const Vec3& place, double radius) {
    mesh.request_face_status();
    for (const auto f : mesh.faces())
        if ((mesh.calc_face_centroid(f) - place).norm() < radius) mesh.delete_face(f, true);
    mesh.garbage_collection();
}

} // namespace

Canvas draw_smoothed() {
    PolyMesh mesh = noisy_slice();
    const std::vector<Vec3> frame = places_of(slice());
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

Canvas draw_decimated() {
    PolyMesh mesh = slice();
    const std::vector<Vec3> frame = places_of(mesh);
    Canvas canvas(930, 340);
    draw_marked(canvas, mesh, frame, 14, std::to_string(mesh.n_faces()) + " facets");
    decimate_mesh(mesh, {.facets = mesh.n_faces() / 2});
    draw_marked(canvas, mesh, frame, 319, std::to_string(mesh.n_faces()) + " triangles");
    decimate_mesh(mesh, {.facets = mesh.n_faces() / 4});
    draw_marked(canvas, mesh, frame, 624, std::to_string(mesh.n_faces()) + " triangles");
    return canvas;
}

Canvas draw_filled() {
    PolyMesh mesh = slice();
    const std::vector<Vec3> frame = places_of(mesh);
    cut_hole(mesh, {0.15, 0.1, 0.3}, 0.13);
    cut_hole(mesh, {0.28, 0.3, 0.05}, 0.11);
    Canvas canvas(620, 340);
    draw_marked(canvas, mesh, frame, 14, "two holes");
    const std::size_t before = mesh.n_faces();
    HoleFillerT<PolyMesh> filler(mesh);
    filler.initialize({.max_edges = 40});
    const FillHolesCounts counts = filler.fill();
    mesh.update_face_normals();
    const auto fill = [&](std::size_t f) { return f < before ? std::string("#ececec") : colour::sky; };
    draw_marked(canvas, mesh, frame, 319, std::to_string(counts.closed) + " loops closed", fill);
    return canvas;
}

} // namespace hsdm::figures
