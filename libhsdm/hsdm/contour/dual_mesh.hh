#pragma once
// The dual mesh: what dual vertices are placed and facets are made from.

#include "hsdm/contour/dual_vertices.hh"

namespace hsdm {

struct DualMesh {
    GridPoints grid;
    Crossings crossings; ///< each is dual to a facet
    Links links;         ///< per side of a facet, its twin
    DualVertices duals;  ///< the vertices, each with the facet corners round it in order
    double voxel_size = 0;

    /// Where the crossing lies that a facet is dual to, relative to the octree's origin.
    Vec3 crossing_position_of(FacetCorner corner) const {
        return crossing_position(grid, crossings.of(corner), voxel_size);
    }
    /// Integer coordinates of the voxel whose chain of crossings the dual vertex is.
    const VoxelCoord& voxel_of(Index dual) const { return duals.voxels[dual].coord; }
};

} // namespace hsdm
