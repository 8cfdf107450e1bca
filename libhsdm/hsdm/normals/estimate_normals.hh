#pragma once
// Normals from positions alone, such that creases stay creases.

#include "hsdm/normals/neighbors.hh"

namespace hsdm {

struct EstimateOptions {
    double least_tolerance = 0.05; ///< of the neighbourhood's radius, > 0: how far from its plane a point may
                                   ///< lie and still be of it, on clean data
    double noise_tolerance = 3;    ///< the same in units of the noise, > 0; the larger of the two counts
    int rounds = 2;                ///< of refitting with the neighbours' normals, >= 0
};

struct EstimatedNormals {
    std::vector<Vec3> normals;   ///< per point, unit, of either sign; (0, 0, 0) where the neighbours span no plane
    std::vector<double> tolerance; ///< per point: the distance from a plane that was allowed
    double noise = 0;            ///< typical distance of a point from the plane of its neighbours, over their reach
    std::size_t refitted = 0;    ///< points whose neighbours are not all of one plane
};

EstimatedNormals estimate_normals(const Octree& octree, const Neighbors& neighbors, const EstimateOptions& options = {});

} // namespace hsdm
