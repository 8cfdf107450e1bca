#pragma once
// Section 3.4.2: where the sheets cross the grid edges. A crossing is what a facet is dual to. See
// docs/sheets.md.

#include "hsdm/contour/constants.hh"
#include "hsdm/contour/facet_corner.hh"
#include "hsdm/contour/local_sheets.hh"

namespace hsdm {

struct CrossingOptions {
    /// Points. A voxel beside a crossed edge that holds no point of the sheet counts as a sliver that the
    /// sampling missed if fewer points than this are expected in it. If more are expected, the surface ends
    /// there and the facet is left out.
    double sliver_points = crossing::sliver_points;
};

/// A sheet crossing a grid edge.
struct Crossing {
    double t;       ///< position along the edge, [0, 1] from its lower grid point
    Vec3 normal;    ///< unit normal of the sheet there, or of its face at a blunt crease
    Index edge;     ///< 3 * lower grid point + axis
    Index set;      ///< the sheet's set nearest to the crossing
    bool leaving;   ///< the lower grid point is inside, the upper one outside
    bool supported; ///< do the data carry the sheet into all four voxels beside the edge, slivers apart?
    bool by_crease = false; ///< is it on one face of a blunt crease near by?
    /// Of a candidate: is it clipped by no crease partner, and either carried by the data or has the sheet
    /// points beside the edge?
    bool standing = true;
    /// Of a candidate, from 0 to 1: that it does not stand; less than 1 where it is clipped by less than
    /// sheets::surface_error().
    float sureness = 1;
};

/// The crossings of every grid edge: those of edge e are crossings[first[e]] .. crossings[first[e + 1]], by
/// ascending t.
struct Crossings {
    std::vector<Crossing> crossings;
    std::vector<Index> first{0};
    /// The edges with a grid point off its place, ascending: how far both ends are, in voxels.
    struct MovedEdge {
        Index edge;
        std::array<Vec3, 2> ends;
    };
    std::vector<MovedEdge> moved;
    std::size_t dropped_beyond_crease = 0; ///< clipped by the sheet's crease partner
    std::size_t settled = 0;               ///< crossings dropped, restored or invented (label_grid_signs)
    std::size_t trimmed = 0;               ///< dropped beyond the end of the data (trim_unsupported)
    /// pairs of crossings dropped because only the tip of a corner made them (drop_tips)
    std::size_t tips = 0;

    /// The crossing that a facet is dual to.
    const Crossing& of(FacetCorner corner) const { return crossings[corner.crossing()]; }
    bool is_moved(Index edge) const {
        return !moved.empty() && std::ranges::binary_search(moved, edge, {}, &MovedEdge::edge);
    }
    /// How far a crossing is off the place that its edge would have, in voxels.
    Vec3 offset_of(const Crossing& crossing) const {
        if (moved.empty()) return {0, 0, 0};
        const auto it = std::ranges::lower_bound(moved, crossing.edge, {}, &MovedEdge::edge);
        if (it == moved.end() || it->edge != crossing.edge) return {0, 0, 0};
        return (1 - crossing.t) * it->ends[0] + crossing.t * it->ends[1];
    }
    std::span<const Crossing> on_edge(Index e) const {
        return {crossings.data() + first[e], crossings.data() + first[e + 1]};
    }
};

/// Every crossing that some sheet has, as candidates. O(grid points), parallel.
Crossings find_crossings(const GridPoints& grid, const LocalSheets& sheets, const NormalSets& sets,
                         const RelationTest& related, double voxel_size, const CrossingOptions& options = {});

/// From the lower end of an edge to its upper one, which must be there.
Vec3 edge_vector(const GridPoints& grid, Index edge, double voxel_size);

/// Where a crossing lies, relative to the octree's origin.
Vec3 crossing_position(const GridPoints& grid, const Crossing& crossing, double voxel_size);

} // namespace hsdm
