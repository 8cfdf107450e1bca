#pragma once
// Space that the scanners of a cloud on disk looked through.

#include "hsdm/completion/free_space.hh"
#include "hsdm/pipeline/scratch_cloud.hh"

namespace hsdm {

/// Of a point: a ray, and what is made of it, a bin, or several of coarser levels.
inline constexpr std::size_t bytes_per_ray = 3 * sizeof(FreeSpace::Ray);

/// FreeSpace of all measured points, relative to the cube, on the first rank; none on others, nor where no
/// scanner is known, most points' normals do not face theirs, or space was cut between parts. Points are read
/// `most` or a cell's at a time. For all ranks at the same time. Throws Error if it takes more memory than
/// the first rank has for it, in bytes.
FreeSpace cloud_free_space(const ScratchCloud& cloud, std::size_t most, std::size_t memory);

} // namespace hsdm
