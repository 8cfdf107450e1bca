#pragma once
// Where a surface bends one way only: cylinders, cones and all that is extruded.

#include "hsdm/simplify/facet_field.hh"

namespace hsdm {

/// An axis to which normals have one angle.
struct Axis {
    Vec3 direction{0, 0, 0}; ///< unit
    double cosine = 0;       ///< of the angle: 0 for cylinders
    double deviation = 0;    ///< root mean square deviation of the normals' cosines from that
};

/// Connected facets whose normals have an axis, all of them convex or all concave.
struct DevelopableRegion {
    std::vector<Index> facets;
    Axis axis;
    bool convex = true;
};

/// Regions of 60 facets or more among those with `taken` no_index, grown from where the surface bends most
/// clearly one way. Along a cylinder normals are perpendicular to its axis, along a cone at one angle to it.
/// O(n log n).
std::vector<DevelopableRegion> find_developable_regions(const FacetField& field,
                                                        const std::vector<Index>& taken);

} // namespace hsdm
