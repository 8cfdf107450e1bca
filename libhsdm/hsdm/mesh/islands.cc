#include "hsdm/mesh/islands.hh"

#include "hsdm/core/disjoint_sets.hh"
#include "hsdm/mesh/area_vector.hh"
#include "hsdm/mesh/manifold.hh"
#include "hsdm/mesh/remove_facets.hh"

namespace hsdm {
namespace {

/// By component, at the index of its first vertex.
struct Sizes {
    std::vector<std::size_t> facets;
    std::vector<double> area;
};

Sizes measure(const PolygonMesh& mesh, DisjointSets& components) {
    Sizes sizes{std::vector<std::size_t>(mesh.vertex_count(), 0),
                std::vector<double>(mesh.vertex_count(), 0)};
    for (std::size_t f = 0; f < mesh.facet_count(); ++f) {
        const Index c = components.find(mesh.facet(f)[0]);
        ++sizes.facets[c];
        sizes.area[c] += area_vector(mesh, mesh.facet(f)).norm();
    }
    return sizes;
}

} // namespace

Islands drop_islands(PolygonMesh& mesh, FeatureHints& hints, const IslandsOptions& options) {
    Islands removed;
    if (mesh.facet_count() == 0) return removed;
    DisjointSets components(mesh.vertex_count());
    for (std::size_t f = 0; f < mesh.facet_count(); ++f)
        for (Index v : mesh.facet(f)) components.join(mesh.facet(f)[0], v);
    const Sizes sizes = measure(mesh, components);
    const auto largest =
        static_cast<std::size_t>(std::max_element(sizes.area.begin(), sizes.area.end()) - sizes.area.begin());
    const auto is_small = [&](std::size_t c) {
        if (c == largest) return false;
        return static_cast<double>(sizes.facets[c]) < options.least_facets || options.least_share >= 1
               || sizes.area[c] < options.least_share * sizes.area[largest];
    };
    for (std::size_t c = 0; c < sizes.facets.size(); ++c)
        if (sizes.facets[c] > 0 && is_small(c)) ++removed.components;
    if (removed.components == 0) return removed;
    removed.facets = remove_facets(
        mesh, hints.sides, [&](std::size_t f) { return is_small(components.find(mesh.facet(f)[0])); });
    remove_isolated_vertices(mesh);
    return removed;
}

} // namespace hsdm
