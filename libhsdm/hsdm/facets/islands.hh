#pragma once
// Small components, dropped when asked.

#include "hsdm/discarded.hh"
#include "hsdm/features/feature_hints.hh"
#include "hsdm/polygon_mesh.hh"

namespace hsdm {

/// How small a component may be: of fewer facets, or of less than a share of the area of the largest one.
struct MinComponent {
    double value = 0;        ///< facets, >= 0; or a share in [0, 1]: 1 keeps the largest component alone
    bool of_largest = false; ///< a share of the largest component's area, else a number of facets
};

struct Islands {
    std::size_t components = 0; ///< removed
    Discarded facets;
};

/// Removes the components (facets joined by shared vertices) smaller than `least`, with their vertices and
/// the hints of their sides. The largest by area always stays. O(facets).
Islands drop_islands(PolygonMesh& mesh, FeatureHints& hints, const MinComponent& least);

} // namespace hsdm
