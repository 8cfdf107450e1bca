#pragma once
// Sections 3.4.1 and 3.4.2 on an adaptive grid: the smallest mesh, leaf by leaf of a balanced octree, that
// keeps an error. See docs/adaptive.md.

#include "hsdm/quality/distance.hh"
#include "hsdm/simplify/cell_tree.hh"
#include "hsdm/simplify/constants.hh"
#include "hsdm/spatial/facet_cells.hh"

namespace hsdm {

struct SimplifyOptions {
    /// The mesh's units, > 0: how far the coarse surface may lie from the fine one, and points from it.
    double max_error = 0;
    /// of looking for what is wrong and subdividing there, >= 1
    int rounds = bounds::rounds;
    bool measure = true; ///< else `to_fine` stays zero
};

struct AdaptiveMesh {
    PolygonMesh mesh; ///< an oriented 2-manifold with the fine one's topology
    /// Per fine vertex, the vertex that its leaf's became; no_index where one of another leaf is nearer to
    /// that.
    std::vector<Index> vertex;
    std::vector<std::uint8_t> level;           ///< per vertex, the level of its leaf
    std::vector<std::size_t> leaves_per_level; ///< 0 to depth
    std::size_t balance_splits = 0;            ///< cells subdivided to balance the octree
    std::size_t topology_splits = 0;           ///< ... because the surface would not have been a 2-manifold
    std::size_t error_splits = 0;              ///< ... because the error was too large
    std::size_t intersection_splits = 0;       ///< ... because facets intersected
    std::size_t merged = 0;                    ///< vertices that others stand for, beyond their leaves
    std::size_t points_beyond = 0;             ///< points farther than max_error from the result
    std::size_t unreachable = 0;               ///< of these, so far from the fine mesh already: all of them
    Distance to_fine;                          ///< of points spread over the mesh, from the fine one
};

/// Puts one vertex for each piece of a fine mesh in each leaf of a balanced octree. Edges between cells stay
/// edges, so where leaves of different size meet there are neither cracks nor T-vertices; at the end vertices
/// merge where fewer do (decimate). The octree is
/// subdivided until nothing is wrong: facets a 2-manifold, no intersections the fine mesh has not, points
/// within max_error of the result, fine vertices within twice that, and it within max_error of the fine mesh.
/// Facets are cut and joined anew where that suits their shape. If `rounds` or the cells do not suffice the
/// fine mesh itself comes out. `points` and the mesh are relative to the least corner of the cube, `extent`
/// is its edge, `depth` the level of the fine mesh. `cells`, of the fine mesh, if they are known, save time.
/// O(n log n). Throws OptionError.
AdaptiveMesh simplify(const PolygonMesh& fine, std::span<const Vec3> points, double extent, int depth,
                      const SimplifyOptions& options, const FacetCells* cells = nullptr);

} // namespace hsdm
