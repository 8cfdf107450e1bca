#include "hsdm/contour/grid_points.hh"

#include "hsdm/core/chunks.hh"
#include "hsdm/core/large_vector.hh"
#include "hsdm/core/radix_sort.hh"

#include <bitset>

namespace hsdm {
namespace {

constexpr std::array<Index, 8> no_voxels{no_index, no_index, no_index, no_index,
                                         no_index, no_index, no_index, no_index};

/// The corners of the voxels in one block of 4 x 4 x 4, each once: neighbouring voxels share most of theirs.
class BlockGridPoints {
public:
    static constexpr MortonCode voxels = 64;
    /// Index of a voxel's corner in the block's 5 x 5 x 5 grid; bit k of `corner` is set on the upper side of
    /// axis k.
    static std::size_t place(MortonCode voxel, unsigned corner) {
        const VoxelCoord c = morton_decode(voxel & (voxels - 1));
        const int x = c[0] + static_cast<int>(corner & 1), y = c[1] + static_cast<int>(corner >> 1 & 1),
                  z = c[2] + static_cast<int>(corner >> 2);
        return static_cast<std::size_t>(x) + 5 * static_cast<std::size_t>(y)
               + 25 * static_cast<std::size_t>(z);
    }

    void add(MortonCode voxel) {
        for (unsigned corner = 0; corner < 8; ++corner) used_.set(place(voxel, corner));
    }
    /// Calls each(place, code) for the corners of the voxels added, then clears the block.
    template <class Each>
    void take(MortonCode block, Each each) {
        const VoxelCoord c = morton_decode(block * voxels);
        for (int i = 0; i < 125; ++i)
            if (used_[static_cast<std::size_t>(i)])
                each(i, GridPoints::code({c[0] + i % 5, c[1] + i / 5 % 5, c[2] + i / 25}));
        used_.reset();
    }

private:
    std::bitset<125> used_;
};

/// Calls each(points, block, begin, end, chunk) per block with the range of its voxels; a block that
/// straddles two chunks comes in two calls.
template <class Each>
void for_blocks(const OctreeLevel& level, Each each) {
    for_chunks(level.size(), chunks::usual, [&](std::size_t begin, std::size_t end, std::size_t chunk) {
        BlockGridPoints points;
        for (std::size_t first = begin, v = begin; v < end; ++v) {
            const MortonCode block = level.codes[v] / BlockGridPoints::voxels;
            points.add(level.codes[v]);
            if (v + 1 < end && level.codes[v + 1] / BlockGridPoints::voxels == block) continue;
            each(points, block, first, v + 1, chunk);
            first = v + 1;
        }
    });
}

/// Every corner of every voxel, sorted, each once.
std::vector<MortonCode> grid_point_codes(const OctreeLevel& level) {
    std::vector<std::vector<CodeIndex>> parts(chunk_count(level.size(), chunks::usual));
    for_blocks(level,
               [&](BlockGridPoints& points, MortonCode block, std::size_t, std::size_t, std::size_t chunk) {
                   points.take(block, [&](int, MortonCode code) { parts[chunk].push_back({code, 0}); });
               });
    std::vector<CodeIndex> points = joined(parts);
    radix_sort(points, 3 * (level.depth + 2));
    std::vector<MortonCode> codes;
    reserve_large(codes, points.size());
    for_each_in_order(points.size(), [&](std::size_t i) {
        if (codes.empty() || codes.back() != points[i].code) codes.push_back(points[i].code);
    });
    return codes;
}

/// Enters each voxel at its eight corners.
void connect_voxels(const OctreeLevel& level, GridPoints& grid) {
    resize_large(grid.voxels, grid.size(), no_voxels);
    for_blocks(level,
               [&](BlockGridPoints& points, MortonCode block, std::size_t begin, std::size_t end, auto) {
                   std::array<Index, 125> point_at;
                   points.take(block, [&](int place, MortonCode code) {
                       point_at[static_cast<std::size_t>(place)] = grid.index.find(code);
                   });
                   for (std::size_t v = begin; v < end; ++v)
                       for (unsigned k = 0; k < 8; ++k)
                           grid.voxels[point_at[BlockGridPoints::place(level.codes[v], k)]][7 - k] =
                               static_cast<Index>(v);
               });
}

void connect_grid_point(GridPoints& grid, std::size_t i) {
    for (unsigned axis = 0; axis < 3; ++axis) {
        VoxelCoord next = grid.coord(static_cast<Index>(i));
        ++next[axis];
        grid.next[i][axis] = grid.index.find(grid.code(next));
    }
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
    grid.index.build(grid.codes);
    connect_voxels(level, grid);
    resize_large(grid.next, grid.size());
    for_each_index(grid.size(), chunks::usual, [&](Index i) { connect_grid_point(grid, i); });
    return grid;
}

void add_grid_points(GridPoints& grid, std::span<const MortonCode> codes) {
    const std::size_t n = grid.size();
    reserve_large(grid.codes, n + codes.size());
    grid.codes.insert(grid.codes.end(), codes.begin(), codes.end());
    grid.index.build(grid.codes);
    resize_large(grid.voxels, grid.size(), no_voxels);
    resize_large(grid.next, grid.size());
    for_chunks(codes.size(), chunks::usual, [&](std::size_t begin, std::size_t end, std::size_t) {
        for (std::size_t i = n + begin; i < n + end; ++i) {
            connect_grid_point(grid, i);
            for (unsigned axis = 0; axis < 3; ++axis) {
                VoxelCoord below = grid.coord(static_cast<Index>(i));
                --below[axis];
                const Index point = grid.index.find(GridPoints::code(below));
                // Added grid points set their own `next`.
                if (point != no_index && point < n) grid.next[point][axis] = static_cast<Index>(i);
            }
        }
    });
}

} // namespace hsdm
