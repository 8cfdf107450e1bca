#pragma once
// Section 3.4.2, where a vertex lies: on its sheet, or where the sheets of a crease or a corner meet.

#include "hsdm/contour/dual_vertices.hh"
#include "hsdm/mesh/vertex_class.hh"

namespace hsdm {

struct PlacedVertices {
    std::vector<Vec3> positions;      ///< per dual vertex, relative to the octree's origin
    std::vector<VertexClass> classes; ///< per dual vertex, known from the number of sheets that meet
    /// Per dual vertex: of a smooth vertex the sheet's unit normal, of an edge vertex a unit vector along the
    /// crease.
    std::vector<Vec3> directions;
    std::vector<Index>
        voxel; ///< per dual vertex, its voxel; where no point lies in it, that of the nearest set
    std::vector<std::uint8_t>
        is_clamped;          ///< per dual vertex, kept in its voxel although its planes meet outside
    std::size_t clamped = 0; ///< how many are
    /// Corners of three sheets that would lie in the next voxel; their vertices are kept in their own.
    struct Beyond {
        Index dual;
        Vec3 position;
        std::array<Vec3, 3> normals; ///< of the three sheets
        VoxelCoord step;             ///< to the voxel it lies in
        std::uint8_t crossed; ///< bit w: the voxel along the axes of w only has an edge crossed by the sheets
    };
    std::vector<Beyond> beyond; ///< by ascending dual vertex
    /// Clamped vertices, and where their two sheets meet, up to a quarter of a voxel outside.
    struct OnCrease {
        Index dual;
        Vec3 position;
        std::array<Vec3, 2> normals; ///< of the two sheets
    };
    std::vector<OnCrease> on_creases; ///< by ascending dual vertex
};

/// Least squares over the planes of the dual vertex's crossings and of the voxel's own sets, towards their
/// mean point, with as many directions as sheets meet (one, two, three). Inside the voxel, or up to half a
/// voxel beyond where no vertex of the same sheets can be; else kept in it. O(crossings), parallel.
PlacedVertices place_vertices(const OctreeLevel& level, const GridPoints& grid, const NormalSets& sets,
                              const RelationTest& related, const Crossings& crossings,
                              const DualVertices& duals);

/// The sides of a thin part cut apart in one voxel may end on the same point, and the facets between them
/// would have no area: such neighbours move apart, each along its own sheet's normal. O(chains cut).
void separate_sides(const Crossings& crossings, const DualVertices& duals, double voxel_size,
                    std::vector<Vec3>& positions);

} // namespace hsdm
