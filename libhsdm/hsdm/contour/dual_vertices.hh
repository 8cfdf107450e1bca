#pragma once
// Joined crossings form open or closed chains round each voxel; each chain is one mesh vertex. See
// docs/sheets.md.

#include "hsdm/contour/crossing_pairs.hh"

namespace hsdm {

/// A crossing seen from one of its four voxels: 4 * crossing + ring position. This is one corner of one
/// facet.
using FacetCorner = std::uint32_t;

/// The vertices: dual vertex v has corners[first[v]] .. corners[first[v + 1]], in order around the vertex.
/// Where a chain is cut at a corner, that corner is the last of one dual vertex and the first of the next:
/// the facet gets two corners there, with an edge between.
struct DualVertices {
    std::vector<FacetCorner> corners;
    std::vector<Index> first{0};
    std::vector<Index>
        of_side; ///< per corner two: its dual vertex beside face j - 1 and beside face j of the ring
    /// Polygons between the three or more dual vertices of a closed chain that was cut at that many places
    /// (the sides of a thin part and its rims); against the facets beside.
    std::vector<std::vector<Index>> caps;
    std::vector<std::uint8_t> open; ///< per dual vertex, is it at a border of the surface (an open chain)?
    std::vector<Index>
        after_cut;       ///< dual vertices v that come from the same cut chain, and so voxel, as v - 1
    std::size_t cut = 0; ///< chains cut into two or more vertices

    /// The vertex of a crossing at position j of its ring, beside face k (k = j or j - 1).
    Index at(Index crossing, unsigned j, unsigned k) const {
        return of_side[8 * std::size_t{crossing} + 2 * j + (k == j)];
    }

    std::size_t size() const { return first.size() - 1; }
    std::span<const FacetCorner> corners_of(Index v) const {
        return {corners.data() + first[v], corners.data() + first[v + 1]};
    }
};

/// The voxel of a facet corner, one of the four round its grid edge.
struct CornerVoxel {
    CornerVoxel(const GridPoints& grid, const Crossings& crossings, FacetCorner corner);

    VoxelCoord coord;
    Index voxel; ///< or no_index, if no point lies in it
};

/// Walks the chains. A chain that passes both sides of a thin part is cut between them, at a rim link or in a
/// facet of the rim's own face, so that each side has its own vertex. O(crossings), parallel.
DualVertices build_dual_vertices(const GridPoints& grid, const Crossings& crossings, const Links& links);

} // namespace hsdm
