#pragma once
// Cloud without normals -> cloud with oriented normals: the whole step.

#include "hsdm/normals/orient_normals.hh"
#include "hsdm/normals/outliers.hh"
#include "hsdm/normals/smooth_points.hh"

namespace hsdm {

struct NormalsOptions {
    int neighbors = 0; ///< per point, [3, 64]; 0: 16, more where the points are noisy (neighbors_for_noise)
    OutlierOptions outliers;
    SmoothOptions smooth;
    EstimateOptions estimate;
    OrientOptions orient;
};

struct NormalsReport {
    Occurrences outliers;    ///< points far from all others, removed first
    SmoothReport smoothed;   ///< what was done about noise after that
    double noise = 0;        ///< see EstimatedNormals
    std::size_t bent = 0;    ///< points whose neighbours are not all of one plane: near creases, mostly
    std::size_t missing = 0; ///< points left without a normal: their neighbours lie on a line
    OrientReport orientation;
};

/// Removes outliers (and fits the cube to what is left: the octree's origin and order may change), moves the
/// points of a noisy cloud onto the surface that they scatter about, and gives the octree's points normals
/// from their positions alone, each on its own face where faces meet in a crease, and all of one side:
/// outward on a closed surface. Those the octree has are replaced. Two sides of a thin part stay apart if
/// they are at least as far from each other as neighbouring points. O(n log n), parallel; the same bits for
/// every number of threads. Throws OptionError.
NormalsReport make_normals(Octree& octree, const NormalsOptions& options = {});

} // namespace hsdm
