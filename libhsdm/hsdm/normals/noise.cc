#include "hsdm/normals/noise.hh"

#include "hsdm/core/chunks.hh"
#include "hsdm/normals/constants.hh"
#include "hsdm/normals/plane_fit.hh"

#include <algorithm>
#include <array>
#include <cmath>

namespace hsdm {
namespace {

/// The points' distance from their plane, and the distance of the farthest of them.
struct Roughness {
    double distance = 0, reach = 0;
};

/// Root mean square distance from the plane of the nearest few, for the three parameters that a plane has.
Roughness roughness(const Octree& octree, std::span<const Index> around, std::size_t few, std::size_t i) {
    std::array<std::pair<double, Index>, 64> nearest;
    for (std::size_t k = 0; k < around.size(); ++k)
        nearest[k] = {(octree.positions[around[k]] - octree.positions[i]).sqrnorm(), around[k]};
    const std::size_t count = std::min(few, around.size());
    std::partial_sort(nearest.begin(), nearest.begin() + static_cast<std::ptrdiff_t>(count),
                      nearest.begin() + static_cast<std::ptrdiff_t>(around.size()));
    PlaneSums sums;
    sums.add(Vec3(0, 0, 0), 1);
    for (std::size_t k = 0; k < count; ++k)
        sums.add(octree.positions[nearest[k].second] - octree.positions[i], 1);
    const double freedom = std::max(1.0, static_cast<double>(count) - 2) / static_cast<double>(count + 1);
    return {std::sqrt(fit_plane(sums).variance / freedom),
            count > 0 ? std::sqrt(nearest[count - 1].first) : 0};
}

double lower_third(std::vector<double> values) {
    if (values.empty()) return 0;
    const auto lower = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 3);
    std::nth_element(values.begin(), lower, values.end());
    return *lower;
}

/// measure(point) of a sample of the points.
template <class Measure>
auto sampled(const Octree& octree, const Measure& measure) {
    const std::size_t stride = noise_stride(octree.size());
    std::vector<decltype(measure(0))> values((octree.size() + stride - 1) / stride);
    for_each_index(values.size(), chunks::slow, [&](Index r) { values[r] = measure(r * stride); });
    return values;
}

/// Every fourth point along the Morton curve, which keeps the sampling as even as it was.
Octree thinned(const Octree& octree) {
    Octree thin;
    thin.origin = octree.origin, thin.extent = octree.extent, thin.bounds = octree.bounds;
    for (std::size_t i = 0; i < octree.size(); ++i) {
        if (!is_of_thinned(i)) continue;
        thin.codes.push_back(octree.codes[i]);
        thin.positions.push_back(octree.positions[i]);
    }
    return thin;
}

/// Too few for another round, which uses a quarter of them?
bool is_few(std::size_t points) {
    return points < 4 * noise::fewest;
}

struct Scale {
    std::size_t few;
    /// most that counts as small against the reach: then that is about five deviations; where all is
    /// noise it is 0.23 and 0.30
    double small;
    double deviation; ///< of a normal distribution whose distances have this lower third
};
std::array<Scale, 2> scales() {
    return {Scale{noise::nearest, noise::small, 1.3}, Scale{2 * noise::nearest, noise::small_of_more, 1.13}};
}

/// What the points of a sample say at a scale.
struct ScaleNoise {
    double deviation;
    bool is_small; ///< against the reach
};
ScaleNoise noise_at(const Scale& scale, std::span<const Roughness> sample) {
    std::vector<double> distances, relative; // to the reach
    for (const Roughness& r : sample) {
        distances.push_back(r.distance);
        relative.push_back(r.reach > 0 ? r.distance / r.reach : 0);
    }
    return {scale.deviation * lower_third(std::move(distances)),
            lower_third(std::move(relative)) < scale.small};
}

/// Of samples, the `s`-th scale.
ScaleNoise noise_at(std::size_t s, std::span<const NoiseSample> samples) {
    std::vector<Roughness> sample;
    for (const NoiseSample& of_point : samples) sample.push_back({of_point.distance[s], of_point.reach[s]});
    return noise_at(scales()[s], sample);
}

void measure_at(std::size_t s, const Octree& octree, std::span<const Index> around, std::size_t i,
                NoiseSample& sample) {
    const Roughness found = roughness(octree, around, scales()[s].few, i);
    sample.distance[s] = found.distance, sample.reach[s] = found.reach;
}

} // namespace

std::size_t noise_stride(std::size_t points) {
    constexpr std::size_t samples = 1 << 14;
    return points / samples + 1;
}

std::vector<NoiseSample> noise_samples(const Octree& octree, std::span<const Index> points,
                                       const Neighbors& neighbors) {
    std::vector<NoiseSample> samples(points.size());
    for_each_index(points.size(), chunks::slow, [&](Index k) {
        samples[k].farthest = neighbors.reach[k];
        for (std::size_t s = 0; s < scales().size(); ++s)
            measure_at(s, octree, neighbors.of(k), points[k], samples[k]);
    });
    return samples;
}

std::optional<double> noise_deviation(std::span<const NoiseSample> samples, std::size_t points) {
    for (std::size_t s = 0; s < scales().size(); ++s) {
        const ScaleNoise found = noise_at(s, samples);
        const bool is_last = s + 1 == scales().size() && is_few(points);
        if (found.is_small || is_last) return found.deviation;
    }
    return std::nullopt;
}

std::vector<NoiseSample> noise_samples(const Octree& octree, const Neighbors& neighbors) {
    return sampled(octree, [&](std::size_t i) {
        NoiseSample sample{.farthest = neighbors.reach[i]};
        measure_at(0, octree, neighbors.of(i), i, sample);
        return sample;
    });
}

double estimate_noise(const Octree& octree, const Neighbors& neighbors) {
    return estimate_noise(noise_samples(octree, neighbors));
}

double estimate_noise(std::span<const NoiseSample> samples) {
    std::vector<double> relative;
    for (const NoiseSample& of_point : samples)
        relative.push_back(of_point.farthest > 0 ? of_point.distance.front() / of_point.farthest : 0);
    return lower_third(std::move(relative));
}

double noise_deviation(const Octree& octree, const Neighbors& neighbors) {
    return noise_deviation(octree, neighbors, noise_samples(octree, neighbors));
}

double noise_deviation(const Octree& octree, const Neighbors& neighbors,
                       std::span<const NoiseSample> samples) {
    if (const ScaleNoise found = noise_at(0, samples); found.is_small) return found.deviation;
    const ScaleNoise found = noise_at(scales()[1], sampled(octree, [&](std::size_t i) {
                                          return roughness(octree, neighbors.of(i), scales()[1].few, i);
                                      }));
    if (found.is_small || is_few(octree.size())) return found.deviation;
    const Octree thin = thinned(octree);
    return noise_deviation(thin, find_neighbors(thin));
}

int neighbors_for_noise(double noise) {
    return noise < noise::rough ? neighborhoods::neighbors : noise < noise::very_rough ? 32 : 64;
}

} // namespace hsdm
