#include "support/trial.hh"

#include "support/dense_solid.hh"

namespace hsdm::support {
namespace {

constexpr double thinnest_posed = 0.3, thinnest_large = 2; // voxels
constexpr double grazing = 0.262, sharp = 0.524;           // radians: 15 and 30 degrees

/// From how many of a number of candidates lie on the boundary.
double boundary_area(const Solid& solid, std::uint64_t seed) {
    constexpr int candidates = 4000;
    Random random(seed);
    SurfacePoint point;
    int kept = 0;
    for (int i = 0; i < candidates; ++i) kept += solid.sample(random, point);
    return solid.primitive_area() * kept / candidates;
}

/// Sets the size, and the Euler characteristic of solids with large features.
void classify(const Solid& solid, double voxel, Trial& trial) {
    const double posed = thinnest_posed * voxel, large = thinnest_large * voxel;
    if (least_facing_distance(solid, trial.cloud, posed, grazing) < posed) return;
    trial.size = FeatureSize::thin;
    if (least_facing_distance(solid, trial.cloud, large, sharp) < large) return;
    Box bounds = trial.cloud.bounds();
    const double margin = 2 * voxel;
    bounds.lo -= Vec3(margin, margin, margin);
    bounds.hi += Vec3(margin, margin, margin);
    const DenseSolid coarse(solid, bounds, voxel / 3.3);
    trial.euler = coarse.surface_euler();
    if (coarse.grown(large / 2).surface_euler() != trial.euler) return;
    if (coarse.grown(-large / 2).surface_euler() != trial.euler) return;
    if (DenseSolid(solid, bounds, voxel / 4.7).surface_euler() != trial.euler) return;
    trial.size = FeatureSize::large;
}

} // namespace

Trial make_trial(std::uint64_t seed, const TrialOptions& options) {
    const double h = options.voxel;
    const Solid solid = random_solid(seed, options.thinnest * h, options.thickest * h);
    Trial trial{seed, FeatureSize::ill_posed, 0, {}};
    const double area = boundary_area(solid, seed);
    if (area < h * h) return trial; // nothing, or nearly nothing, is left of it
    const SampleOptions sampling{
        .points = static_cast<std::size_t>(options.points_per_voxel * area / (h * h)), .seed = seed};
    trial.cloud = sample(solid, sampling);
    classify(solid, h, trial);
    return trial;
}

} // namespace hsdm::support
