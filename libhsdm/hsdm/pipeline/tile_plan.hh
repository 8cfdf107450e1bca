#pragma once
// Which tiles a cloud is worked through in, and what memory they take.

#include "hsdm/io/scratch_points.hh"
#include "hsdm/pipeline/voxel_range.hh"
#include "hsdm/types.hh"

#include <span>

namespace hsdm {

/// Bytes, measured (docs/tiles.md): of a point of the survey; of a voxel while there are pieces, which lie on
/// disk; in the end, as a half-edge mesh with all properties or in flat arrays, as far as they are read, and
/// of these while the error is measured, in memory or as far as they are read, and while they are completed;
/// and of what is there before.
inline constexpr std::size_t bytes_per_point = 260, bytes_per_voxel_of_pieces = 10,
                             bytes_per_voxel_of_mesh = 660, bytes_per_voxel_of_parked_mesh = 130,
                             bytes_per_voxel_in_error = 130, bytes_per_voxel_parked_in_error = 65,
                             bytes_per_voxel_in_completion = 160, bytes_of_program = std::size_t{64} << 20;

/// In the end, of a number of a vertex of a half-edge mesh, as it is made of flat arrays.
inline constexpr std::size_t bytes_per_property = 2 * sizeof(double);

/// The same of a tile's point, and of one whose distance is measured, with what is made of its voxel.
inline double bytes_per_tile_point(double voxels_per_point) {
    return 110 + 750 * voxels_per_point;
}
inline double bytes_per_error_point(double voxels_per_point) {
    return 250 + 260 * voxels_per_point;
}

/// Bytes a point at most in one piece: 205 to 280 were measured where the voxel follows from the spacing,
/// 4,400 where a depth was asked for at which nearly every point has a voxel of its own.
inline constexpr std::size_t bytes_per_point_of_one_piece = 500, bytes_per_point_of_any_voxels = 5000;

/// The level of the cells that points are sorted by: of 8 voxels of a small level along an edge, else of 32
/// and no more than 2^18 over the cube.
int cell_depth_of(int depth);

/// Round a tile that is made again and again.
inline constexpr int most_ghost_voxels = 256;

struct TilePlanOptions {
    int depth = 0, cell_depth = 0;
    int ghost_voxels = 0;
    std::size_t most_points = 0;       ///< of a tile and what is round it, about
    std::vector<MortonCode> borders{}; ///< cells that a tile must begin with, ascending
};

/// Ranges that cover the level, as few as there may be. A cell that is too large alone becomes a tile all the
/// same.
std::vector<VoxelRange> plan_tiles(std::span<const ScratchPoints::Cell> cells,
                                   const TilePlanOptions& options);

/// By a sample of positions in a cube of this edge: may it be that they are of no surface, but a line or
/// less?
bool spans_no_surface(std::span<const Vec3> places, double cube_extent);
/// May some points be so far from most that drop_far_outliers() or cut_empty_space() would do something?
bool has_far_points(std::span<const Vec3> places, double cube_extent, double spacing);

} // namespace hsdm
