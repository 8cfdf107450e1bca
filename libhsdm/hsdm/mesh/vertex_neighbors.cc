#include "hsdm/mesh/vertex_neighbors.hh"

#include "hsdm/core/chunks.hh"
#include "hsdm/core/parallel_sort.hh"

#include <algorithm>
#include <array>

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

FacetsAt::FacetsAt(const PolygonMesh& mesh, std::span<const std::uint8_t> wanted) {
    using Corner = std::array<Index, 2>; // vertex, facet
    std::vector<Corner> corners =
        collected<Corner>(mesh.facet_count(), chunks::quick,
                          [&](std::size_t begin, std::size_t end, std::vector<Corner>& found) {
                              for (std::size_t f = begin; f < end; ++f)
                                  for (const Index v : mesh.facet(f))
                                      if (wanted[v] != 0) found.push_back({v, static_cast<Index>(f)});
                          });
    std::ranges::sort(corners);
    vertices_.reserve(corners.size());
    facets_.reserve(corners.size());
    for (const auto& [vertex, facet] : corners) {
        vertices_.push_back(vertex);
        facets_.push_back(facet);
    }
}

std::span<const Index> FacetsAt::of(Index vertex) const {
    const auto [first, last] = std::equal_range(vertices_.begin(), vertices_.end(), vertex);
    return {facets_.begin() + (first - vertices_.begin()), facets_.begin() + (last - vertices_.begin())};
}

std::vector<Index> FacetsAt::of_any(std::span<const Index> vertices) const {
    std::vector<Index> facets;
    for (const Index v : vertices) {
        const std::span<const Index> more = of(v);
        facets.insert(facets.end(), more.begin(), more.end());
    }
    sort_unique(facets);
    return facets;
}

std::vector<Index> FacetsAt::all() const {
    std::vector<Index> facets = facets_;
    sort_unique(facets);
    return facets;
}

} // namespace hsdm
