#pragma once
// Joined crossings form open or closed chains round each voxel; each chain is one mesh vertex. See
// docs/sheets.md.

#include "hsdm/contour/crossing_pairs.hh"
#include "hsdm/core/chunks.hh"

namespace hsdm {

/// The voxel of a facet corner, one of the four round its grid edge.
struct CornerVoxel {
    CornerVoxel() = default;
    CornerVoxel(const GridPoints& grid, const Crossings& crossings, FacetCorner corner);

    VoxelCoord coord;
    Index voxel; ///< or no_index, if no point lies in it
};

/// The vertices: dual vertex v has corners[first[v]] .. corners[first[v + 1]], in order around the vertex.
/// Where a chain is cut at a corner, that corner is the last of one dual vertex and the first of the next:
/// the facet gets two corners there, with an edge between.
struct DualVertices {
    std::vector<FacetCorner> corners;
    std::vector<Index> first{0};
    /// Two per corner c, alike but where a chain is cut there: [2 c] the dual vertex at which the side
    /// c.previous() ends, [2 c + 1] the one at which the side c starts.
    std::vector<Index> of_corner;
    /// Polygons between the three or more dual vertices of a closed chain that was cut at that many places
    /// (the sides of a thin part and its rims); each of their sides is the twin of one beside it.
    std::vector<std::vector<Index>> caps;
    std::vector<CornerVoxel> voxels; ///< per dual vertex, that of its corners
    std::vector<std::uint8_t> open;  ///< per dual vertex, is it at a border of the surface (an open chain)?
    /// Dual vertices v that come from the same cut chain, and so voxel, as v - 1.
    std::vector<Index> after_cut;

    /// The vertices that a side leads from and to.
    Index from(FacetSide side) const { return of_corner[2 * std::size_t{side.number()} + 1]; }
    Index to(FacetSide side) const { return of_corner[2 * std::size_t{side.next().number()}]; }
    /// ... in the lower and in the upper voxel.
    std::array<Index, 2> ends(FacetSide side) const {
        const std::array<Index, 2> ends{from(side), to(side)};
        return side.ascends() ? ends : std::array{ends[1], ends[0]};
    }

    /// Calls f(first, end) for the dual vertices of each chain: more than one where it was cut.
    template <class F>
    void for_each_chain(F&& f) const {
        auto cut = after_cut.begin();
        for_each_in_order(size(), [&](std::size_t v) {
            if (cut != after_cut.end() && *cut == v) {
                ++cut; // part of the chain that v - 1 is of
                return;
            }
            auto end = static_cast<Index>(v) + 1;
            for (auto next = cut; next != after_cut.end() && *next == end; ++next) ++end;
            f(static_cast<Index>(v), end);
        });
    }

    std::size_t size() const { return first.size() - 1; }
    std::span<const FacetCorner> corners_of(Index v) const {
        return {corners.data() + first[v], corners.data() + first[v + 1]};
    }
    /// Calls f(corner) for those of a vertex one way round, which is the same if all normals are turned.
    template <class F>
    void for_each_corner(Index v, F&& f) const {
        const std::span<const FacetCorner> all = corners_of(v);
        const bool forward = all.front() <= all.back();
        for (std::size_t i = 0; i < all.size(); ++i) f(all[forward ? i : all.size() - 1 - i]);
    }
};

/// Walks the chains. A chain that passes both sides of a thin part is cut between them, at a rim link or in a
/// facet of the rim's own face, so that each side has its own vertex; one that passes both edges of a narrow
/// face at a link over it or in a facet of it. O(crossings), parallel.
DualVertices build_dual_vertices(const GridPoints& grid, const Crossings& crossings, const NormalSets& sets,
                                 double voxel_size, const Links& links);

} // namespace hsdm
