#include "hsdm/contour/sheet_widths.hh"

#include "hsdm/contour/constants.hh"
#include "hsdm/contour/plane_area.hh"
#include "hsdm/core/chunks.hh"

#include <algorithm>
#include <cmath>

namespace hsdm {
namespace {

/// Of the set's plane, inside its voxel.
double area_in_voxel(const OctreeLevel& level, const NormalSet& set) {
    const VoxelCoord c = level.coord(set.voxel);
    const Vec3 lo = Vec3(c[0], c[1], c[2]) * level.voxel_size;
    return plane_area(set.normal, set.normal | set.centroid, lo, level.voxel_size, {});
}

bool is_opposed(const NormalSet& a, const NormalSet& b) {
    return (a.normal | b.normal) < patches::opposed_cosine
           && std::min(a.count, b.count) >= widths::least_points;
}

SheetPair measure_pair(const OctreeLevel& level, const NormalSet& a, const NormalSet& b) {
    const Vec3 across = (a.normal - b.normal).normalized();
    const double width = std::abs(across | (b.centroid - a.centroid));
    const double area = area_in_voxel(level, a) + area_in_voxel(level, b);
    const double spacing = std::sqrt(area / (a.count + b.count));
    return {width / spacing, 0.5 * (a.centroid + b.centroid)};
}

/// Does a wall or gap part one of the voxel's sets from another?
bool parts_something(const NormalSets& sets, Index voxel) {
    return sets.first_apart[sets.first[voxel]] < sets.first_apart[sets.first[voxel + 1]];
}

} // namespace

std::optional<SheetPair> nearest_pair(const OctreeLevel& level, const NormalSets& sets, Index voxel) {
    std::optional<SheetPair> nearest;
    const auto own = sets.of_voxel(voxel);
    for (std::size_t i = 0; i < own.size(); ++i)
        for (std::size_t j = i + 1; j < own.size(); ++j) {
            if (!is_opposed(own[i], own[j])) continue;
            const SheetPair pair = measure_pair(level, own[i], own[j]);
            if (!nearest || pair.spacings < nearest->spacings) nearest = pair;
        }
    return nearest;
}

Doubts crowded_sheets(const OctreeLevel& level, const NormalSets& sets, double least) {
    if (sets.first_apart.empty()) return {};
    const std::vector<Index> found = indices_where(level.size(), chunks::usual, [&](Index v) {
        if (!parts_something(sets, v)) return false;
        const auto pair = nearest_pair(level, sets, v);
        return pair && pair->spacings < least;
    });
    if (found.empty()) return {};
    return {found.size(), nearest_pair(level, sets, found.front())->middle};
}

} // namespace hsdm
