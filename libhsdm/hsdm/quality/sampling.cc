#include "hsdm/quality/sampling.hh"

#include "hsdm/cloud/cloud_frame.hh"
#include "hsdm/core/check_option.hh"
#include "hsdm/core/chunks.hh"
#include "hsdm/octree/spacing.hh"
#include "hsdm/spatial/neighbor_search.hh"

#include <algorithm>
#include <cmath>

namespace hsdm {
namespace {

/// Per place that is looked at, in the octree's units.
struct Reaches {
    std::vector<double> nearest; ///< distance of the nearest other
    std::vector<double> mean;    ///< of the distances of the nearest few
};

Reaches measure_reaches(const std::vector<Vec3>& places, const SamplingOptions& options) {
    const std::size_t step = (places.size() - 1) / options.most + 1;
    std::vector<Vec3> looked_at((places.size() - 1) / step + 1);
    for (std::size_t i = 0; i < looked_at.size(); ++i) looked_at[i] = places[i * step];
    const NearPoints found = NeighborSearch(places).nearest(looked_at, options.neighbors + 1);
    Reaches reaches{std::vector<double>(looked_at.size()), std::vector<double>(looked_at.size())};
    for_each_index(looked_at.size(), chunks::quick, [&](Index i) {
        const auto distances = found.distances_of(i).subspan(1); // the first is the place itself
        double sum = 0;
        for (double d : distances) sum += d;
        reaches.nearest[i] = distances.front();
        reaches.mean[i] = sum / static_cast<double>(distances.size());
    });
    return reaches;
}

double share_above(const std::vector<double>& values, double limit) {
    const auto above = std::count_if(values.begin(), values.end(), [limit](double x) { return x > limit; });
    return static_cast<double>(above) / static_cast<double>(values.size());
}

/// Three standard deviations above the mean.
double statistical_limit(const std::vector<double>& values) {
    const auto n = static_cast<double>(values.size());
    double sum = 0, squares = 0;
    for (double x : values) sum += x;
    const double mean = sum / n;
    for (double x : values) squares += (x - mean) * (x - mean);
    return mean + 3 * std::sqrt(squares / n);
}

} // namespace

Sampling measure_sampling(const PointCloud& cloud, const SamplingOptions& options) {
    check_option(options.neighbors >= 1 && options.neighbors <= 64, "neighbors", options.neighbors,
                 "lie in [1, 64]");
    check_option(options.isolation > 1, "isolation", options.isolation, "be more than 1");
    check_option(options.most > 0, "most", options.most, "be at least 1");
    check_arrays(cloud);
    if (!all_finite(cloud.positions))
        throw Error("the cloud holds coordinates that are not finite; call drop_nonfinite first");
    Sampling sampling;
    const Box box = cloud.bounds();
    if (!(box.extent() > 0)) {
        sampling.duplicates = cloud.size() > 0 ? cloud.size() - 1 : 0;
        return sampling;
    }
    const double unit = CloudFrame(box).unit();
    const Octree octree = build_octree(cloud, {.use_normals = false, .unit = unit});
    sampling.duplicates = octree.merged_duplicates;
    sampling.spacing = unit * estimate_spacing(octree);
    Reaches reaches = measure_reaches(octree.positions, options);
    for (double& length : reaches.nearest) length *= unit;
    sampling.nearest = percentiles_of(std::move(reaches.nearest));
    sampling.isolated = share_above(reaches.mean, options.isolation * percentiles_of(reaches.mean).median);
    sampling.statistical_outliers = share_above(reaches.mean, statistical_limit(reaches.mean));
    return sampling;
}

} // namespace hsdm
