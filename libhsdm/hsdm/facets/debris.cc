#include "hsdm/facets/debris.hh"

#include "hsdm/disjoint_sets.hh"

namespace hsdm {

std::size_t drop_debris(PolygonMesh& mesh, const DebrisOptions& options) {
    if (mesh.facet_count() == 0) return 0;
    DisjointSets components(mesh.vertex_count());
    for (std::size_t f = 0; f < mesh.facet_count(); ++f)
        for (Index v : mesh.facet(f)) components.join(mesh.facet(f)[0], v);
    std::vector<std::size_t> sizes(mesh.vertex_count(), 0);
    for (std::size_t f = 0; f < mesh.facet_count(); ++f) ++sizes[components.find(mesh.facet(f)[0])];
    const auto largest = static_cast<double>(*std::max_element(sizes.begin(), sizes.end()));
    const auto is_debris = [&](std::size_t facets) {
        return facets <= options.most_facets && static_cast<double>(facets) * options.least_ratio <= largest;
    };
    if (std::none_of(sizes.begin(), sizes.end(), [&](std::size_t n) { return n > 0 && is_debris(n); }))
        return 0;
    PolygonMesh kept;
    for (std::size_t f = 0; f < mesh.facet_count(); ++f)
        if (!is_debris(sizes[components.find(mesh.facet(f)[0])])) kept.add_facet(mesh.facet(f));
    const std::size_t removed = mesh.facet_count() - kept.facet_count();
    mesh.corners = std::move(kept.corners);
    mesh.first = std::move(kept.first);
    return removed;
}

} // namespace hsdm
