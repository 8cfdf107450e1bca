#include "support/check.hh"

#include <cmath>

namespace hsdm::support {

std::string faults(const PolygonMesh& mesh) {
    const Topology topology = measure_topology(mesh);
    std::string text;
    const auto count = [&text](std::size_t number, const char* what) {
        if (number > 0) text += std::to_string(number) + " " + what + "; ";
    };
    if (topology.faces == 0) text += "no facet; ";
    count(topology.nonmanifold_edges, "non-manifold edges");
    count(topology.nonmanifold_vertices, "non-manifold vertices");
    count(topology.misoriented_edges, "edges between facets of opposite orientation");
    count(topology.degenerate_facets, "degenerate facets");
    count(topology.duplicate_facets, "duplicate facets");
    count(topology.isolated_vertices, "isolated vertices");
    if (topology.closed() && topology.signed_volume <= 0) text += "closed but not outward; ";
    return text;
}

double farthest_vertex(const PolygonMesh& mesh, const Solid& solid) {
    double farthest = 0;
    for (const Vec3& p : mesh.positions) farthest = std::max(farthest, std::abs(solid.distance(p)));
    return farthest;
}

} // namespace hsdm::support
