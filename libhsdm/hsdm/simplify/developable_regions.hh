#pragma once
// Where a surface bends one way only: cylinders, cones and all that is extruded.

#include "hsdm/simplify/facet_field.hh"

namespace hsdm {

/// Normals at one angle to a direction.
struct Axis {
    Vec3 direction{0, 0, 0}; ///< unit
    double cosine = 0;       ///< of the angle: 0 for cylinders
    double deviation = 0;    ///< of the normals' cosines from that, root mean square
};

/// Connected facets, all convex or none, whose normals have an axis.
struct DevelopableRegion {
    std::vector<Index> facets;
    Axis axis;
    bool convex = true;
};

/// Belts of 60 facets and more among those with `taken` no_index, from where the surface bends most clearly
/// one way: along a cylinder normals are perpendicular to its axis, along a cone at one angle to it. O(n log
/// n).
std::vector<DevelopableRegion> find_developable_regions(const FacetField& field,
                                                        const std::vector<Index>& taken);

} // namespace hsdm
