#pragma once
// Splinters: a few facets on their own beside a surface of many.

#include "hsdm/polygon_mesh.hh"

namespace hsdm {

struct DebrisOptions {
    std::size_t most_facets = 12; ///< six quads round one grid point, cut in two; more are a part
    double least_ratio = 64;      ///< of the facets of the largest component to those of debris
};

/// Removes the components (facets joined by shared vertices) that are debris beside the largest one, vertices
/// stay. Returns the number of facets removed. O(facets).
std::size_t drop_debris(PolygonMesh& mesh, const DebrisOptions& options = {});

} // namespace hsdm
