#include "hsdm/normals/steady_normals.hh"

#include "hsdm/core/chunks.hh"
#include "hsdm/core/constants.hh"
#include "hsdm/normals/constants.hh"
#include "hsdm/normals/estimate_normals.hh"
#include "hsdm/normals/vote_on_normals.hh"

#include <algorithm>
#include <cmath>

namespace hsdm {
namespace {

double median_angle(const std::vector<Vec3>& normals) {
    constexpr std::size_t samples = 1 << 14;
    const std::size_t stride = normals.size() / samples + 1;
    std::vector<double> cosines;
    for (std::size_t i = 0; i + 1 < normals.size(); i += stride)
        if (normals[i].sqrnorm() > 0 && normals[i + 1].sqrnorm() > 0)
            cosines.push_back(std::min(1.0, std::abs(normals[i] | normals[i + 1])));
    if (cosines.empty()) return 0;
    const auto middle = cosines.begin() + static_cast<std::ptrdiff_t>(cosines.size() / 2);
    std::nth_element(cosines.begin(), middle, cosines.end());
    return std::acos(*middle);
}

} // namespace

double scatter_of_normals(const Octree& octree) {
    return median_angle(octree.normals);
}

bool are_scattered(const Octree& octree) {
    return scatter_of_normals(octree) > scattered_normals::least;
}

std::size_t steady_normals(Octree& octree) {
    if (!octree.has_normals() || octree.size() < 2) return 0;
    const Neighbors neighbors = find_neighbors(octree);
    EstimatedNormals told = estimate_normals(octree, neighbors);
    told.normals = refined_normals(octree, neighbors, told);
    if (median_angle(told.normals) > scattered_normals::share * scatter_of_normals(octree)) return 0;
    for_each_index(octree.size(), chunks::light, [&](Index i) {
        if ((told.normals[i] | octree.normals[i]) < 0) told.normals[i] = -told.normals[i];
    });
    vote_on_normals(octree, neighbors, told); // near creases: with the sides they have now
    std::size_t changed = 0;
    for (std::size_t i = 0; i < octree.size(); ++i) {
        const double cosine = told.normals[i] | octree.normals[i];
        if (std::abs(cosine) < angles::facing) continue;
        octree.normals[i] = cosine < 0 ? -told.normals[i] : told.normals[i];
        ++changed;
    }
    return changed;
}

} // namespace hsdm
