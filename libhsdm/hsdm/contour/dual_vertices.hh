#pragma once
// Crossings round each voxel form closed or open chains; each chain is one mesh vertex. See docs/sheets.md.

#include "hsdm/contour/crossing_pairs.hh"

namespace hsdm {

/// A crossing seen from the voxel at one position of its ring: 4 * crossing + position. One corner of one
/// facet.
using FacetCorner = std::uint32_t;

/// The vertices: dual vertex v is corners[first[v]] .. corners[first[v + 1]], in order around the vertex. A
/// corner at which a chain was cut ends one dual vertex and begins the next: its corner of the facet becomes
/// two, with an edge between.
struct DualVertices {
    std::vector<FacetCorner> corners;
    std::vector<Index> first{0};
    std::vector<Index>
        of_side; ///< per corner two: its dual vertex beside face j - 1 and beside face j of the ring
    /// Voxels where the two sides of a thin part and its rims leave a polygon between three or more dual
    /// vertices; it runs the other way than the facets beside it.
    std::vector<std::vector<Index>> caps;
    std::vector<std::uint8_t> open; ///< per dual vertex, does its chain end where the surface does?
    std::vector<Index>
        after_cut;       ///< dual vertices that were cut off the dual vertex before them, in the same voxel
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

/// The voxel that a corner is seen from, one of the four round its grid edge.
struct CornerVoxel {
    CornerVoxel(const GridPoints& grid, const Crossings& crossings, FacetCorner corner);

    VoxelCoord coord;
    Index voxel; ///< or no_index, if no point lies in it
};

/// Walks the chains. One that passes both sides of a thin part is cut between them, at rims and in the facets
/// of the rim's own face: its sides keep vertices of their own. O(crossings), parallel.
DualVertices build_dual_vertices(const GridPoints& grid, const Crossings& crossings, const Links& links);

} // namespace hsdm
