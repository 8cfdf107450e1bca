#pragma once
// The dual mesh: what dual vertices are placed and facets are made from.

#include "hsdm/contour/dual_vertices.hh"

namespace hsdm {

struct DualMesh {
    GridPoints grid;
    Crossings crossings; ///< each has a facet
    Links links;         ///< the twins of the facets' sides
    DualVertices duals;  ///< and the corners of facets round each
    double voxel_size = 0;

    /// Where the crossing lies that a facet is dual to, relative to the octree's origin.
    Vec3 crossing_of(FacetCorner corner) const {
        return crossing_position(grid, crossings.of(corner), voxel_size);
    }
    /// The voxel that a dual vertex stands for, in voxels; its facets meet there.
    VoxelCoord voxel_of(Index dual) const {
        return CornerVoxel(grid, crossings, duals.corners_of(dual)[0]).coord;
    }
};

} // namespace hsdm
