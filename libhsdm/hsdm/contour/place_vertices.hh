#pragma once
// Section 3.4.2, where a vertex lies: on its sheet, or where the sheets of a crease or a corner meet.

#include "hsdm/contour/dual_mesh.hh"
#include "hsdm/mesh/vertex_class.hh"

namespace hsdm {

struct PlacedVertices {
    std::vector<Vec3> positions;      ///< per dual vertex, relative to the octree's origin
    std::vector<VertexClass> classes; ///< per dual vertex, known from the number of sheets that meet
    /// Per dual vertex, a unit vector: the sheet's normal at a smooth vertex, the crease's direction at an
    /// edge vertex.
    std::vector<Vec3> directions;
    std::vector<Index> voxel; ///< per dual vertex, its voxel, or that of the nearest set if its own is empty
    std::vector<std::uint8_t>
        is_clamped;          ///< per dual vertex: was it kept in its voxel although its planes meet outside?
    std::size_t clamped = 0; ///< how many are
    double misfit_placed = 0, misfit_moved = 0; ///< see relax_vertices(), of part of a whole
    /// A corner of three sheets that lies in the next voxel; the vertex itself was kept in its own.
    struct Beyond {
        Index dual;
        Vec3 position;
        std::array<Vec3, 3> normals; ///< of the three sheets
        VoxelCoord step;             ///< from the vertex's voxel to the one that the corner lies in
        /// Bit w, w a mask of axes from 1 to 7: does one of the vertex's sheets cross an edge of the voxel
        /// that `step` along the axes of w alone leads to? 0 if `step` is 0 along one of them.
        std::uint8_t crossed;
    };
    std::vector<Beyond> beyond; ///< by ascending dual vertex
    /// A clamped vertex, and the point up to a quarter of a voxel outside where its two sheets meet.
    struct OnCrease {
        Index dual;
        Vec3 position;
        std::array<Vec3, 2> normals; ///< of the two sheets
    };
    std::vector<OnCrease> on_creases; ///< by ascending dual vertex
    /// Voxels with points that stood out from the facets when these were fitted
    /// (PointFit::Measure::standing_out, reach_points).
    std::vector<Index> far;
};

/// Minimises the QEF of the planes of the dual vertex's crossings and of the voxel's own sets, solved for as
/// many directions as sheets, or faces of a blunt crease, meet (one, two, three); in the others the vertex
/// stays at the mean of the crossings. The minimiser may lie up to half a voxel outside the voxel where no
/// other vertex of the same sheets can be; otherwise the vertex is kept inside. O(crossings), parallel.
PlacedVertices place_vertices(const DualMesh& mesh, const NormalSets& sets, const RelationTest& related);

/// The two sides of a thin part that were cut apart in one voxel may come to lie at the same point; facets
/// between them would have no area. Moves such pairs apart, each vertex along the normal of its own sheet.
/// O(chains cut).
void separate_sides(const DualMesh& mesh, std::vector<Vec3>& positions);

} // namespace hsdm
