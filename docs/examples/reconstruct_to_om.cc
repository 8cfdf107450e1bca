// From scanned points to a small mesh with its creases, in a mesh type of one's own: reconstruct_to_om
// FILE.om
#include <hsdm/ReconstructorT.hh>
#include <hsdm/features/AnisotropicSmootherT.hh>
#include <hsdm/features/ModFeatureT.hh>
#include <hsdm/io/register_readers.hh>

#include <OpenMesh/Core/IO/MeshIO.hh>
#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>
#include <OpenMesh/Tools/Decimater/DecimaterT.hh>
#include <OpenMesh/Tools/Decimater/ModQuadricT.hh>

#include <algorithm>
#include <iostream>

struct Traits : OpenMesh::DefaultTraits { // float
    VertexAttributes(OpenMesh::Attributes::Normal | OpenMesh::Attributes::Status);
    HalfedgeAttributes(OpenMesh::Attributes::PrevHalfedge | OpenMesh::Attributes::Status);
    EdgeAttributes(OpenMesh::Attributes::Status);
    FaceAttributes(OpenMesh::Attributes::Normal | OpenMesh::Attributes::Status);
};
using Mesh = OpenMesh::TriMesh_ArrayKernelT<Traits>;

/// Points with normals, even over the sides of the cube [-1, 1]^3.
Mesh scan() {
    constexpr int n = 60;
    Mesh mesh;
    for (unsigned axis = 0; axis < 3; ++axis)
        for (const float side : {-1.0f, 1.0f})
            for (int i = 0; i < n * n; ++i) {
                Mesh::Point p;
                p[axis] = side;
                p[(axis + 1) % 3] = (2 * static_cast<float>(i % n) + 1) / n - 1;
                p[(axis + 2) % 3] = (2 * static_cast<float>(i / n) + 1) / n - 1;
                Mesh::Normal normal(0, 0, 0);
                normal[axis] = side;
                mesh.set_normal(mesh.add_vertex(p), normal);
            }
    return mesh;
}

auto marked_edges(const Mesh& mesh) {
    return std::count_if(mesh.edges_begin(), mesh.edges_end(), [](const auto e) { return e.feature(); });
}

int main(int argc, char** argv) {
    if (argc != 2) return 2;
    Mesh mesh = scan(); // or vertices that OpenMesh::IO::read_mesh has read
    hsdm::ReconstructorT<Mesh> reconstructor(mesh);
    reconstructor.initialize({.depth = 4});
    const hsdm::Report report = reconstructor.reconstruct();
    const std::size_t fine = mesh.n_faces();

    OpenMesh::Decimater::DecimaterT<Mesh> decimater(mesh);
    OpenMesh::Decimater::ModQuadricT<Mesh>::Handle quadrics;
    hsdm::ModFeatureT<Mesh>::Handle features;
    decimater.add(quadrics);
    decimater.add(features);
    decimater.module(features).set_options({.crease_angle = 0.7}); // radians
    decimater.initialize();
    decimater.decimate_to_faces(0, fine / 8);
    mesh.garbage_collection();

    hsdm::AnisotropicSmootherT<Mesh> smoother(mesh);
    smoother.initialize({.max_drift_share = 0.1}); // of the mean edge
    smoother.smooth();
    mesh.update_normals();

    using OpenMesh::IO::Options;
    const Options everything = Options::Binary | Options::VertexNormal | Options::Status | Options::Custom;
    if (!OpenMesh::IO::write_mesh(mesh, argv[1], everything)) return 1;

    hsdm::register_readers(); // once: OpenMesh then knows the property hsdm_normals
    Mesh again;
    Options wanted = Options::VertexNormal | Options::Status;
    if (!OpenMesh::IO::read_mesh(again, argv[1], wanted)) return 1;

    std::cout << report.input.points << " points, " << fine << " triangles, " << again.n_faces()
              << " of them left, " << marked_edges(mesh) << " sharp edges written, " << marked_edges(again)
              << " read\n";
    return marked_edges(again) == marked_edges(mesh) && marked_edges(mesh) > 0 ? 0 : 1;
}
