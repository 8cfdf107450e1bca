#pragma once
// Where a cloud has too few points for the voxels of a level, and points between them on coarser facets.

#include "hsdm/completion/complete_surface.hh"
#include "hsdm/core/occurrences.hh"
#include "hsdm/core/ranks.hh"
#include "hsdm/octree/octree.hh"
#include "hsdm/report.hh"

namespace hsdm {

/// Voxels of a level that are too small for the points there: the surface passes so many more than it has
/// points that it does not close; none if that is so of only a little of it. The first one's middle, relative
/// to the octree's origin. O(voxels).
Occurrences voxels_too_small(const OctreeLevel& level);

/// How many levels coarser than this one voxels are such that hardly any of the surface is too sparsely
/// sampled for them; 0 where that holds for this level, at most uneven::most_levels. O(voxels), parallel.
int levels_above_sparse(const OctreeLevel& level);

/// Notes that so many levels help out.
void note_coarser_levels(int levels, Report& report);

/// Some voxels of a level within one of a coarser level, and their points.
struct SparseWindow {
    MortonCode code = 0, first_voxel = 0, last_voxel = 0;
    std::size_t voxels = 0, points = 0;
};

/// The same of a cloud that is not in memory, on the level of this depth: takes parts of it in Morton order.
class SparseWindows {
public:
    explicit SparseWindows(int depth);
    void add(const Octree& part);
    /// Becomes that of all ranks, whose parts come one rank's after the other's. For all at the same time.
    void join(Ranks& ranks);
    int levels_above() const;

private:
    static void append(std::vector<SparseWindow> next, std::vector<SparseWindow>& all);

    int depth_;
    std::vector<std::vector<SparseWindow>> of_level_; ///< by how many levels above
};

/// The measured points of a cloud that has normals, on a level and some coarser ones.
class SparseAreas {
public:
    /// Of a level and so many coarser ones. Octree and level must outlive it. O(n levels), parallel.
    SparseAreas(const Octree& octree, const OctreeLevel& level, int coarser_levels);

    /// The level so many above the finest.
    const OctreeLevel& level(int above) const {
        return above == 0 ? finest_ : coarser_[static_cast<std::size_t>(above) - 1];
    }

    /// How many levels from the finest on are too fine for a point.
    std::uint8_t levels_too_fine(std::size_t point) const { return sparse_on_[point]; }
    /// Are measured points too few for the voxels of the level `above` the finest, but not missing, at a
    /// place of a surface that faces this way? Points within three voxels of the coarsest level tell.
    bool lacks(const Vec3& place, const Vec3& normal, int above) const;
    /// Points on a mesh of facets of a coarser level, relative to the octree's origin, where measured points
    /// are too few for the voxels of the level `above` the finest, but not missing: within a ball about one
    /// that holds few others. As dense as completed ones, on the facets bent as the normals at their corners
    /// tell. O(facets + points).
    CompletedPoints points_between(const PolygonMesh& facets, int above) const;

private:
    bool is_full(const Vec3& place, const Vec3& normal, int above) const;
    bool is_among_sparse(const Vec3& place, const Vec3& normal, int above) const;
    void find_sparse(int above);

    const Octree& octree_;
    const OctreeLevel& finest_;
    std::vector<OctreeLevel> coarser_;
    std::vector<std::uint8_t> sparse_on_;                ///< per point, how many levels are too fine for it
    std::vector<std::vector<std::uint8_t>> most_sparse_; ///< per level and voxel, the most of its points
};

} // namespace hsdm
