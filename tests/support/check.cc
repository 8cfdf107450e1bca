#include "support/check.hh"

#include <algorithm>
#include <cmath>
#include <vector>

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

std::string difference_of_bits(const PolygonMesh& one, const PolygonMesh& other) {
    if (!are_same_bits(one.positions, other.positions)) return "positions";
    if (one.corners != other.corners || one.first != other.first) return "facets";
    if (one.sharp_edges != other.sharp_edges) return "sharp edges";
    if (one.properties.size() != other.properties.size()) return "properties";
    for (std::size_t i = 0; i < one.properties.size(); ++i)
        if (one.properties[i].name != other.properties[i].name
            || !are_same_bits(one.properties[i].values, other.properties[i].values))
            return one.properties[i].name;
    return {};
}

std::string difference_of_turned(const PolygonMesh& one, const PolygonMesh& other) {
    if (one.vertex_count() != other.vertex_count() || one.facet_count() != other.facet_count())
        return std::to_string(one.vertex_count()) + " vertices and " + std::to_string(one.facet_count())
               + " facets, not " + std::to_string(other.vertex_count()) + " and "
               + std::to_string(other.facet_count());
    Box box;
    for (const Vec3& p : one.positions) box.add(p);
    for (std::size_t v = 0; v < one.vertex_count(); ++v)
        if ((one.positions[v] - other.positions[v]).norm() > 1e-9 * box.extent())
            return "vertex " + std::to_string(v) + " lies elsewhere";
    // Each from its least vertex on.
    const auto facets = [](const PolygonMesh& mesh, bool turned) {
        std::vector<std::vector<Index>> all;
        for (std::size_t f = 0; f < mesh.facet_count(); ++f) {
            all.emplace_back(mesh.facet(f).begin(), mesh.facet(f).end());
            if (turned) std::ranges::reverse(all.back());
            std::rotate(all.back().begin(), std::ranges::min_element(all.back()), all.back().end());
        }
        std::ranges::sort(all);
        return all;
    };
    const auto wanted = facets(one, false);
    const bool same = facets(other, false) == wanted || facets(other, true) == wanted;
    return same ? "" : "facets have other vertices, or some are turned over";
}

} // namespace hsdm::support
