#include "hsdm/simplify/border_vertices.hh"

#include "hsdm/core/chunks.hh"

namespace hsdm {

std::vector<std::uint8_t> border_vertices(const PolygonMesh& mesh) {
    // In a closed fan every neighbour follows the vertex in one facet and precedes it in another, so the sum
    // of their differences is 0.
    std::vector<std::int64_t> balance = large_vector<std::int64_t>(mesh.vertex_count());
    for_each_in_order(mesh.facet_count(), [&](std::size_t f) {
        const auto ring = mesh.facet(f);
        Index before = ring.back();
        for (std::size_t i = 0; i < ring.size(); before = ring[i++])
            balance[ring[i]] += std::int64_t{ring[(i + 1) % ring.size()]} - std::int64_t{before};
    });
    std::vector<std::uint8_t> border = large_vector<std::uint8_t>(balance.size());
    for_each_index(border.size(), chunks::light, [&](Index v) { border[v] = balance[v] != 0; });
    return border;
}

} // namespace hsdm
