#pragma once
// The steps of smooth_points(), each of which can be taken of a part of the points. What a step makes of a
// point hangs on those within a stated width of it, so a part that has all of these makes of its own points
// what the whole makes of them, bit for bit.

#include "hsdm/core/chunks.hh"
#include "hsdm/core/constants.hh"
#include "hsdm/normals/constants.hh"
#include "hsdm/normals/plane_fit.hh"
#include "hsdm/octree/octree.hh"

#include <functional>

namespace hsdm {

/// Points in voxels of a lattice that hangs on the box of all points, of which these may be a part, and what
/// lies round each: all voxels that come within `reach` of its own.
class VoxelLattice {
public:
    /// The box holds all positions.
    VoxelLattice(const std::vector<Vec3>& positions, const Box& box, double edge, std::int32_t reach);

    const Vec3& origin() const { return points_.origin; }
    std::size_t voxels() const { return level_.size(); }

    /// work(position relative to the origin, index among the positions given) for the points of a voxel.
    template <class Work>
    void for_points_of(Index voxel, const Work& work) const {
        for (Index i = level_.first_point[voxel]; i < level_.first_point[voxel + 1]; ++i)
            work(points_.positions[i], points_.source[i]);
    }
    /// The first of them, in an order that no part changes.
    Index first_of(Index voxel) const { return points_.source[level_.first_point[voxel]]; }

    /// work(voxel, voxels around) for all voxels.
    template <class Work>
    void for_each_voxel(const Work& work) const {
        for_chunks(level_.size(), chunks::heavy, [&](std::size_t begin, std::size_t end, std::size_t) {
            std::vector<Index> around;
            for (auto v = static_cast<Index>(begin); v < end; ++v) {
                find_around(v, around);
                work(v, around);
            }
        });
    }

    /// work(position relative to the origin, index among the positions given, voxels around) for all points.
    template <class Work>
    void for_each_point(const Work& work) const {
        for_each_voxel([&](Index v, const std::vector<Index>& around) {
            for_points_of(v, [&](const Vec3& p, Index i) { work(p, i, around); });
        });
    }

private:
    void find_around(Index voxel, std::vector<Index>& around) const;

    std::int32_t reach_;
    Octree points_;
    OctreeLevel level_;
};

/// Moved points, and the normals, of either sign, of the planes that they were moved to.
struct MovedPoints {
    std::vector<Vec3> positions, normals;
};

/// Points in strips as wide as a half gap, of which the second two have the two sheets in their middle.
struct SheetStrips {
    double between = 0, at_sheets = 0;
    void add(double distance, double half_gap);
};

/// Points of voxels, those of them at the surface's ends, and of these those that scatter as about two
/// sheets.
struct SheetCounts {
    double points = 0, at_ends = 0, ends_of_two = 0; ///< whole numbers
    std::vector<double> noises;                      ///< deviation about each sheet, per voxel of two
    SheetStrips strips;                              ///< of these voxels

    void operator+=(const SheetCounts& other);
};

/// How points are moved to the planes of what surrounds them. All lengths in the cloud's units; a box is that
/// of all points as they lie then, not of a part.
class PlaneSmoothing {
public:
    /// By the standard deviation of the noise.
    PlaneSmoothing(double spacing, double noise);
    /// For the points of two sheets that mix: half as far off the plane the other one begins, so that each
    /// keeps a mode of its own; voxels half as wide do not hold both, and modes take more rounds than means.
    static PlaneSmoothing between_sheets(double spacing, double noise);

    /// Along each axis, as far as voxels around a point's own reach, and as what onto_planes() depends on.
    double width_around() const { return (reach_ + 1) * edge(); }
    double width_of_planes() const { return (2 * reach_ + 1) * edge(); }

    VoxelLattice around(const std::vector<Vec3>& positions, const Box& box) const {
        return {positions, box, edge(), reach_};
    }

    /// Each point on the plane of its surroundings; `normals` are those of planes to begin with, if known.
    MovedPoints onto_planes(const std::vector<Vec3>& positions, const Box& box,
                            std::vector<Vec3> normals = {}) const;

    /// A plane through a bent sheet lies on its hollow side, so all points came to lie there. What tells how
    /// far is where they came from: they scatter about the true surface, so the mean of their ways back says
    /// where that is. Moves the points by it, along their normals (twicing: Tukey 1977). `lattice`: around()
    /// the moved ones. Depends on those that were moved to width_around().
    void undo_shrinking(const std::vector<Vec3>& from, const VoxelLattice& lattice, MovedPoints& moved) const;

    /// Of the voxels whose first point is_own(). Depends on points as undo_shrinking().
    SheetCounts count_sheets(const std::vector<Vec3>& from, const VoxelLattice& lattice,
                             const MovedPoints& moved, const std::function<bool(Index)>& is_own) const;
    /// By the counts of all: the deviation of each of two sheets that points were moved between; 0 where they
    /// are of one. Layers of scans that do not register scatter as the sides of a wall do. But a wall's sides
    /// end together, and layers each where its scan ends: so it is a wall if most points at the ends of what
    /// they were moved to scatter as about two. And that is a sheet itself: as long around as a disc of its
    /// area at least.
    double noise_of_two_sheets(SheetCounts&& counts) const;

private:
    /// Points, mean and second moments about it of one voxel.
    struct VoxelSums;
    struct WayBack;

    double edge() const { return radius_ / reach_; }
    /// What lies around reaches half a voxel farther. At a straight end its mean is half of that off, a third
    /// of the way in from there a third.
    double strip_at_end() const { return radius_ * (1 + 0.5 / smoothing::reach) / 3; }
    static std::vector<VoxelSums> sums_of(const VoxelLattice& lattice);
    static std::vector<WayBack> ways_back(const VoxelLattice& lattice, const std::vector<Vec3>& from,
                                          const std::vector<Vec3>& to);
    double weight_of(const Vec3& away, const Vec3& normal) const;
    PlaneSums plane_sums(const Vec3& p, const std::vector<VoxelSums>& voxels,
                         const std::vector<Index>& around, const Vec3& normal = Vec3(0, 0, 0)) const;
    std::vector<Vec3> first_normals(const VoxelLattice& lattice, const std::vector<VoxelSums>& sums,
                                    std::size_t points) const;
    Vec3 project(const Vec3& point, const std::vector<VoxelSums>& voxels, const std::vector<Index>& around,
                 Vec3& normal) const;

    double spacing_, radius_, inverse_radius_, inverse_gap_;
    std::int32_t reach_ = smoothing::reach;
    int rounds_ = repeats::few;
};

/// The noise by how far points were moved onto planes: most lie on surfaces that no smoothing moves; creases
/// move theirs farther, so the lower third of the moves is taken, which is 0.43 standard deviations. So many
/// of them are less than the one that tells.
inline std::size_t moves_below(std::size_t points) {
    return points / 3;
}
double noise_of_move(float move);
/// Is so much less than was thought that it is all to be done again?
bool is_clearly_less(double found, double noise);

} // namespace hsdm
