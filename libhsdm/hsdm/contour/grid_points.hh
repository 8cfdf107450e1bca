#pragma once
// The grid points round the occupied voxels of a level.

#include "hsdm/core/morton_index.hh"
#include "hsdm/octree/octree.hh"

namespace hsdm {

/// The grid points at the corners of the occupied voxels of a level, in Morton order; behind them, also in
/// Morton order, those that extend_grid_points added.
struct GridPoints {
    std::vector<MortonCode> codes;
    /// Per grid point, the voxel in each octant or no_index: bit k of the octant's number is set on the upper
    /// side of axis k.
    std::vector<std::array<Index, 8>> voxels;
    /// Per grid point, the next up each axis, or no_index.
    std::vector<std::array<Index, 3>> next;

    /// Grid points whose codes ascend: those built, and those of each call that added some.
    struct Part {
        Index first;
        MortonIndex index; ///< code -> number in the part
    };
    std::vector<Part> parts;
    /// Per grid point, voxels: how far off its place it lies (move_to_bar_lines), or empty; those that
    /// extend_grid_points adds lie at theirs.
    std::vector<Vec3> moved_by;

    std::size_t size() const { return codes.size(); }
    /// Integer coordinates, in voxels, from -1 to 2^depth + 1: there is a margin of one voxel around the
    /// bounding cube.
    VoxelCoord coord(Index grid_point) const {
        const VoxelCoord c = morton_decode(codes[grid_point]);
        return {c[0] - 1, c[1] - 1, c[2] - 1};
    }
    static MortonCode code(const VoxelCoord& c) {
        return morton_encode(VoxelCoord{c[0] + 1, c[1] + 1, c[2] + 1});
    }
    bool is_moved(Index grid_point) const {
        return grid_point < moved_by.size() && moved_by[grid_point].sqrnorm() > 0;
    }
    /// Where it lies, in voxels.
    Vec3 position(Index grid_point) const {
        const VoxelCoord c = coord(grid_point);
        const Vec3 place(c[0], c[1], c[2]);
        return is_moved(grid_point) ? place + moved_by[grid_point] : place;
    }
    /// The grid point of a code, or no_index.
    Index find(MortonCode code) const {
        for (const Part& part : parts)
            if (const Index number = part.index.find(code); number != no_index) return part.first + number;
        return no_index;
    }
    /// Makes those from one to the last findable.
    void add_part(Index first_of_part) {
        parts.push_back({first_of_part, {}});
        parts.back().index.build({codes.begin() + first_of_part, codes.end()});
    }
};
GridPoints build_grid_points(const OctreeLevel& level);
/// Per grid point, the next down each axis, or no_index: the inverse of `next`.
std::vector<std::array<Index, 3>> grid_points_below(const GridPoints& grid);

/// Adds grid points by their codes (ascending, none present yet) and connects them.
void add_grid_points(GridPoints& grid, std::span<const MortonCode> codes);

} // namespace hsdm
