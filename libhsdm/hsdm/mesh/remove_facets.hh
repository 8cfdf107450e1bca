#pragma once
// Removes facets from a mesh, together with the hints of their sides.

#include "hsdm/core/occurrences.hh"
#include "hsdm/mesh/feature_hints.hh"
#include "hsdm/polygon_mesh.hh"

namespace hsdm {

/// Removes the facets f for which is_out(f), with the hints of their sides (none, or one per side); vertices
/// stay. Returns how many went and a vertex of the first. O(corners).
template <class IsOut>
Occurrences remove_facets(PolygonMesh& mesh, std::vector<EdgeHint>& hints, IsOut is_out) {
    Occurrences removed;
    PolygonMesh kept;
    std::vector<EdgeHint> sides;
    for (std::size_t f = 0; f < mesh.facet_count(); ++f) {
        if (is_out(f)) {
            removed.add({1, mesh.positions[mesh.facet(f)[0]]});
            continue;
        }
        kept.add_facet(mesh.facet(f));
        if (!hints.empty())
            sides.insert(sides.end(), hints.begin() + mesh.first[f], hints.begin() + mesh.first[f + 1]);
    }
    mesh.corners = std::move(kept.corners);
    mesh.first = std::move(kept.first);
    hints = std::move(sides);
    return removed;
}

/// The same of a mesh without hints.
template <class IsOut>
Occurrences remove_facets(PolygonMesh& mesh, IsOut is_out) {
    std::vector<EdgeHint> none;
    return remove_facets(mesh, none, is_out);
}

} // namespace hsdm
