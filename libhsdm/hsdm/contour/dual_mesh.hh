#pragma once
// The dual mesh: what dual vertices are placed and facets are made from.

#include "hsdm/contour/dual_vertices.hh"

namespace hsdm {

struct DualMesh {
    GridPoints grid;     ///< until vertices are placed
    Crossings crossings; ///< each is dual to a facet; by edge until vertices are placed
    Links links;         ///< per side of a facet, its twin
    DualVertices duals;  ///< the vertices, each with the facet corners round it in order
    double voxel_size = 0;

    /// Where the crossing lies that a facet is dual to, relative to the octree's origin.
    Vec3 crossing_position_of(FacetCorner corner) const {
        return crossing_position_of(corner, duals.from(corner));
    }
    /// The same, given the corner's dual vertex.
    Vec3 crossing_position_of(FacetCorner corner, Index dual) const {
        const Crossing& crossing = crossings.of(corner);
        const unsigned axis = crossing.edge % 3, octant = corner.octant(axis);
        Vec3 p;
        for (unsigned k = 0; k < 3; ++k)
            p[k] = voxel_of(dual)[k] + (octant >> k & 1u ? 0 : 1); // of the edge's lower grid point
        p[axis] += crossing.t;
        if (!crossings.moved.empty()) p += crossings.offset_of(crossing);
        return p * voxel_size;
    }
    /// Is a grid point round one of the dual vertex's crossings off its place (move_to_bar_lines)?
    bool is_moved(Index dual) const {
        if (crossings.moved.empty()) return false;
        const auto corners = duals.corners_of(dual);
        return std::ranges::any_of(
            corners, [&](FacetCorner corner) { return crossings.is_moved(crossings.of(corner).edge); });
    }
    /// Grows the bounds of such a dual vertex's voxel so that they hold its crossings.
    void include_crossings(Index dual, Vec3& lo, Vec3& hi) const {
        duals.for_each_corner(dual, [&](FacetCorner corner) {
            const Vec3 p = crossing_position_of(corner, dual);
            lo.minimize(p), hi.maximize(p);
        });
    }
    /// Integer coordinates of the voxel whose chain of crossings the dual vertex is.
    const VoxelCoord& voxel_of(Index dual) const { return duals.voxels[dual].coord; }
};

} // namespace hsdm
