#include "hsdm/normals/normals.hh"

#include "hsdm/core/chunks.hh"
#include "hsdm/normals/arcs.hh"
#include "hsdm/normals/noise.hh"
#include "hsdm/normals/vote_on_normals.hh"

namespace hsdm {

namespace {

/// Takes out noise, and finds neighbours in the number asked for or that the noise calls for, from the
/// nearest ones. The noise is measured anew only where points or neighbours have changed since.
Neighbors choose_neighbors(Octree& octree, Neighbors nearest, const NormalsOptions& options,
                           EstimateOptions& estimate, SmoothReport& smoothed) {
    std::vector<NoiseSample> samples = noise_samples(octree, nearest);
    const double deviation = noise_deviation(octree, nearest, samples);
    if (is_noisy(octree, deviation, options.smooth)) {
        smoothed = smooth_known_noise(octree, deviation, nearest, options.smooth);
        samples = noise_samples(octree, nearest);
    }
    if (options.neighbors != 0) return find_neighbors(octree, {.count = options.neighbors});
    const double noise = estimate_noise(samples);
    const int wanted = neighbors_for_noise(noise);
    if (wanted > neighborhoods::neighbors) return find_neighbors(octree, {.count = wanted});
    if (!estimate.noise) estimate.noise = noise;
    return nearest;
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
    EstimateOptions how = options.estimate;
    const Neighbors neighbors = choose_neighbors(octree, std::move(nearest), options, how, report.smoothed);
    EstimatedNormals estimate = estimate_normals(octree, neighbors, how);
    std::vector<Vec3> refined;
    const Orientation orientation = orient_normals(
        octree, neighbors, estimate, orient, [&] { refined = refined_normals(octree, neighbors, estimate); });
    turn_normals(orientation, refined);
    estimate.normals = std::move(refined);
    report.orientation = orientation.report;
    vote_on_normals(octree, neighbors, estimate);
    // Neighbours in two layers of one surface lie on arcs from the one to the other.
    if (orientation.report.of_layers == 0) bend_to_arcs(octree, neighbors, estimate);
    report.noise = estimate.noise;
    report.bent = estimate.bent.size();
    report.missing = indices_where(octree.size(), chunks::light, [&](Index i) {
                         return estimate.normals[i].sqrnorm() == 0;
                     }).size();
    octree.normals = std::move(estimate.normals);
    return report;
}

} // namespace hsdm
