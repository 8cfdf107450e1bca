#include "hsdm/contour/grid_points.hh"

#include "hsdm/core/chunks.hh"
#include "hsdm/core/large_vector.hh"
#include "hsdm/core/parallel_sort.hh"

#include <algorithm>
#include <bit>

namespace hsdm {
namespace {

constexpr std::array<Index, 8> no_voxels{no_index, no_index, no_index, no_index,
                                         no_index, no_index, no_index, no_index};

/// Codes that agree in all but their last six bits: a block of 4 x 4 x 4 voxels or grid points.
constexpr MortonCode per_block = MortonIndex::cells;

/// Where the corners of a block's voxels lie: a voxel at c has its corners at c + 1 and c + 2, as grid points
/// count (GridPoints::code), so in the block of grid points with the same number or the next up some axes.
struct CornerPlace {
    std::uint8_t block; ///< bit k is set in the next block up axis k
    std::uint8_t point; ///< the last six bits of the code
};

/// Per voxel of a block and corner; bit k of `corner` is set on the upper side of axis k.
constexpr std::array<std::array<CornerPlace, 8>, per_block> corner_places = [] {
    std::array<std::array<CornerPlace, 8>, per_block> places{};
    for (MortonCode voxel = 0; voxel < per_block; ++voxel)
        for (unsigned corner = 0; corner < 8; ++corner) {
            VoxelCoord c = morton_decode(voxel);
            unsigned block = 0;
            for (unsigned k = 0; k < 3; ++k) {
                c[k] += 1 + static_cast<int>(corner >> k & 1u);
                block |= unsigned{c[k] >= 4} << k;
                c[k] %= 4;
            }
            places[voxel][corner] = {static_cast<std::uint8_t>(block),
                                     static_cast<std::uint8_t>(morton_encode(c))};
        }
    return places;
}();

/// The numbers of the eight blocks of grid points that a block of voxels has corners in.
std::array<MortonCode, 8> blocks_of_corners(MortonCode block) {
    std::array<MortonCode, 8> blocks;
    for (unsigned k = 0; k < 8; ++k) {
        blocks[k] = block;
        for (unsigned axis = 0; axis < 3; ++axis)
            if (k >> axis & 1u) blocks[k] = morton_up(blocks[k], axis);
    }
    return blocks;
}

/// Calls each(block, begin, end, chunk) per block with the range of its codes; a block that straddles two
/// chunks comes in two calls.
template <class Each>
void for_blocks(const std::vector<MortonCode>& codes, Each each) {
    for_chunks(codes.size(), chunks::usual, [&](std::size_t begin, std::size_t end, std::size_t chunk) {
        for (std::size_t first = begin, i = begin; i < end; ++i) {
            const MortonCode block = codes[i] / per_block;
            if (i + 1 < end && codes[i + 1] / per_block == block) continue;
            each(block, first, i + 1, chunk);
            first = i + 1;
        }
    });
}

/// Room for those that add_grid_points adds to so many, which are few: else all would be copied.
std::size_t with_added(std::size_t built) {
    return built + built / 16;
}

/// A block of grid points, and a bit for each of those that there are.
struct UsedPoints {
    MortonCode block;
    std::uint64_t used;
};

/// The blocks that have any, ascending.
std::vector<UsedPoints> used_points(const OctreeLevel& level) {
    std::vector<std::vector<UsedPoints>> parts(chunk_count(level.size(), chunks::usual));
    for_blocks(level.codes, [&](MortonCode block, std::size_t begin, std::size_t end, std::size_t chunk) {
        std::array<std::uint64_t, 8> used{};
        for (std::size_t v = begin; v < end; ++v)
            for (const CornerPlace& place : corner_places[level.codes[v] % per_block])
                used[place.block] |= std::uint64_t{1} << place.point;
        const std::array<MortonCode, 8> blocks = blocks_of_corners(block);
        for (unsigned k = 0; k < 8; ++k)
            if (used[k] != 0) parts[chunk].push_back({blocks[k], used[k]});
    });
    std::vector<UsedPoints> points = joined(parts);
    parallel_sort(points, [](const UsedPoints& a, const UsedPoints& b) { return a.block < b.block; });
    std::size_t kept = 0;
    for_each_in_order(points.size(), [&](std::size_t i) {
        if (kept > 0 && points[kept - 1].block == points[i].block)
            points[kept - 1].used |= points[i].used;
        else
            points[kept++] = points[i];
    });
    points.resize(kept);
    return points;
}

/// Every corner of every voxel, ascending, each once.
std::vector<MortonCode> grid_point_codes(const OctreeLevel& level) {
    const std::vector<UsedPoints> points = used_points(level);
    std::size_t count = 0;
    for (const UsedPoints& of_block : points) count += MortonIndex::count_bits(of_block.used);
    std::vector<MortonCode> codes;
    reserve_large(codes, with_added(count));
    for (const auto& [block, used] : points)
        for (std::uint64_t left = used; left != 0; left &= left - 1)
            codes.push_back(block * per_block + static_cast<unsigned>(std::countr_zero(left)));
    return codes;
}

/// Enters each voxel at its eight corners.
void connect_voxels(const OctreeLevel& level, GridPoints& grid) {
    reserve_large(grid.voxels, with_added(grid.size()));
    resize_large(grid.voxels, grid.size(), no_voxels);
    const MortonIndex& index = grid.parts.front().index;
    for_blocks(level.codes, [&](MortonCode block, std::size_t begin, std::size_t end, std::size_t) {
        std::array<const MortonIndex::Block*, 8> blocks;
        std::ranges::transform(blocks_of_corners(block), blocks.begin(),
                               [&](MortonCode number) { return &index.block_at(number); });
        for (std::size_t v = begin; v < end; ++v)
            for (unsigned k = 0; k < 8; ++k) {
                const CornerPlace& place = corner_places[level.codes[v] % per_block][k];
                grid.voxels[blocks[place.block]->find(place.point)][7 - k] = static_cast<Index>(v);
            }
    });
}

void connect_grid_point(GridPoints& grid, std::size_t i) {
    for (unsigned axis = 0; axis < 3; ++axis) grid.next[i][axis] = grid.find(morton_up(grid.codes[i], axis));
}

/// Enters for each grid point the next ones: all are of one part, in the same block or the next up the axis.
void connect_grid_points(GridPoints& grid) {
    reserve_large(grid.next, with_added(grid.size()));
    resize_unwritten(grid.next, grid.size());
    const MortonIndex& index = grid.parts.front().index;
    for_blocks(grid.codes, [&](MortonCode block, std::size_t begin, std::size_t end, std::size_t) {
        const MortonIndex::Block& own = index.block_at(block);
        for (unsigned axis = 0; axis < 3; ++axis) {
            const MortonIndex::Block& above = index.block_at(morton_up(block, axis));
            for (std::size_t i = begin; i < end; ++i) {
                const MortonCode up = morton_up(grid.codes[i], axis);
                grid.next[i][axis] = (up / per_block == block ? own : above).find(up);
            }
        }
    });
}

} // namespace

std::vector<std::array<Index, 3>> grid_points_below(const GridPoints& grid) {
    std::vector<std::array<Index, 3>> below =
        large_vector<std::array<Index, 3>>(grid.size(), {no_index, no_index, no_index});
    for_each_index(grid.size(), chunks::usual, [&](Index c) {
        for (unsigned axis = 0; axis < 3; ++axis)
            if (const Index next = grid.next[c][axis]; next != no_index) below[next][axis] = c;
    });
    return below;
}

GridPoints build_grid_points(const OctreeLevel& level) {
    GridPoints grid;
    grid.codes = grid_point_codes(level);
    grid.add_part(0);
    connect_voxels(level, grid);
    connect_grid_points(grid);
    return grid;
}

void add_grid_points(GridPoints& grid, std::span<const MortonCode> codes) {
    const std::size_t n = grid.size();
    reserve_large(grid.codes, n + codes.size());
    grid.codes.insert(grid.codes.end(), codes.begin(), codes.end());
    grid.add_part(static_cast<Index>(n));
    resize_large(grid.voxels, grid.size(), no_voxels);
    resize_unwritten(grid.next, grid.size());
    for_chunks(codes.size(), chunks::usual, [&](std::size_t begin, std::size_t end, std::size_t) {
        for (std::size_t i = n + begin; i < n + end; ++i) {
            connect_grid_point(grid, i);
            const VoxelCoord c = morton_decode(grid.codes[i]);
            for (unsigned axis = 0; axis < 3; ++axis) {
                if (c[axis] == 0) continue;
                // Added grid points set their own `next`.
                const Index point = grid.find(morton_down(grid.codes[i], axis));
                if (point < n) grid.next[point][axis] = static_cast<Index>(i);
            }
        }
    });
}

} // namespace hsdm
