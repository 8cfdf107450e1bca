#include "hsdm/mesh/debris.hh"

#include "hsdm/core/chunks.hh"
#include "hsdm/core/disjoint_sets.hh"
#include "hsdm/mesh/remove_facets.hh"

#include <array>
#include <atomic>
#include <iterator>

namespace hsdm {
namespace {

constexpr std::size_t facets_per_chunk = 4096;

/// By the vertex that stands for the component.
std::vector<std::size_t> facets_of_components(const PolygonMesh& mesh, DisjointSets& components) {
    std::vector<std::size_t> sizes(mesh.vertex_count(), 0);
    for_chunks(mesh.facet_count(), facets_per_chunk, [&](std::size_t begin, std::size_t end, std::size_t) {
        for (std::size_t first = begin, f = begin; f < end; first = f) { // facets of one come in long runs
            const Index component = components.find(mesh.facet(f)[0]);
            while (++f < end && components.find(mesh.facet(f)[0]) == component) continue;
            std::atomic_ref(sizes[component]).fetch_add(f - first, std::memory_order_relaxed);
        }
    });
    return sizes;
}

/// Of the components of no more facets than `most`: do they have a border?
std::vector<std::uint8_t> open_components(const PolygonMesh& mesh, DisjointSets& components,
                                          const std::vector<std::size_t>& sizes, std::size_t most) {
    std::vector<std::array<Index, 2>> sides, reverse;
    for (std::size_t f = 0; f < mesh.facet_count(); ++f) {
        const auto ring = mesh.facet(f);
        if (sizes[components.find(ring[0])] > most) continue;
        for (std::size_t i = 0; i < ring.size(); ++i) {
            sides.push_back({ring[i], ring[(i + 1) % ring.size()]});
            reverse.push_back({ring[(i + 1) % ring.size()], ring[i]});
        }
    }
    std::sort(sides.begin(), sides.end());
    std::sort(reverse.begin(), reverse.end());
    std::vector<std::array<Index, 2>> alone;
    std::set_difference(sides.begin(), sides.end(), reverse.begin(), reverse.end(),
                        std::back_inserter(alone));
    std::vector<std::uint8_t> open(sizes.size(), 0);
    for (const auto& side : alone) open[components.find(side[0])] = 1;
    return open;
}

} // namespace

Discarded drop_debris(PolygonMesh& mesh, const DebrisOptions& options) {
    if (mesh.facet_count() == 0) return {};
    DisjointSets components(mesh.vertex_count());
    for_chunks(mesh.facet_count(), facets_per_chunk, [&](std::size_t begin, std::size_t end, std::size_t) {
        for (std::size_t f = begin; f < end; ++f)
            for (Index v : mesh.facet(f)) components.join(mesh.facet(f)[0], v);
    });
    const std::vector<std::size_t> sizes = facets_of_components(mesh, components);
    const auto largest = static_cast<double>(*std::max_element(sizes.begin(), sizes.end()));
    const std::vector<std::uint8_t> open = open_components(mesh, components, sizes, options.most_open);
    std::vector<std::uint8_t> debris(sizes.size(), 0);
    for (std::size_t c = 0; c < sizes.size(); ++c)
        debris[c] = sizes[c] > 0 && sizes[c] <= (open[c] ? options.most_open : options.most_facets)
                    && static_cast<double>(sizes[c]) * options.least_ratio <= largest;
    if (std::none_of(debris.begin(), debris.end(), [](std::uint8_t d) { return d; })) return {};
    std::vector<EdgeHint> none;
    return remove_facets(mesh, none,
                         [&](std::size_t f) { return debris[components.find(mesh.facet(f)[0])] != 0; });
}

} // namespace hsdm
