#pragma once
// Colours and scalars of the points of a cloud on disk, for passes that write these points anew and for
// tiles.

#include "hsdm/pipeline/scratch_cloud.hh"

namespace hsdm {

/// Reads a cell's rows when a point of it is asked for. The cloud must outlive it. Not for several threads.
class CellAttributes {
public:
    explicit CellAttributes(const ScratchCloud& cloud) : cloud_(cloud) {}

    /// The row of a point of an octree that the cloud has given, of a cell of which all is there; what it is
    /// together with those that were equal to it. Null if there are none.
    const char* of(const Octree& octree, std::size_t point);

private:
    const char* row(Index number);

    const ScratchCloud& cloud_;
    std::vector<char> rows_, mean_;
    std::size_t begin_ = 0, end_ = 0; // numbers of the points of that cell
};

/// Per point of an octree of whole cells the number of its scanner; empty if the cloud has none of several.
std::vector<std::int32_t> scanners_of(const ScratchCloud& cloud, const Octree& octree);

/// Rows of a tile's own points, which are numbered anew by these, in `octree.source`; all others by 0. Points
/// that were added have what tells their kind there.
std::vector<char> take_attributes(const ScratchCloud& cloud, const VoxelRange& range, Octree& octree);

} // namespace hsdm
