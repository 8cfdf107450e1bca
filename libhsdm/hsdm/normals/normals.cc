#include "hsdm/normals/normals.hh"

#include "hsdm/core/interruption.hh"
#include "hsdm/normals/arcs.hh"
#include "hsdm/normals/noise.hh"
#include "hsdm/normals/vote_on_normals.hh"

#include <algorithm>

namespace hsdm {

namespace {

/// Neighbours in the number asked for, or that the noise calls for.
Neighbors choose_neighbors(const Octree& octree, int count, Neighbors neighbors) {
    if (count != 0) return find_neighbors(octree, {.count = count});
    const int wanted = neighbors_for_noise(estimate_noise(octree, neighbors));
    return wanted > neighborhoods::neighbors ? find_neighbors(octree, {.count = wanted})
                                             : std::move(neighbors);
}

} // namespace

NormalsReport make_normals(Octree& octree, const NormalsOptions& options) {
    NormalsReport report;
    Neighbors nearest = find_neighbors(octree);
    report.outliers = drop_outliers_by_distance(octree, nearest, options.outliers);
    OrientOptions orient = options.orient;
    if (const Vec3 origin = octree.origin; report.outliers.count > 0 && fit_to_points(octree)) {
        nearest = find_neighbors(octree); // the order and the voxels have changed
        if (orient.sensor) *orient.sensor += origin - octree.origin;
        for (Vec3& sensor : orient.viewpoints.sensors) sensor += origin - octree.origin;
    }
    report.smoothed = smooth_noise(octree, nearest, options.smooth);
    const Neighbors neighbors = choose_neighbors(octree, options.neighbors, std::move(nearest));
    EstimatedNormals estimate = estimate_normals(octree, neighbors, options.estimate);
    Orientation orientation;
    std::vector<Vec3> refined;
    run_both([&] { orientation = orient_normals(octree, neighbors, estimate, orient); },
             [&] { refined = refined_normals(octree, neighbors, estimate); });
    turn_normals(orientation, refined);
    estimate.normals = std::move(refined);
    report.orientation = orientation.report;
    vote_on_normals(octree, neighbors, estimate);
    // Neighbours in two layers of one surface lie on arcs from the one to the other.
    if (orientation.report.of_layers == 0) bend_to_arcs(octree, neighbors, estimate);
    report.noise = estimate.noise;
    report.bent = estimate.bent.size();
    report.missing = static_cast<std::size_t>(std::count_if(estimate.normals.begin(), estimate.normals.end(),
                                                            [](const Vec3& n) { return n.sqrnorm() == 0; }));
    octree.normals = std::move(estimate.normals);
    return report;
}

} // namespace hsdm
