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

/// Of pairs of each sampled point and its successor, those that check_normals() looks at. normal(i): of the
/// cloud.
template <class GetNormal>
double median_angle(std::size_t size, const GetNormal& normal) {
    const std::size_t stride = NormalSample::stride(size);
    std::vector<double> cosines;
    for (std::size_t begin = 0; begin < size; begin += chunks::light)
        for (std::size_t i = begin; i < std::min(begin + chunks::light, size - 1); i += stride) {
            const Vec3 &n = normal(i), &m = normal(i + 1);
            if (n.sqrnorm() > 0 && m.sqrnorm() > 0) cosines.push_back(std::min(1.0, std::abs(n | m)));
        }
    if (cosines.empty()) return 0;
    const auto middle = cosines.begin() + static_cast<std::ptrdiff_t>(cosines.size() / 2);
    std::nth_element(cosines.begin(), middle, cosines.end());
    return std::acos(*middle);
}

double median_angle(const std::vector<Vec3>& normals) {
    return median_angle(normals.size(), [&](std::size_t i) -> const Vec3& { return normals[i]; });
}

double median_angle(const NormalSample& sample, std::size_t size) {
    return median_angle(size, [&](std::size_t i) -> const Vec3& { return sample.at(i, size).normal; });
}

bool are_steadier(double angle, double of_given) {
    return angle <= 0.5 * of_given;
}

} // namespace

bool are_scattered(const Octree& octree) {
    return median_angle(octree.normals) > scattered_normals::least;
}

bool are_scattered(const NormalSample& sample, std::size_t size) {
    return median_angle(sample, size) > scattered_normals::least;
}

bool are_steadier(const NormalSample& told, const NormalSample& given, std::size_t size) {
    return are_steadier(median_angle(told, size), median_angle(given, size));
}

bool take_axis(const Vec3& told, Vec3& normal) {
    const double cosine = told | normal;
    if (std::abs(cosine) < angles::facing) return false;
    normal = cosine < 0 ? -told : told;
    return true;
}

std::size_t steady_normals(Octree& octree) {
    if (!octree.has_normals() || octree.size() < 2) return 0;
    const Neighbors neighbors = find_neighbors(octree);
    EstimatedNormals told = estimate_normals(octree, neighbors);
    told.normals = refined_normals(octree, neighbors, told);
    if (!are_steadier(median_angle(told.normals), median_angle(octree.normals))) return 0;
    turn_along(octree.normals, told.normals);
    vote_on_normals(octree, neighbors, told); // near creases: with the sides they have now
    std::size_t changed = 0;
    for (std::size_t i = 0; i < octree.size(); ++i) changed += take_axis(told.normals[i], octree.normals[i]);
    return changed;
}

} // namespace hsdm
