#include "hsdm/mesh/corner_pairs.hh"

#include "hsdm/core/chunks.hh"
#include "hsdm/core/parallel_sort.hh"

#include <algorithm>

namespace hsdm {

CornerPairs::CornerPairs(const PolygonMesh& mesh, std::span<const Index> vertices) {
    std::vector<std::uint8_t> marked = large_vector<std::uint8_t>(mesh.vertex_count());
    for (const Index v : vertices) marked[v] = 1;
    pairs_ = collected<Pair>(mesh.facet_count(), chunks::quick,
                             [&](std::size_t begin, std::size_t end, std::vector<Pair>& part) {
                                 std::vector<Index> corners;
                                 for (auto f = static_cast<Index>(begin); f < end; ++f) {
                                     corners.clear();
                                     for (const Index v : mesh.facet(f))
                                         if (marked[v]) corners.push_back(v);
                                     for (const Index a : corners)
                                         for (const Index b : corners)
                                             if (a < b) part.push_back({{a, b}, f});
                                 }
                             });
    parallel_sort(pairs_);
}

bool CornerPairs::are_together(const VertexPair& pair, std::span<const Index> but) const {
    for (auto i = std::ranges::lower_bound(pairs_, Pair{pair, 0}); i != pairs_.end() && i->vertices == pair;
         ++i)
        if (std::ranges::find(but, i->facet) == but.end()) return true;
    return false;
}

} // namespace hsdm
