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
    /// Integer coordinates of the voxel whose chain of crossings the dual vertex is.
    const VoxelCoord& voxel_of(Index dual) const { return duals.voxels[dual].coord; }
};

} // namespace hsdm
