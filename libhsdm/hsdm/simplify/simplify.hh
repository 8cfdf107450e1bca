#pragma once
// Sections 3.4.1 and 3.4.2 on an adaptive grid: as few facets as possible, built over the leaves of a
// balanced octree, within an error bound. See docs/adaptive.md.

#include "hsdm/core/constants.hh"
#include "hsdm/quality/distance.hh"
#include "hsdm/simplify/cell_tree.hh"
#include "hsdm/simplify/constants.hh"
#include "hsdm/spatial/facet_cells.hh"

namespace hsdm {

struct SimplifyOptions {
    /// The mesh's units, > 0: how far the coarse surface may lie from the fine one, and points from it.
    double max_error = 0;
    /// rounds of looking for faults and subdividing leaves there, and in each step of decimation of undoing
    /// collapses, >= 1
    int rounds = enough_rounds;
    bool measure = true; ///< else `to_fine` stays zero
};

struct AdaptiveMesh {
    PolygonMesh mesh; ///< an oriented 2-manifold with the fine one's topology
    /// Per fine vertex, the vertex of the result that stands for its leaf's vertex; no_index if that has
    /// merged and another leaf's vertex was nearer to the result's (each vertex keeps its nearest leaf only).
    std::vector<Index> vertex;
    std::vector<std::uint8_t> level;           ///< per vertex, the level of its leaf
    std::vector<std::size_t> leaves_per_level; ///< 0 to depth
    std::size_t balance_splits = 0;            ///< cells subdivided to balance the octree
    std::size_t topology_splits = 0;           ///< ... because the surface would not have been a 2-manifold
    std::size_t error_splits = 0;              ///< ... because the error was too large
    std::size_t intersection_splits = 0;       ///< ... because facets intersected
    std::size_t merged = 0;                    ///< vertices of leaves that were merged into others (decimate)
    std::size_t points_beyond = 0;             ///< points farther than max_error from the result
    /// of points_beyond, those that the fine mesh misses too: all of them
    std::size_t unreachable = 0;
    Index first_unreachable = no_index; ///< one of these
    std::size_t intersecting = 0;       ///< pairs of facets of the result that pass through each other
    Distance to_fine;                   ///< distance of points spread over the mesh from the fine one
};

/// Puts one vertex for each piece of a fine mesh in each leaf of a balanced octree. Edges between cells stay
/// edges, so there are neither cracks nor T-vertices where leaves of different size meet. Subdivides leaves
/// until there are no faults: facets form a 2-manifold and have no intersections that the fine mesh has not,
/// points lie within max_error of the result, fine vertices within twice that, and the result within
/// max_error of the fine mesh. Facets are remeshed by flips for their shape; at the end vertices merge where
/// fewer do (decimate). If `rounds` or the cells do not suffice the fine mesh itself comes out. `points` and
/// the mesh are relative to the least corner of the cube, `extent` is its edge, `depth` the level of the fine
/// mesh. `cells`, those of the fine mesh, save time if they are known. O(n log n). Throws OptionError.
AdaptiveMesh simplify(const PolygonMesh& fine, std::span<const Vec3> points, double extent, int depth,
                      const SimplifyOptions& options, const FacetCells* cells = nullptr);

} // namespace hsdm
