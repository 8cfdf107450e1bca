#include "hsdm/normals/noise.hh"

#include "hsdm/chunks.hh"
#include "hsdm/normals/plane_fit.hh"

#include <algorithm>
#include <array>
#include <cmath>

namespace hsdm {
namespace {

/// Root mean square distance from the plane of the nearest few, for the three parameters that a plane has.
double roughness(const Octree& octree, const Neighbors& neighbors, std::size_t i) {
    constexpr std::size_t few = 6;
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
    return std::sqrt(fit_plane(sums).variance / freedom);
}

} // namespace

double estimate_noise(const Octree& octree, const Neighbors& neighbors) {
    constexpr std::size_t samples = 1 << 14, samples_per_chunk = 1024;
    const std::size_t stride = octree.size() / samples + 1;
    std::vector<double> ratios((octree.size() + stride - 1) / stride, 0);
    if (ratios.empty()) return 0;
    for_chunks(ratios.size(), samples_per_chunk, [&](std::size_t begin, std::size_t end, std::size_t) {
        for (std::size_t r = begin; r < end; ++r)
            if (const std::size_t i = r * stride; neighbors.reach[i] > 0)
                ratios[r] = roughness(octree, neighbors, i) / neighbors.reach[i];
    });
    const auto lower = ratios.begin() + static_cast<std::ptrdiff_t>(ratios.size() / 3);
    std::nth_element(ratios.begin(), lower, ratios.end());
    return *lower;
}

int neighbors_for_noise(double noise) {
    constexpr double rough = 0.06, very_rough = 0.13;
    return noise < rough ? 16 : noise < very_rough ? 32 : 64;
}

} // namespace hsdm
