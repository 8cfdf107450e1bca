#pragma once
// Space that scanners looked through.

#include "hsdm/core/morton_index.hh"
#include "hsdm/normals/orient_normals.hh"
#include "hsdm/octree/octree.hh"

#include <span>

namespace hsdm {

/// The space between scanners and what they measured. Each scanner has depth maps, coarser and coarser: bins
/// of directions, on the faces of a cube around it, and the least depth in and around each. A place is free
/// where the scanner measured two points or more in its bin, and nothing there or in the bins around is as
/// near. So nothing is free that lies within a bin, which is a voxel or two spacings wide, of what the
/// scanner saw in front of it, and nothing where it saw nothing. (As the occupancy grids of robots have it,
/// but looked up in place of traversed.)
class FreeSpace {
public:
    /// None.
    FreeSpace() = default;
    /// What the scanners of an octree's measured points saw; viewpoints and places are relative to its
    /// origin. `voxel_size`: what is less than two of them in front of a point is not known to be free, as
    /// points have noise and scans do not register. O(n log n), parallel; the same for any number of threads.
    FreeSpace(const Octree& octree, const Viewpoints& viewpoints, double voxel_size);

    /// A point as a scanner saw it: its direction, as a bin of the finest level, and its distance.
    struct Ray {
        MortonCode code;
        double depth;
        /// Of two places that are not the same.
        static Ray between(const Vec3& scanner, const Vec3& point);
    };
    /// The same of the rays of each scanner, in any order, which are taken.
    FreeSpace(std::span<const Vec3> scanners, std::vector<std::vector<Ray>>&& rays, double voxel_size);

    bool empty() const { return views_.empty(); }
    /// Is a place known to hold nothing? O(scanners).
    bool holds(const Vec3& place) const;

private:
    /// Bins of directions that hold points.
    struct Bins {
        std::vector<MortonCode> codes;
        std::vector<double> depth; ///< the least in a bin and those around it
        std::vector<Index> points; ///< in the bin
        MortonIndex index;
    };
    struct View {
        Vec3 from{0, 0, 0};
        std::vector<Bins> levels; ///< the coarsest first: 2, 4, ... bins along an edge of the cube

        bool sees_through(const Vec3& place, double voxel_size) const;
    };
    static View view_of(const Vec3& from, std::vector<Ray> rays);
    static Bins bins_of(const std::vector<Ray>& rays, int level);

    std::vector<View> views_;
    double voxel_size_ = 0;
};

} // namespace hsdm
