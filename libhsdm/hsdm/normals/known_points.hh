#pragma once
// Part of a cloud: of which points it has the same neighbours, and all that follows from them, as the whole.

#include "hsdm/normals/neighbors.hh"

#include <functional>

namespace hsdm {

/// Points whose values are those of the whole cloud. A step of a computation makes new values from those of a
/// point and its neighbours; where one of these is not known, the new value is not.
class KnownPoints {
public:
    /// Has the part all points of the voxels within one of this, of that level?
    using HasAround = std::function<bool(const VoxelCoord& voxel, int level)>;

    /// Those whose neighbours are found as in the whole: the voxels that they were sought in are in the part.
    /// `neighbors`: of all points of the part, with the finest level of the whole.
    KnownPoints(const Octree& octree, const Neighbors& neighbors, const HasAround& has_around);

    /// After a step of all points, or of these.
    void step();
    void step(const std::vector<Index>& points, int times = 1);
    /// After a step that takes all points of a leaf together.
    void step_leaves();

    bool operator[](std::size_t point) const { return known_[point] != 0; }
    bool all(std::size_t begin, std::size_t end) const;
    /// Are all neighbours of these points known too?
    bool all_around(std::size_t begin, std::size_t end) const;

private:
    bool knows_around(Index point) const;

    const Neighbors& neighbors_;
    std::vector<std::uint8_t> known_;
};

} // namespace hsdm
