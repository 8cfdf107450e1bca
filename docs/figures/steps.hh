#pragma once
// The extended method step by step, all of it kept, and what a layer of voxels shows of it.

#include "figures.hh"

#include "hsdm/contour/grid_signs.hh"
#include "hsdm/contour/place_vertices.hh"
#include "hsdm/polygon_mesh.hh"
#include "support/sample.hh"

namespace hsdm::figures {

PointCloud scan(const support::Solid& solid, std::size_t points);

/// All steps from a cloud to the mesh. Lengths and positions as the steps have them: relative to the octree's
/// origin, not divided by the voxel.
struct Steps : DualMesh { // its crossings without those beyond the data and those of tips
    Octree octree;
    OctreeLevel level;
    NormalSets sets;
    RelationTest related;
    LocalSheets local;
    CrossingCandidates candidates;
    Crossings labelled; ///< as label_grid_signs returns them
    PlacedVertices placed;
    PolygonMesh mesh;                 ///< after all other steps too
    std::vector<VertexClass> classes; ///< per vertex of that

    Steps(const PointCloud& cloud, int depth);
    double h() const { return voxel_size; }
};

/// The finest mesh, as the adaptive grid takes it.
struct Fine {
    Octree octree;
    int depth;
    PolygonMesh mesh;

    Fine(const support::Solid& solid, std::size_t points, int deepest);
    double h() const { return octree.voxel_size(depth); }
};

enum class Side : std::uint8_t { unknown, inside, outside };

/// What one layer of voxels holds, seen along z, in voxels. Grid points and crossings are those of its lower
/// plane.
class Layer {
public:
    Layer(const Steps& steps, int z) : steps_(steps), z_(z) {}

    Vec2 flat(const Vec3& p) const { return Vec2(p[0], p[1]) / steps_.h(); }
    bool has_voxel(Index voxel) const { return steps_.level.coord(voxel)[2] == z_; }
    bool has_grid_point(Index c) const { return steps_.grid.coord(c)[2] == z_; }
    Vec2 grid_point(Index c) const;
    /// Crossings of x and y edges in the plane.
    bool has_crossing(const Crossing& x) const { return x.edge % 3 != 2 && has_grid_point(x.edge / 3); }
    Vec2 crossing(const Crossing& x) const { return flat(crossing_position(steps_.grid, x, steps_.h())); }
    /// Where the plane z = layer + height cuts a mesh, in the units of that.
    std::vector<std::array<Vec2, 2>> section(const PolygonMesh& mesh, double height = 0.5) const;

private:
    const Steps& steps_;
    int z_;
};

/// Where a plane of constant z cuts a mesh; lengths times `scale`.
std::vector<std::array<Vec2, 2>> section(const PolygonMesh& mesh, double z, double scale);

/// Per grid point its side, as the crossings have it: those at their ends first, then from one to the next.
std::vector<Side> sides_of(const Steps& steps);

/// A panel of `voxels` and the canvas around it, with room for a legend of this width on the right.
struct Figure {
    Canvas canvas;
    Panel panel;
    Vec2 legend;
};
Figure figure_of(const Vec2& lo, const Vec2& hi, double scale, double legend_width);

void draw_voxels(Canvas& canvas, const Panel& panel, const Steps& steps, const Layer& layer);
void draw_points(Canvas& canvas, const Panel& panel, const Steps& steps, const Layer& layer,
                 const std::string& fill = colour::grey);
void draw_section(Canvas& canvas, const Panel& panel, std::span<const std::array<Vec2, 2>> segments,
                  const Style& style);

} // namespace hsdm::figures
