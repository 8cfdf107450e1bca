#pragma once
// The sets round a grid face, and which of them walls and gaps part.

#include "hsdm/contour/grid_points.hh"
#include "hsdm/contour/set_relation.hh"

namespace hsdm {

/// The sets in the up to 18 voxels that touch a grid face, and the patches that they make up there: connected
/// components of the smooth relation between adjacent voxels. Made for one face after the other.
class SetsRoundFace {
public:
    SetsRoundFace(const GridPoints& grid, const NormalSets& sets, const RelationTest& related)
        : grid_(grid), sets_(sets), related_(related) {}

    /// The face of a grid point across an axis. False if no wall or gap parts any of its sets: then there is
    /// nothing to ask.
    bool gather(Index grid_point, unsigned axis);

    /// Is a wall or gap known between the patches of two sets, neither of them strays? O(sets^2).
    bool parted(Index s, Index t) const;

    /// Is there a patch that meets those of both in creases of one kind: the rim of a wall, the bottom of a
    /// gap? O(sets^2).
    bool joined_by_rim(Index s, Index t) const;

private:
    struct Member {
        Index set;
        VoxelCoord at; ///< of its voxel, relative to the face
        std::uint8_t patch;
    };

    const NormalSet& set(const Member& m) const { return sets_.sets[m.set]; }
    const Member* find(Index s) const;
    bool meets(const Member& rim, std::uint8_t patch, Relation kind) const;
    double points_of(std::uint8_t patch) const;
    void find_patches();

    const GridPoints& grid_;
    const NormalSets& sets_;
    const RelationTest& related_;
    std::vector<Member> members_;
};

} // namespace hsdm
