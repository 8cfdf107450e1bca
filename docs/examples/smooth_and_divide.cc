// Positions smoothed and facets divided, with sharp edges kept: smooth_and_divide FILE
#include <hsdm/features/AnisotropicSmootherT.hh>
#include <hsdm/features/FeatureClassifierT.hh>
#include <hsdm/features/FeatureSubdividerT.hh>

#include <OpenMesh/Core/IO/MeshIO.hh>
#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>

#include <iostream>

using Mesh = OpenMesh::TriMesh_ArrayKernelT<>;

int main(int argc, char** argv) {
    Mesh mesh;
    mesh.request_vertex_status(); // yours to keep: the modules release what they request
    mesh.request_edge_status();
    if (argc != 2 || !OpenMesh::IO::read_mesh(mesh, argv[1])) return 1;

    hsdm::FeatureClassifierT<Mesh> classifier(mesh);
    classifier.initialize();
    classifier.classify();

    hsdm::AnisotropicSmootherT<Mesh> smoother(mesh);
    smoother.initialize({.max_drift_share = 0.1}); // of the mean edge
    const hsdm::VertexSmoothingResult smoothed = smoother.smooth();

    hsdm::FeatureSubdividerT<Mesh> subdivider(mesh);
    subdivider.initialize({.rounds = 2});
    const hsdm::SubdivisionCounts divided = subdivider.divide();

    std::cout << smoothed.moved << " vertices moved, at most by " << smoothed.drift_max << "; "
              << divided.facets_before << " facets became " << divided.facets_after << ", with "
              << divided.sharp_edges << " sharp edges and " << divided.corners << " corners\n";
    return 0;
}
