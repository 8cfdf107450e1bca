#pragma once
// Closed components face outward, unless they are the wall of a cavity.

#include "hsdm/mesh/facet_links.hh"
#include "hsdm/mesh/feature_hints.hh"

namespace hsdm {

/// Turns the closed components that face inward though they lie in nothing that others enclose, and inside of
/// these whatever does not face against what is around it then: normals that contradict each other may leave
/// such. Hints go with their sides. `links` are the mesh's, and are linked anew if something turns. Returns
/// the number of facets turned. O(facets log facets), parallel; little more than reading the mesh where
/// nothing faces inward.
std::size_t turn_outward(PolygonMesh& mesh, FacetLinks& links, FeatureHints& hints);

} // namespace hsdm
