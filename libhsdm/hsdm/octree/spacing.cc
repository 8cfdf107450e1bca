#include "hsdm/octree/spacing.hh"

#include "hsdm/octree/constants.hh"

#include <cassert>
#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace hsdm {
namespace {

using Counts = std::array<std::size_t, morton_levels + 1>;

/// Voxels that a surface crosses per area of a voxel face, averaged over all directions.
constexpr double voxels_per_area = 1.5;

/// Counts places: points at one place with different normals sample the surface there once.
std::size_t count_places(const Octree& octree, std::size_t codes) {
    if (codes == octree.size()) return codes; // no two share one
    std::size_t count = octree.size();
    for (std::size_t i = 1; i < octree.size(); ++i)
        count -= octree.codes[i] == octree.codes[i - 1] && octree.positions[i] == octree.positions[i - 1];
    return count;
}

} // namespace

std::array<std::size_t, morton_levels + 1> count_voxels(const Octree& octree) {
    assert(octree.codes.size() == octree.size());
    // begins[l]: points whose predecessor shares their voxel at level l - 1 but not at level l.
    using Begins = std::array<std::size_t, morton_levels + 2>;
    const Begins begins = tbb::parallel_reduce(
        tbb::blocked_range<std::size_t>(1, std::max<std::size_t>(octree.size(), 1), 1 << 14), Begins{},
        [&](const tbb::blocked_range<std::size_t>& range, Begins sum) {
            for (std::size_t i = range.begin(); i != range.end(); ++i)
                ++sum[static_cast<std::size_t>(split_level(octree.codes[i - 1], octree.codes[i]))];
            return sum;
        },
        [](Begins a, const Begins& b) {
            for (std::size_t l = 0; l < a.size(); ++l) a[l] += b[l];
            return a;
        });
    Counts counts;
    std::size_t sum = octree.size() > 0 ? 1 : 0;
    for (unsigned level = 0; level <= morton_levels; ++level) counts[level] = sum += begins[level];
    return counts;
}

VoxelCounts count_places(const Octree& octree) {
    VoxelCounts counts{count_voxels(octree)};
    counts.places = count_places(octree, counts.voxels.back());
    return counts;
}

double estimate_spacing(const Octree& octree) {
    return estimate_spacing(count_places(octree), octree.extent);
}

double estimate_spacing(const VoxelCounts& places, double cube_extent) {
    const Counts& counts = places.voxels;
    const auto n = static_cast<double>(places.places);
    unsigned level = morton_levels;
    while (level > 0 && n < spacings::points_per_voxel * static_cast<double>(counts[level])) --level;
    const double h = cube_extent / static_cast<double>(1u << level);
    const auto voxels = static_cast<double>(counts[level]);
    const double seen = 1 - std::min(0.5, spacings::empty_share * std::sqrt(voxels / n));
    return h * std::sqrt(voxels / (voxels_per_area * seen * n));
}

VoxelChoice choose_voxel(const Octree& octree, double spacing, double noise, double unit,
                         double spacings_per_voxel) {
    VoxelChoice choice;
    char text[160];
    if (spacings::noises_per_voxel * noise > spacings_per_voxel * spacing) {
        choice.size = spacings::noises_per_voxel * noise;
        std::snprintf(text, sizeof text,
                      "%g times the noise (standard deviation %.4g, spacing of the points %.4g)",
                      spacings::noises_per_voxel, noise * unit, spacing * unit);
    } else {
        choice.size = spacings_per_voxel * spacing;
        std::snprintf(text, sizeof text, "%g spacings of the points (spacing %.4g)", spacings_per_voxel,
                      spacing * unit);
    }
    choice.size = std::clamp(choice.size, octree.voxel_size(deepest_level), octree.voxel_size(1));
    choice.reason = text;
    return choice;
}

DepthChoice choose_depth(const Octree& octree, double spacing, double spacings_per_voxel, double unit) {
    DepthChoice choice;
    while (choice.depth < deepest_level
           && octree.voxel_size(choice.depth + 1) >= spacings_per_voxel * spacing)
        ++choice.depth;
    char text[160];
    std::snprintf(text, sizeof text,
                  "the finest depth with voxels of at least %g spacings of the points (spacing %.4g)",
                  spacings_per_voxel, spacing * unit);
    choice.reason = text;
    return choice;
}

} // namespace hsdm
