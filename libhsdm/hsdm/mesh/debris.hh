#pragma once
// Splinters: a few facets on their own beside a surface of many.

#include "hsdm/core/discarded.hh"
#include "hsdm/polygon_mesh.hh"

namespace hsdm {

struct DebrisOptions {
    std::size_t most_facets = 20; ///< ten quads round two grid points, cut in two; more are a part
    std::size_t most_open = 32;   ///< of a component with a border; more are a piece of the surface
    double least_ratio = 32;      ///< of the facets of the largest component to those of debris
};

/// Removes the components (facets joined by shared vertices) that are debris beside the largest one, vertices
/// stay. Returns the number of facets removed, and where. O(facets).
Discarded drop_debris(PolygonMesh& mesh, const DebrisOptions& options = {});

} // namespace hsdm
