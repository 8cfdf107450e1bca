#include "hsdm/mesh/vertex_neighbors.hh"

#include "hsdm/core/chunks.hh"
#include "hsdm/core/parallel_sort.hh"

namespace hsdm {

VertexNeighbors::VertexNeighbors(const PolygonMesh& mesh, std::span<const std::uint8_t> wanted) {
    std::vector<std::array<Index, 2>> sides; // from a vertex to one beside it
    for_each_in_order(mesh.facet_count(), [&](std::size_t f) {
        const auto corners = mesh.facet(f);
        for (std::size_t c = 0; c < corners.size(); ++c) {
            const Index a = corners[c], b = corners[(c + 1) % corners.size()];
            if (wanted.empty() || wanted[a] != 0) push_large(sides, {a, b});
            if (wanted.empty() || wanted[b] != 0) push_large(sides, {b, a});
        }
    });
    parallel_sort_unique(sides);
    assign_large(first_, mesh.vertex_count() + 1, Index(0));
    resize_large(beside_, sides.size());
    for_each_in_order(sides.size(), [&](std::size_t i) {
        ++first_[sides[i][0] + 1];
        beside_[i] = sides[i][1];
    });
    counts_to_first(first_);
}

} // namespace hsdm
