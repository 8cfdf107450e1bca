#include "hsdm/simplify/border_vertices.hh"

#include <algorithm>

namespace hsdm {

std::vector<std::uint8_t> border_vertices(const PolygonMesh& mesh) {
    // In a closed fan every neighbour follows the vertex in one facet and precedes it in another, so the sum
    // of their differences is 0.
    std::vector<std::int64_t> balance(mesh.vertex_count(), 0);
    for (std::size_t f = 0; f < mesh.facet_count(); ++f) {
        const auto ring = mesh.facet(f);
        Index before = ring.back();
        for (std::size_t i = 0; i < ring.size(); before = ring[i++])
            balance[ring[i]] += std::int64_t{ring[(i + 1) % ring.size()]} - std::int64_t{before};
    }
    std::vector<std::uint8_t> border(balance.size());
    std::transform(balance.begin(), balance.end(), border.begin(), [](std::int64_t b) { return b != 0; });
    return border;
}

} // namespace hsdm
