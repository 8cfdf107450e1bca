#include "hsdm/basic/neighbor_choice.hh"

#include "hsdm/octree/octree.hh"

#include <bit>

namespace hsdm {
namespace {

constexpr NeighborMask bit(int i) {
    return NeighborMask{1} << i;
}

/// The `count` nearest of the candidates; ties go to the lower bit.
NeighborMask nearest(NeighborMask candidates, int count, const NeighborDistances& distance) {
    NeighborMask chosen = 0;
    while (candidates != 0 && count-- > 0) {
        int best = std::countr_zero(candidates);
        for (NeighborMask rest = candidates & (candidates - 1); rest != 0; rest &= rest - 1) {
            const int i = std::countr_zero(rest);
            if (distance[static_cast<unsigned>(i)] < distance[static_cast<unsigned>(best)]) best = i;
        }
        chosen |= bit(best);
        candidates &= ~bit(best);
    }
    return chosen;
}

/// Per edge neighbour, the two face neighbours whose offsets add up to its own.
std::array<NeighborMask, neighbor_count> make_adjacent_faces() {
    std::array<NeighborMask, neighbor_count> faces{};
    for (int e = 6; e < neighbor_count; ++e)
        for (int f = 0; f < 6; ++f) {
            const VoxelCoord& edge = neighbor_offsets[static_cast<unsigned>(e)];
            const VoxelCoord& face = neighbor_offsets[static_cast<unsigned>(f)];
            if (edge[0] * face[0] + edge[1] * face[1] + edge[2] * face[2] == 1)
                faces[static_cast<unsigned>(e)] |= bit(f);
        }
    return faces;
}

} // namespace

NeighborMask adjacent_faces(int edge_neighbor) {
    static const std::array<NeighborMask, neighbor_count> table = make_adjacent_faces();
    return table[static_cast<unsigned>(edge_neighbor)];
}

NeighborMask choose_neighbors(NeighborMask present, const NeighborDistances& distance,
                              const NeighborChoiceOptions& options) {
    const NeighborMask faces = present & face_neighbors;
    const int face_count = std::popcount(faces);
    if (face_count > options.max_face_neighbors) return nearest(faces, options.max_face_neighbors, distance);
    if (face_count >= options.wanted) return faces;

    NeighborMask free_edges = 0;
    for (NeighborMask rest = present & edge_neighbors; rest != 0; rest &= rest - 1) {
        const int e = std::countr_zero(rest);
        if ((adjacent_faces(e) & faces) == 0) free_edges |= bit(e);
    }
    return faces | nearest(free_edges, options.wanted - face_count, distance);
}

} // namespace hsdm
