#pragma once
// Section 3.4.1: the points of a voxel sorted into normal-consistent sets, so that two sheets in one voxel
// stay two.

#include "hsdm/contour/constants.hh"
#include "hsdm/octree/octree.hh"

namespace hsdm {

struct NormalSetOptions {
    /// radians, (0, pi/2): points of a set lie within this angle of its mean normal
    double cluster_angle = sets::cluster_angle;
    /// voxels, > 0: parallel sheets farther apart than this are two sets
    double sheet_gap = relations::smooth_gap;
    /// Parallel sheets stay one set if they lie over each other, face the same way and no points between them
    /// face back. No solid has such sheets: they are one surface scanned twice.
    bool merge_layers = false;
    int max_sets = 8; ///< per voxel, [1, 8]; smaller groups join the nearest
};

/// Second moments of a set of positions about their mean: xx, yy, zz, xy, yz, zx.
struct Spread {
    std::array<double, 6> moments{};

    /// Variance along a unit direction.
    double along(const Vec3& d) const {
        return moments[0] * d[0] * d[0] + moments[1] * d[1] * d[1] + moments[2] * d[2] * d[2]
               + 2 * (moments[3] * d[0] * d[1] + moments[4] * d[1] * d[2] + moments[5] * d[2] * d[0]);
    }
    /// How far points that lie evenly reach from their mean along a unit direction, squared.
    double reach_squared(const Vec3& d) const { return 3 * std::max(0.0, along(d)); }
};

/// One normal-consistent set: the paper's graph vertex for points with normals (section 3.4.2).
struct NormalSet {
    Vec3 centroid;   ///< mean position, moved along the normal onto the surface (see build_normal_sets)
    Vec3 normal;     ///< unit mean normal
    Index count;     ///< points
    Index voxel;     ///< of the level the sets were made for
    Spread spread;   ///< of its points about their mean
    double turn = 0; ///< mean of (n - mean n) . (p - mean p): curvature times variance, 0 where it is flat
};

/// The sets of a level's voxels: those of voxel v are sets[first[v]] .. sets[first[v + 1]], by descending
/// count.
struct NormalSets {
    std::vector<NormalSet> sets;
    std::vector<Index> first{0};
    /// Per octree point, which of its voxel's sets it is in; no_set for points without a normal.
    std::vector<std::uint8_t> of_point;
    /// Sets that have a wall or gap between them (separate_patches): those of set s, ascending, are
    /// apart[first_apart[s]] .. apart[first_apart[s + 1]]. Both are empty if there are none.
    std::vector<Index> apart, first_apart;

    static constexpr std::size_t most_per_voxel = 8;
    static constexpr std::uint8_t no_set = 0xff;

    std::span<const NormalSet> of_voxel(Index v) const {
        return {sets.data() + first[v], sets.data() + first[v + 1]};
    }
    /// Calls f(point) for the octree points of a set, ascending.
    template <class F>
    void for_points_of(Index set, const OctreeLevel& level, F&& f) const {
        const Index voxel = sets[set].voxel;
        for (Index p = level.first_point[voxel]; p < level.first_point[voxel + 1]; ++p)
            if (of_point[p] == set - first[voxel]) f(p);
    }
};

/// The set that these points of a voxel make; its normal is (0, 0, 1) if theirs cancel each other.
NormalSet measure_set(const Octree& octree, std::span<const Index> points, Index voxel, double voxel_size);

/// Sorts each voxel's points into sets: by direction (modes of the normals, mean shift), then by offset where
/// two parallel sheets share a direction. The two faces of a blunt crease
/// are two sets. Does not depend on the order of the points. The centroid of points
/// on a curved patch lies below it by half the mean of (n - mean n) . (p - mean p); that much is added back
/// along the normal. Voxels whose points have no normals have no set. O(points), parallel. Throws
/// OptionError.
NormalSets build_normal_sets(const Octree& octree, const OctreeLevel& level,
                             const NormalSetOptions& options = {});

} // namespace hsdm
