#pragma once
// Rows of facets for what bends one way only.

#include "hsdm/simplify/developable_regions.hh"
#include "hsdm/simplify/quadric.hh"

#include <optional>

namespace hsdm {

/// A region cut along straight lines on it, rulings, into planes.
struct Strips {
    std::vector<Index> of; ///< per facet of the region
    std::vector<Plane> planes;
};

/// As few strips as keep within `tolerance` of their planes (the mesh's units, > 0), each spanning about as
/// much as the others; none if strips so narrow are not resolved by the facets. The surface bulges to either
/// side of a plane alike, and where neighbours' planes meet one takes over from the other. O(n) for each of a
/// few numbers of strips.
std::optional<Strips> cut_to_strips(const FacetField& field, const DevelopableRegion& region,
                                    double tolerance);

} // namespace hsdm
