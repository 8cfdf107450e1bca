#include "hsdm/contour/flat_facets.hh"

#include "hsdm/core/chunks.hh"
#include "hsdm/mesh/collapse_edges.hh"
#include "hsdm/mesh/manifold.hh"
#include "hsdm/quality/topology.hh"

#include <algorithm>

namespace hsdm {
namespace {

std::vector<Index> flat_facets(const Vec3& origin, const PolygonMesh& mesh) {
    return collected<Index>(mesh.facet_count(), chunks::quick,
                            [&](std::size_t begin, std::size_t end, std::vector<Index>& part) {
                                std::vector<Vec3> ring;
                                for (std::size_t f = begin; f < end; ++f) {
                                    ring.clear();
                                    for (const Index v : mesh.facet(f))
                                        ring.push_back(mesh.positions[v] + origin);
                                    if (has_no_area(ring)) part.push_back(static_cast<Index>(f));
                                }
                            });
}

EdgeCollapse shortest_side(const PolygonMesh& mesh, std::span<const Index> facet) {
    double least = Box::inf;
    EdgeCollapse shortest{};
    for (std::size_t i = 0; i < facet.size(); ++i) {
        const Index from = facet[i], to = facet[(i + 1) % facet.size()];
        const double length = (mesh.positions[to] - mesh.positions[from]).sqrnorm();
        if (length < least) least = length, shortest = {from, to, mesh.positions[to]};
    }
    return shortest;
}

} // namespace

std::size_t collapse_flat_facets(const Vec3& origin, PolygonMesh& mesh) {
    std::size_t count = 0;
    for (std::size_t more = 1; more > 0; count += more) {
        std::vector<EdgeCollapse> sides;
        for (const Index f : flat_facets(origin, mesh)) sides.push_back(shortest_side(mesh, mesh.facet(f)));
        const std::vector<std::uint8_t> collapsed = collapse_edges(mesh, sides);
        more = static_cast<std::size_t>(std::ranges::count(collapsed, 1));
        if (more > 0) remove_isolated_vertices(mesh);
    }
    return count;
}

} // namespace hsdm
