#pragma once
// Nearest neighbours of every point, found by the octree: no search structure of its own.

#include "hsdm/normals/constants.hh"
#include "hsdm/octree/octree.hh"

#include <array>
#include <optional>

namespace hsdm {

struct NeighborOptions {
    /// neighbours per point, [3, 64]; fewer where the cloud itself is smaller
    int count = neighborhoods::neighbors;
    /// finest level that points are searched on, if these are part of a larger cloud: finest_leaves() of that
    std::optional<int> finest_level{};
};

/// How many leaves of each level the points of these codes, ascending, are taken in.
std::array<std::size_t, morton_levels + 1> count_leaves(std::span<const MortonCode> codes);
/// The finest level that so many leaves of each are searched on: few of the finest are searched one above.
int finest_leaves(const std::array<std::size_t, morton_levels + 1>& leaves);

/// The neighbours of point i are index[i * count] .. index[(i + 1) * count - 1], without i, in an order by
/// place alone: voxel by voxel of those around, octree order in each. Sums over them are the same bits
/// wherever the points around are the same.
struct Neighbors {
    std::size_t count = 0;         ///< per point: min(options.count, points - 1)
    std::vector<Index> index;      ///< points x count, octree order
    std::vector<double> reach;     ///< per point: distance of the farthest of them, in the cloud's units
    std::vector<Index> leaf_first; ///< of all points: the leaves they were taken in: leaf l holds points
                                   ///< leaf_first[l] .. leaf_first[l + 1] - 1, of one voxel, a dozen at most
                                   ///< (more where the finest voxels hold more); empty if of some points
    std::vector<std::uint8_t> leaf_level; ///< per leaf: its points' neighbours are of the voxels within one
                                          ///< of its own of this level

    std::span<const Index> of(std::size_t point) const { return {index.data() + point * count, count}; }
};

/// Nearest neighbours, ties by octree order. Points are taken leaf by leaf (the largest voxels of at most a
/// dozen points) and searched in the 27 voxels around, at the finest level where these hold enough points
/// that the nearest are among them: exact on a surface that is sampled about evenly over the neighbourhood,
/// near enough elsewhere. Where hundreds of points share a voxel of the finest level (parts of a cloud too
/// far from each other for one octree), they are sought among some hundreds only. O(n) time and space,
/// parallel. Throws OptionError.
Neighbors find_neighbors(const Octree& octree, const NeighborOptions& options = {});

/// The same for the given points alone (ascending), in their order: `of(k)` and `reach[k]` are of points[k].
Neighbors find_neighbors_of(const Octree& octree, const std::vector<Index>& points,
                            const NeighborOptions& options = {});

} // namespace hsdm
