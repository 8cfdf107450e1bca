// Sharp edges and smooth normals on a mesh of your own: classify_features FILE
#include <OpenMesh/Core/IO/MeshIO.hh>
#include <OpenMesh/Core/Mesh/PolyMesh_ArrayKernelT.hh>

#include <hsdm/features/AnisotropicNormalSmootherT.hh>
#include <hsdm/features/FeatureClassifierT.hh>

#include <iostream>

int main(int argc, char** argv) {
    using Mesh = OpenMesh::PolyMesh_ArrayKernelT<>;

    Mesh mesh;
    mesh.request_vertex_status(); // yours to keep: the modules release what they request
    mesh.request_edge_status();
    mesh.request_vertex_normals();
    if (argc != 2 || !OpenMesh::IO::read_mesh(mesh, argv[1])) return 1;

    hsdm::FeatureClassifierT<Mesh> classifier(mesh);
    classifier.initialize({.crease_angle = 0.7}); // radians: 40 degrees
    const hsdm::FeatureCounts found = classifier.classify();

    hsdm::AnisotropicNormalSmootherT<Mesh> smoother(mesh);
    smoother.initialize();
    smoother.smooth(3);

    using Normals = hsdm::VertexNormalsT<Mesh>;
    const auto count = OpenMesh::getProperty<OpenMesh::VertexHandle, std::uint8_t>(mesh, "hsdm_normal_count");
    const auto normals = OpenMesh::getProperty<OpenMesh::VertexHandle, Normals>(mesh, "hsdm_normals");
    std::cout << found.sharp_edges << " sharp edges, " << found.corner_vertices << " corners\n";
    for (const auto v : mesh.vertices())
        for (std::size_t k = 0; k < count[v]; ++k)
            std::cout << mesh.point(v) << "  " << normals[v][k] << '\n';
}
