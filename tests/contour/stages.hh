#pragma once
// The stages of the extended method one by one, for tests of what comes in between.

#include "hsdm/contour/place_vertices.hh"
#include "support/sample.hh"

namespace hsdm::support {

/// The intermediate results of dual_contour for a cloud, with nothing trimmed.
struct Stages : DualMesh {
    Octree octree;
    OctreeLevel level;
    NormalSets sets;
    RelationTest related;
    PlacedVertices vertices;

    Stages(const PointCloud& cloud, int depth, double cube_extent = 0);
    Stages(const Solid& solid, std::size_t points, int depth);

    /// Anew from the crossings as they are now.
    void pair();
    /// ... and from the links.
    void place();
    /// Ends the surface where the data end, and places its vertices anew.
    void trim();

    double h() const { return voxel_size; }
    /// Box of the voxel that a corner of a facet lies in, relative to the octree's origin.
    Box voxel_of(FacetCorner corner) const;
};

/// Without those that are marked, per crossing.
Crossings without(const Crossings& crossings, const std::vector<std::uint8_t>& marked);

/// Sides without a twin: the boundary half-edges of the mesh.
std::size_t open_sides(const Links& links);
/// Sides of the pairs that join opposite sheets, two each.
std::size_t rim_sides(const Links& links);

/// Points in a square grid over [0, 1] * [0, width] at height z, facing up; the octree's origin is kept at 0
/// by a point without a normal, which no sheet has.
PointCloud flat_sheet(int points_along, double width, double z);

/// Points and normals anyhow: no surface, but whatever sheets and crossings may do to each other.
PointCloud random_cloud(std::size_t points, std::uint64_t seed);

} // namespace hsdm::support
