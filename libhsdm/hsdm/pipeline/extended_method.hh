#pragma once
// Phase 2 by the extended method, section 3.4.2: graph and facets from normal-consistent sets.

#include "hsdm/mesh/facet_links.hh"
#include "hsdm/mesh/feature_hints.hh"
#include "hsdm/pipeline/basic_method.hh"
#include "hsdm/spatial/facet_cells.hh"

#include <optional>

namespace hsdm {

/// What is known of facets beside themselves, as long as they stay as they are.
struct FacetKnowledge {
    FeatureHints hints;
    std::optional<FacetLinks> links;
    std::optional<FacetCells> cells; ///< the voxels
};

/// Facets relative to the octree's origin, an oriented 2-manifold with the vertices' properties. The octree
/// must have normals. Adds its seconds (graph, facets) and what each stage counted to the report. Fills in
/// what of `known` it comes to know. Throws Cancelled.
PolygonMesh extended_method(const MethodInput& input, Report& report, FacetKnowledge& known);

} // namespace hsdm
