#pragma once
// Small components, dropped when asked.

#include "hsdm/core/discarded.hh"
#include "hsdm/mesh/feature_hints.hh"
#include "hsdm/polygon_mesh.hh"

namespace hsdm {

struct IslandsOptions {
    double least_facets = 0; ///< smaller components go
    double least_share = 0;  ///< of the largest component's area, in [0, 1]: 1 keeps that one alone
};

struct Islands {
    std::size_t components = 0; ///< removed
    Discarded facets;
};

/// Removes the components (facets joined by shared vertices) that are too small, with their vertices and
/// the hints of their sides. The largest by area always stays. O(facets).
Islands drop_islands(PolygonMesh& mesh, FeatureHints& hints, const IslandsOptions& options);

} // namespace hsdm
