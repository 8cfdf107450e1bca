#pragma once
// Normals from positions alone, such that creases stay creases.

#include "hsdm/core/constants.hh"
#include "hsdm/normals/constants.hh"
#include "hsdm/normals/neighbors.hh"

namespace hsdm {

struct EstimateOptions {
    /// Largest distance of a point from a plane that it belongs to: the larger of these two. In radii of the
    /// neighbourhood, (0, 0.5): for clean data
    double least_tolerance = estimation::least_tolerance;
    /// in multiples of the noise, > 0
    double noise_tolerance = noise::deviations;
    /// >= 0: rounds of taking over neighbours' planes, each reaching one neighbourhood farther from a crease;
    /// 0 is plain least squares
    int rounds = repeats::twice;
    /// EstimatedNormals::noise of a larger cloud that the points are part of
    std::optional<double> noise{};
};

struct EstimatedNormals {
    std::vector<Vec3> normals;     ///< per point, unit; (0, 0, 0) where the neighbours span no plane
    std::vector<double> tolerance; ///< per point: the largest distance from a plane that was allowed
    std::vector<double> spread; ///< per point: root mean square distance of its neighbours from their plane
    std::vector<Index> bent;    ///< ascending: the points whose neighbours are not all of one plane
    double noise = 0; ///< typical distance of a point from the plane of its neighbours, over their reach
};

/// Estimates normals of either sign. A least-squares plane smears the normals over a whole neighbourhood on
/// both sides of a crease. So where neighbours disagree, each point looks among its neighbours' planes for
/// one that, moved to pass through it, holds clearly more of its neighbours than its own plane, takes that
/// over and fits it to the neighbours it holds; then points near a crease average over their neighbours of
/// the same face. O(n), parallel. Throws OptionError.
EstimatedNormals estimate_normals(const Octree& octree, const Neighbors& neighbors,
                                  const EstimateOptions& options = {});

/// Refines normals. Away from creases the plane's normal is replaced by a quadratic surface's as far as that
/// is the more accurate; where points are rough all normals are averaged over neighbours of the same face.
/// Every normal keeps its sign and does not depend on those of others. For finding signs the plain planes
/// work better. O(n), parallel.
std::vector<Vec3> refined_normals(const Octree& octree, const Neighbors& neighbors,
                                  const EstimatedNormals& estimate);

/// Turns each normal to the side of the given one of its point.
void turn_along(const std::vector<Vec3>& given, std::vector<Vec3>& normals);

} // namespace hsdm
