#pragma once
// Section 3.2.1, step (2), Fig. 4: which of the voxels around a voxel are its neighbours on the surface.

#include "hsdm/types.hh"

#include <array>
#include <cstdint>

namespace hsdm {

/// The 18 voxels that share a face or an edge with a voxel, one bit each, in the order of neighbor_offsets:
///
///   bit  17 ......... 6  5 ....... 0
///        edge neighbours  face neighbours
using NeighborMask = std::uint32_t;
inline constexpr NeighborMask face_neighbors = 0x3f;
inline constexpr NeighborMask edge_neighbors = 0x3ffc0;
inline constexpr int neighbor_count = 18;

struct NeighborChoiceOptions {
    /// Neighbours sought per voxel, in [1, 18]. Edge neighbours are looked at only while face neighbours
    /// are fewer.
    int wanted = 4;
    /// Face neighbours kept at most, in [wanted, 6]. The paper does not say what happens to a fifth and a
    /// sixth; a surface oblique to the grid has voxels with six true ones (all faces of the voxel are
    /// crossed), so the default keeps them. 4 bounds the rank of every vertex as section 5 assumes.
    int max_face_neighbors = 6;
};

/// The face neighbours that an edge neighbour shares with the voxel: two faces meet in every edge.
NeighborMask adjacent_faces(int edge_neighbor);

/// Squared distance from a voxel's vertex to the vertex of each present neighbour.
using NeighborDistances = std::array<double, neighbor_count>;

/// The four-neighbour rule. Face neighbours come first; if `wanted` of them are present no more are sought.
/// Otherwise edge neighbours are chosen up to `wanted` in all, and only those next to none of the present
/// face neighbours: a voxel reached over a face neighbour is not reached a second time across the edge. So
/// some voxels end with three neighbours or fewer although others are present.
/// Where more qualify than are wanted the nearest vertices win, then the lower bit.
NeighborMask choose_neighbors(NeighborMask present, const NeighborDistances& distance,
                              const NeighborChoiceOptions& options = {});

} // namespace hsdm
