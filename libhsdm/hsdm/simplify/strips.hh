#pragma once
// Cuts developable regions into strips, which become rows of facets.

#include "hsdm/simplify/developable_regions.hh"
#include "hsdm/simplify/quadric.hh"

#include <optional>

namespace hsdm {

/// A region cut along its rulings (straight lines on it) into strips with a plane each.
struct Strips {
    std::vector<Index> of; ///< per facet of the region, its strip
    std::vector<Plane> planes;
};

/// Cuts a region to as few strips as keep within `tolerance` of their planes (the mesh's units, > 0), each
/// spanning about the same height across its plane; none if strips would be too narrow for the facets to
/// resolve. The surface bulges to either side of a plane by the same amount, and strips meet where their
/// planes do. O(n) for each number of strips tried, a few.
std::optional<Strips> cut_to_strips(const FacetField& field, const DevelopableRegion& region,
                                    double tolerance);

} // namespace hsdm
