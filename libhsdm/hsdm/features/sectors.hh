#pragma once
// The facets around one vertex, cut into sectors: where one, two or three normals come from (Fig. 11).

#include "hsdm/mesh/vertex_normals.hh"
#include "hsdm/types.hh"

#include <span>

namespace hsdm {

/// A facet of the fan around a vertex. The fan is cyclic; a gap at the boundary is a cut like a sharp edge.
struct FanFacet {
    Vec3 normal;       ///< unit vector, or zero if the facet has no area
    double weight = 0; ///< its angle at the vertex
    bool cut = false;  ///< whether a sharp edge or a gap separates it from the facet before it
};

struct SectorNormals {
    int count = 0;                                                           ///< 0 if no facet has a normal
    NormalTriple<Vec3> normals{Vec3(0, 0, 0), Vec3(0, 0, 0), Vec3(0, 0, 0)}; ///< heaviest sector first
};

/// The mean normal of every sector between two cuts, weighted by angle; fewer than two cuts leave one sector.
/// Of more than three sectors the three with the largest angles stay. O(fan), allocates nothing.
SectorNormals sector_normals(std::span<const FanFacet> fan);

/// Section 3.3, Fig. 11: class of a vertex with this many sharp edges. `turn` is the angle in radians by
/// which the line of exactly two sharp edges turns. One sharp edge makes an edge vertex: a crease that ends
/// inside a smooth region, or runs into the boundary.
VertexClass vertex_class(int sharp_edges, double turn, double corner_angle);

} // namespace hsdm
