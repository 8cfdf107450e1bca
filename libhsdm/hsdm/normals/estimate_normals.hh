#pragma once
// Normals from positions alone, such that creases stay creases.

#include "hsdm/normals/constants.hh"
#include "hsdm/normals/neighbors.hh"

namespace hsdm {

struct EstimateOptions {
    /// How far from a plane a point may lie and still be of it: the larger of the two counts.
    /// in radii of the neighbourhood, (0, 0.5): on clean data
    double least_tolerance = estimation::least_tolerance;
    /// in multiples of the noise, > 0
    double noise_tolerance = estimation::noise_tolerance;
    /// >= 0: how many neighbourhoods far a crease is looked past; 0 is plain least squares
    int rounds = estimation::rounds;
};

struct EstimatedNormals {
    std::vector<Vec3> normals;     ///< per point, unit; (0, 0, 0) where the neighbours span no plane
    std::vector<double> tolerance; ///< per point: the distance from a plane that was allowed
    std::vector<double> spread; ///< per point: root mean square distance of its neighbours from their plane
    std::vector<Index> bent;    ///< ascending: the points whose neighbours are not all of one plane
    double noise = 0; ///< typical distance of a point from the plane of its neighbours, over their reach
};

/// Normals of either sign. A least-squares plane smears the normals over a whole neighbourhood on both sides
/// of a crease. So where neighbours disagree, every point looks among its neighbours' planes for the one
/// that, moved to pass through it, holds clearly more of its neighbours than its own does, takes it over and
/// fits it to those it holds; then points near a crease average over their neighbours of the same face. O(n),
/// parallel. Throws OptionError.
EstimatedNormals estimate_normals(const Octree& octree, const Neighbors& neighbors,
                                  const EstimateOptions& options = {});

/// Away from creases the plane gives way to a quadratic surface as far as that is the better of the two, and
/// where points are rough all average over their neighbours of the same face. Every normal keeps its side,
/// and does not depend on the sides of the others; to find these, planes serve better. O(n), parallel.
std::vector<Vec3> refined_normals(const Octree& octree, const Neighbors& neighbors,
                                  const EstimatedNormals& estimate);

} // namespace hsdm
