#pragma once
// Closed components face outward, unless they are the wall of a cavity.

#include "hsdm/mesh/facet_links.hh"
#include "hsdm/mesh/feature_hints.hh"

namespace hsdm {

/// Turns closed components that face inward although nothing that others enclose holds them; inside of these,
/// turns whatever then faces the same way as what is around it (normals that contradict each other may leave
/// such). Hints follow their sides. `links` are the mesh's, of which `twin` alone is read, and are linked
/// anew if something turns. Returns the number of facets turned. O(facets log facets), parallel; little more
/// than reading the mesh if nothing faces inward.
std::size_t turn_outward(PolygonMesh& mesh, FacetLinks& links, FeatureHints& hints);

/// Turns every facet of a mesh that has no hints yet.
void turn_over(PolygonMesh& mesh);

} // namespace hsdm
