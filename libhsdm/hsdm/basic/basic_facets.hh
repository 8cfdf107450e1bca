#pragma once
// Section 3.2.2 put together: connectivity graph -> facets, for points without normals.

#include "hsdm/basic/minimal_loop.hh"
#include "hsdm/mesh/fill_holes.hh"
#include "hsdm/mesh/manifold.hh"

namespace hsdm {

struct BasicFacetOptions {
    /// Longest minimal loop taken as a facet, in edges, in [3, max_loop_edges]. Loops of five and more are
    /// looked for only where no triangle or quad fits.
    int max_loop_edges = 8;
    bool hit_test = true;            ///< reject candidates whose normal runs into a neighbouring voxel
    bool distance_criterion = false; ///< of several candidates, drop those farther from the close points
    /// of several candidates, take the outer one; if false, the first, as in the paper
    bool angle_comparison = true;
    bool split_large = true; ///< split facets of five and more corners into quads and triangles
    /// Boundary loops of at most so many edges are closed (hole elimination), >= 3; 0: none.
    int max_hole_edges = 16;
};

struct BasicFacets {
    PolygonMesh mesh; ///< absolute coordinates; a 2-manifold; closed components outward
    struct Counts {
        std::size_t short_loops = 0; ///< triangles and quads in the graph
        std::size_t hit_test = 0;    ///< candidates each test rejected
        std::size_t distance_criterion = 0;
        std::size_t angle_comparison = 0;
        std::size_t seeds = 0;        ///< facets that orientation was propagated from
        std::size_t split_facets = 0; ///< of five and more corners, split into quads and triangles
        ManifoldCounts manifold;
        FillHolesCounts holes;
    } counts;
};

/// Facets are laid one by one across the twins of those laid before (Fig. 5, 6), from one seed per component
/// of the graph, so orientation propagates through twins alone and no two normals are ever compared. A
/// half-edge carries at most one facet, and no facet covers another's reverse. O(n) time and space.
/// `properties` hold a value per vertex of the graph and come out on the mesh's vertices. Throws OptionError.
BasicFacets reconstruct_facets(const Octree& octree, const OctreeLevel& level, const ConnectivityGraph& graph,
                               const BasicFacetOptions& options = {},
                               std::vector<VertexProperty> properties = {});

} // namespace hsdm
