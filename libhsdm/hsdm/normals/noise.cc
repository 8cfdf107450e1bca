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
Roughness roughness(const Octree& octree, const Neighbors& neighbors, std::size_t few, std::size_t i) {
    std::array<std::pair<double, Index>, 64> nearest;
    const auto around = neighbors.of(i);
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
    constexpr std::size_t samples = 1 << 14;
    const std::size_t stride = octree.size() / samples + 1;
    std::vector<decltype(measure(0))> values((octree.size() + stride - 1) / stride);
    for_each_index(values.size(), chunks::slow, [&](Index r) { values[r] = measure(r * stride); });
    return values;
}

/// Every fourth point along the Morton curve, which keeps the sampling as even as it was.
Octree thinned(const Octree& octree) {
    Octree thin;
    thin.origin = octree.origin, thin.extent = octree.extent, thin.bounds = octree.bounds;
    for (std::size_t i = 0; i < octree.size(); i += 4) {
        thin.codes.push_back(octree.codes[i]);
        thin.positions.push_back(octree.positions[i]);
    }
    return thin;
}

} // namespace

double estimate_noise(const Octree& octree, const Neighbors& neighbors) {
    return lower_third(sampled(octree, [&](std::size_t i) {
        return neighbors.reach[i] > 0
                   ? roughness(octree, neighbors, noise::nearest, i).distance / neighbors.reach[i]
                   : 0;
    }));
}

double noise_deviation(const Octree& octree, const Neighbors& neighbors) {
    struct Scale {
        std::size_t few;
        /// most that counts as small against the reach: then that is about five deviations; where all is
        /// noise it is 0.23 and 0.30
        double small;
        double deviation; ///< of a normal distribution whose distances have this lower third
    };
    double deviation = 0;
    for (const Scale& scale :
         {Scale{noise::nearest, noise::small, 1.3}, Scale{noise::more_nearest, noise::small_of_more, 1.13}}) {
        std::vector<double> distances, relative; // to the reach
        for (const Roughness& r :
             sampled(octree, [&](std::size_t i) { return roughness(octree, neighbors, scale.few, i); })) {
            distances.push_back(r.distance);
            relative.push_back(r.reach > 0 ? r.distance / r.reach : 0);
        }
        deviation = scale.deviation * lower_third(std::move(distances));
        if (lower_third(std::move(relative)) < scale.small) return deviation;
    }
    if (octree.size() < 4 * noise::fewest) return deviation; // the next round uses a quarter of them
    const Octree thin = thinned(octree);
    return noise_deviation(thin, find_neighbors(thin));
}

int neighbors_for_noise(double noise) {
    return noise < noise::rough ? neighborhoods::neighbors : noise < noise::very_rough ? 32 : 64;
}

} // namespace hsdm
