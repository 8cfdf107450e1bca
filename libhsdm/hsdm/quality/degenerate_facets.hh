#pragma once
// The last look at facets before they become a mesh.

#include "hsdm/cloud/cloud_frame.hh"
#include "hsdm/core/occurrences.hh"
#include "hsdm/mesh/facet_links.hh"
#include "hsdm/mesh/feature_hints.hh"

namespace hsdm {

/// Removes the facets that no sound mesh holds: those without area at their final position, `origin` in the
/// frame, where coordinates are rounded; two facets over the same vertices; closed surfaces of fewer than
/// four facets, which enclose nothing; and those across space that the frame has cut out. Clouds of a few
/// points or of extreme shape leave such. Hints go with their facets; `links` are the mesh's, and are linked
/// anew if something is removed. Returns how many were removed, and where relative to the origin. O(corners),
/// parallel.
Occurrences drop_degenerate_facets(PolygonMesh& mesh, const Vec3& origin, const CloudFrame& frame,
                                   FacetLinks& links, FeatureHints& hints);

} // namespace hsdm
