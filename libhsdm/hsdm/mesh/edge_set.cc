#include "hsdm/mesh/edge_set.hh"

#include "hsdm/core/interruption.hh"
#include "hsdm/core/large_vector.hh"
#include "hsdm/core/parallel_sort.hh"

#include <algorithm>

namespace hsdm {

EdgeSet::EdgeSet(const PolygonMesh& mesh, std::span<const Index> vertices) {
    std::vector<std::uint8_t> marked = large_vector<std::uint8_t>(mesh.vertex_count());
    assign_large(shared_, mesh.vertex_count(), 0);
    for (Index v : vertices) {
        shared_[v] |= marked[v];
        marked[v] = 1;
    }
    for_each_in_order(mesh.facet_count(), [&](std::size_t f) {
        const auto facet = mesh.facet(f);
        for (std::size_t i = 0; i < facet.size(); ++i) {
            const Index a = facet[i], b = facet[i + 1 < facet.size() ? i + 1 : 0];
            if (marked[a] && marked[b]) push_large(edges_, key(a, b));
        }
    });
    parallel_sort_unique(edges_);
}

std::uint64_t EdgeSet::key(Index a, Index b) {
    return static_cast<std::uint64_t>(std::min(a, b)) << 32 | std::max(a, b);
}

bool EdgeSet::contains(Index a, Index b) const {
    return std::binary_search(edges_.begin(), edges_.end(), key(a, b)) || added_.contains(key(a, b));
}

void EdgeSet::add(std::span<const Index> facet) {
    for (std::size_t i = 0; i < facet.size(); ++i) {
        const Index a = facet[i], b = facet[i + 1 < facet.size() ? i + 1 : 0];
        // Vertices added to the mesh after this set was made belong to one polygon alone.
        if (std::max(a, b) < shared_.size() && shared_[a] && shared_[b]) added_.insert(key(a, b));
    }
}

} // namespace hsdm
