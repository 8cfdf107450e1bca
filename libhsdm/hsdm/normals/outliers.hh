#pragma once
// Points that are of no surface: outliers between and around the surfaces.

#include "hsdm/core/discarded.hh"
#include "hsdm/normals/neighbors.hh"

namespace hsdm {

struct OutlierOptions {
    double most_stretch = 4;     ///< of a point's reach against the median reach of its neighbours
    double most_sparseness = 10; ///< of a point's reach against the median of the cloud
    /// From these on a point is looked at more closely: it goes if its neighbours fill a volume, or if they
    /// lie on a plane that it is far from.
    double doubtful_stretch = 1.25, doubtful_sparseness = 1.5;
    double least_volume = 0.2;  ///< neighbours' deviation from their plane that is a volume's, in reaches
    double least_height = 0.45; ///< distance from the neighbours' plane, in reaches, and more than three of
                                ///< their deviations
    int rounds = 3;             ///< the fewer outliers there are, the more those left stand out
};

/// Removes the points that are far from their neighbours while these are near each other, or far from all;
/// less far ones if their neighbours do not lie beside them on a plane. The reach of a point is the distance
/// of the farthest of its neighbours, which changes slowly along a sampled surface, as does its plane however
/// sparse it is. Returns how many, and where in the coordinates of the octree's bounds; the neighbours are
/// those of the points left. O(n) per round, parallel.
Discarded drop_outliers_by_distance(Octree& octree, Neighbors& neighbors, const OutlierOptions& options = {});

struct NormalOutlierOptions {
    double points_per_voxel = 8; ///< of a typical point's voxel: on such a level sparse voxels are looked for
    double most_share = 0.125;   ///< of those points in a sparse voxel
    int neighbors = 16;          ///< per point of a sparse voxel, [3, 64]
    int least_support = 3;       ///< of them must continue the point's own plane
    double most_distance = 8;    ///< in voxels: of those of them that are not of a sparse voxel themselves
    double most_angle = 0.79;    ///< radians: between normals of one plane (45 degrees)
    double most_rise = 0.35;     ///< of a neighbour over the point's plane, in distances between the two
};

/// The same where normals are known: among the points in sparse voxels, those that too few neighbours agree
/// with. O(n), parallel; little more than the points are read once where hardly any voxel is sparse. Throws
/// OptionError.
Discarded drop_outliers_by_normals(Octree& octree, const NormalOutlierOptions& options = {});

} // namespace hsdm
