#pragma once
// Points that are of no surface: outliers between and around the surfaces.

#include "hsdm/core/discarded.hh"
#include "hsdm/normals/constants.hh"
#include "hsdm/normals/neighbors.hh"

namespace hsdm {

struct OutlierOptions {
    /// of a point's reach against the median reach of its neighbours
    double most_stretch = distance_outliers::most_stretch;
    /// of a point's reach against the median of the cloud
    double most_sparseness = distance_outliers::most_sparseness;
    /// From these on a point is looked at more closely: it goes if its neighbours fill a volume, or if they
    /// lie on a plane that it is far from.
    double doubtful_stretch = distance_outliers::doubtful_stretch;
    double doubtful_sparseness = distance_outliers::doubtful_sparseness;
    /// neighbours' deviation from their plane that is a volume's, in reaches
    double least_volume = distance_outliers::least_volume;
    /// distance from the neighbours' plane, in reaches, and more than three of their deviations
    double least_height = distance_outliers::least_height;
    /// the fewer outliers there are, the more those left stand out
    int rounds = distance_outliers::rounds;
};

/// Removes the points that are far from their neighbours while these are near each other, or far from all;
/// less far ones if their neighbours do not lie beside them on a plane. The reach of a point is the distance
/// of the farthest of its neighbours, which changes slowly along a sampled surface, as does its plane however
/// sparse it is. Returns how many, and where in the coordinates of the octree's bounds; the neighbours are
/// those of the points left. O(n) per round, parallel.
Discarded drop_outliers_by_distance(Octree& octree, Neighbors& neighbors, const OutlierOptions& options = {});

struct NormalOutlierOptions {
    /// of a typical point's voxel: on such a level sparse voxels are looked for
    double points_per_voxel = normal_outliers::points_per_voxel;
    /// of those points in a sparse voxel
    double most_share = normal_outliers::most_share;
    /// per point of a sparse voxel, [3, 64]
    int neighbors = neighborhoods::neighbors;
    /// of them must continue the point's own plane
    int least_support = normal_outliers::least_support;
    /// in voxels: of those of them that are not of a sparse voxel themselves
    double most_distance = normal_outliers::most_distance;
    /// radians: between normals of one plane (45 degrees)
    double most_angle = normal_outliers::most_angle;
    /// of a neighbour over the point's plane, in distances between the two
    double most_rise = normal_outliers::most_rise;
};

/// The same where normals are known: among the points in sparse voxels, those that too few neighbours agree
/// with. O(n), parallel; little more than the points are read once where hardly any voxel is sparse. Throws
/// OptionError.
Discarded drop_outliers_by_normals(Octree& octree, const NormalOutlierOptions& options = {});

} // namespace hsdm
