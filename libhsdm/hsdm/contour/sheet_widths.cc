#include "hsdm/contour/sheet_widths.hh"

#include "hsdm/contour/constants.hh"
#include "hsdm/contour/plane_area.hh"
#include "hsdm/core/chunks.hh"
#include "hsdm/core/constants.hh"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

namespace hsdm {
namespace {

/// Of the set's plane, inside its voxel.
double area_in_voxel(const OctreeLevel& level, const NormalSet& set) {
    const VoxelCoord c = level.coord(set.voxel);
    const Vec3 lo = Vec3(c[0], c[1], c[2]) * level.voxel_size;
    return plane_area(set.normal, set.normal | set.centroid, lo, level.voxel_size, {});
}

/// Do two sets face each other or turn their backs, one before the other?
bool is_facing(const NormalSet& a, const NormalSet& b, double voxel_size) {
    if ((a.normal | b.normal) >= angles::opposed) return false;
    if (std::min(a.count, b.count) < points_of_plane) return false;
    const Vec3 way = b.centroid - a.centroid, across = (a.normal - b.normal).normalized();
    const double beside = sheets::beside * voxel_size;
    return way.sqrnorm() - (across | way) * (across | way) < beside * beside;
}

double width_between(const NormalSet& a, const NormalSet& b) {
    return std::abs((a.normal - b.normal).normalized() | (b.centroid - a.centroid));
}

/// Does a set turn as fast as round a cylinder two voxels in diameter, and is that what scatters its normals?
bool bends_like_cylinder(const Octree& octree, const OctreeLevel& level, const NormalSets& sets, Index s) {
    const NormalSet& set = sets.sets[s];
    const auto& m = set.spread.moments;
    const double along = m[0] + m[1] + m[2] - set.spread.along(set.normal);
    // half of what a cylinder of that width turns by
    if (!(std::abs(set.turn) * level.voxel_size * widths::of_cylinder > along)) return false;
    double scatter = 0;
    sets.for_points_of(s, level, [&](Index p) { scatter += (octree.normals[p] - set.normal).sqrnorm(); });
    return set.turn * set.turn * set.count > widths::explained * along * scatter;
}

/// The pairs that the sets of a voxel make with those of the same voxel and of its neighbours.
template <class Visit>
void for_facing_pairs(const OctreeLevel& level, const NormalSets& sets, Index voxel, const Visit& visit) {
    const auto visit_with = [&](Index other) {
        for (const NormalSet& a : sets.of_voxel(voxel))
            for (const NormalSet& b : sets.of_voxel(other))
                if (is_facing(a, b, level.voxel_size)) visit(a, b);
    };
    visit_with(voxel);
    for_neighbors(level, voxel, visit_with);
}

/// Does a wall or gap part one of the voxel's sets from another?
bool parts_something(const NormalSets& sets, Index voxel) {
    return sets.first_apart[sets.first[voxel]] < sets.first_apart[sets.first[voxel + 1]];
}

/// Is one of the voxels round this one in the ascending list?
bool has_neighbor(const OctreeLevel& level, Index voxel, const std::vector<Index>& list) {
    bool any = false;
    for_neighbors(level, voxel, [&](Index v) { any = any || std::ranges::binary_search(list, v); });
    return any;
}

} // namespace

std::optional<SheetPair> nearest_pair(const OctreeLevel& level, const NormalSets& sets, Index voxel) {
    double least = std::numeric_limits<double>::infinity(), area = 0, points = 0;
    Vec3 middle(0, 0, 0);
    for_facing_pairs(level, sets, voxel, [&](const NormalSet& a, const NormalSet& b) {
        area += area_in_voxel(level, a) + area_in_voxel(level, b);
        points += a.count + b.count;
        const double width = width_between(a, b);
        if (width >= least) return;
        least = width;
        middle = 0.5 * (a.centroid + b.centroid);
    });
    if (points == 0 || area == 0) return std::nullopt;
    return SheetPair{least / std::sqrt(area / points), middle};
}

Occurrences crowded_sheets(const OctreeLevel& level, const NormalSets& sets, double least) {
    if (sets.first_apart.empty()) return {};
    const std::vector<Index> found = indices_where(level.size(), chunks::usual, [&](Index v) {
        if (!parts_something(sets, v)) return false;
        const auto pair = nearest_pair(level, sets, v);
        return pair && pair->spacings < least;
    });
    Occurrences doubts;
    for (const Index v : found) {
        if (!has_neighbor(level, v, found)) continue;
        if (doubts.count++ == 0) doubts.first = nearest_pair(level, sets, v)->middle;
    }
    return doubts;
}

std::vector<Index> narrow_cylinders(const Octree& octree, const OctreeLevel& level, const NormalSets& sets) {
    const auto bends = [&](const NormalSet& set) {
        return bends_like_cylinder(octree, level, sets, static_cast<Index>(&set - sets.sets.data()));
    };
    const std::vector<Index> found = indices_where(level.size(), chunks::usual, [&](Index v) {
        bool any = false;
        for_facing_pairs(level, sets, v, [&](const NormalSet& a, const NormalSet& b) {
            any = any
                  || (width_between(a, b) < widths::of_cylinder * level.voxel_size && a.turn * b.turn > 0
                      && bends(a) && bends(b));
        });
        return any;
    });
    std::vector<Index> together;
    std::ranges::copy_if(found, std::back_inserter(together),
                         [&](Index v) { return has_neighbor(level, v, found); });
    return together;
}

std::size_t count_narrow_cylinders(const Octree& octree, const OctreeLevel& level, const NormalSets& sets) {
    return narrow_cylinders(octree, level, sets).size();
}

} // namespace hsdm
