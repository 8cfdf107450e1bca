#pragma once
// Do neighbouring tiles agree where both look?

#include "hsdm/core/ranks.hh"
#include "hsdm/pipeline/tile_piece.hh"

namespace hsdm {

/// Per tile, 1 if it and another one have found different things in a voxel that both look at. `ranges`: of
/// all tiles, ascending, with nothing between them; `pieces`: those of this rank's tiles, which are those of
/// owner(tile). For all ranks at the same time. O(n log n) in the voxels compared, whatever the number of
/// tiles.
std::vector<std::uint8_t> disagreeing_tiles(const std::vector<Piece>& pieces,
                                            std::span<const VoxelRange> ranges,
                                            const std::function<int(std::size_t)>& owner, Ranks& ranks);

} // namespace hsdm
