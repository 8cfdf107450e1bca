// Points in structs of one's own, read where they are; then a hole closed, values carried, neighbours found.
#include <hsdm/errors.hh>
#include <hsdm/features/HoleFillerT.hh>
#include <hsdm/reconstruct.hh>
#include <hsdm/spatial/neighbor_search.hh>
#include <hsdm/spatial/transfer_attributes.hh>

#include <cmath>
#include <iostream>
#include <numbers>
#include <vector>

struct Hit {
    float position[3], normal[3];
    std::uint8_t rgb[3];
    std::uint16_t intensity;
};

/// A scan of the unit sphere, along a spiral.
std::vector<Hit> scan() {
    constexpr int n = 20000;
    std::vector<Hit> hits(n);
    for (int i = 0; i < n; ++i) {
        const double z = (2 * i + 1.0) / n - 1, radius = std::sqrt(1 - z * z);
        const double turn = i * std::numbers::pi * (3 - std::sqrt(5.0));
        Hit& hit = hits[static_cast<std::size_t>(i)];
        const double p[3] = {radius * std::cos(turn), radius * std::sin(turn), z};
        for (int k = 0; k < 3; ++k) hit.position[k] = hit.normal[k] = static_cast<float>(p[k]);
        hit.rgb[0] = z > 0 ? 255 : 0;
        hit.rgb[1] = hit.rgb[2] = 40;
        hit.intensity = static_cast<std::uint16_t>(1000 + 500 * z);
    }
    return hits;
}

int main() try {
    const std::vector<Hit> hits = scan();
    hsdm::PointView view;
    view.positions = {hits[0].position, hits.size(), sizeof(Hit)};
    view.normals = {hits[0].normal, hits.size(), sizeof(Hit)};
    view.colors = {hits[0].rgb, hits.size(), sizeof(Hit)};
    view.color_channels = 3;
    view.scalars = {{"intensity", {&hits[0].intensity, hits.size(), sizeof(Hit)}, false}};

    bool stop = false; // set by whatever may
    hsdm::ReconstructOptions options;
    options.depth = 4;
    options.threads = 2;
    options.progress = [&](const char*, double) { return !stop; };
    hsdm::Reconstruction part = hsdm::reconstruct(view, options);
    hsdm::PolyMesh& mesh = part.mesh;

    mesh.request_face_status();
    mesh.delete_face(mesh.face_handle(0), false);
    mesh.garbage_collection();
    hsdm::HoleFillerT<hsdm::PolyMesh> filler(mesh);
    filler.initialize({.max_edges = 20, .max_diameter = 5}); // the mesh's units
    const hsdm::FillHolesCounts holes = filler.fill();

    hsdm::PointCloud labelled; // any other points, with values of their own
    labelled.positions = {{0, 0, 1}, {0, 0, -1}};
    labelled.scalars = {{"pole", {1, 2}, true}};
    const hsdm::TransferCounts carried = hsdm::transfer_attributes(labelled, mesh, {.neighbors = 1});

    const hsdm::NeighborSearch search({mesh.points(), mesh.n_vertices()});
    const hsdm::NearPoints eight = search.nearest(labelled.positions, 8);
    const hsdm::NearPoints round = search.within(labelled.positions, 0.5); // all within 0.5 of each
    const hsdm::NearPoints others = search.neighbors(8);                   // of every point, itself left out

    const auto red = OpenMesh::getProperty<OpenMesh::VertexHandle, std::uint8_t>(mesh, "red");
    const auto pole = OpenMesh::getProperty<OpenMesh::VertexHandle, std::int32_t>(mesh, "pole");
    const OpenMesh::VertexHandle top(static_cast<int>(eight.of(0)[0]));
    std::cout << mesh.n_faces() << " facets, " << holes.closed << " hole closed, " << carried.properties
              << " property carried; at the top: red " << int(red[top]) << ", pole " << pole[top] << ", "
              << round.of(0).size() << " vertices within 0.5, " << others.places()
              << " with their neighbours\n";
    return red[top] == 255 && pole[top] == 1 ? 0 : 1;
} catch (const hsdm::Cancelled&) {
    return 3;
} catch (const hsdm::OptionError& error) { // an option out of its range
    std::cerr << error.what() << '\n';
    return 2;
} catch (const hsdm::Error& error) { // a cloud or file that is no surface's
    std::cerr << error.what() << '\n';
    return 1;
}
