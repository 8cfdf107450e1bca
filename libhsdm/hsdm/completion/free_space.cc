#include "hsdm/completion/free_space.hh"

#include "hsdm/completion/constants.hh"
#include "hsdm/core/constants.hh"
#include "hsdm/core/groups.hh"
#include "hsdm/core/parallel_sort.hh"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

namespace hsdm {
namespace {

/// The bin of a direction, which is not 0, on a cube of 2^level bins along an edge.
VoxelCoord bin_of(const Vec3& way, int level) {
    const double bins = std::ldexp(1.0, level), scale = 0.5 / way.max_abs();
    VoxelCoord c;
    for (unsigned k = 0; k < 3; ++k)
        c[k] = static_cast<int>(std::min(bins - 1, std::floor((way[k] * scale + 0.5) * bins)));
    return c;
}

/// How many of the points lie in bins, 2^level along an edge, that hold so many at least.
template <class Ray>
std::size_t in_full_bins(const std::vector<Ray>& rays, int level, std::size_t least) {
    const int shift = 3 * (morton_levels - level);
    std::size_t full = 0, first = 0;
    for (std::size_t i = 1; i <= rays.size(); ++i) {
        if (i < rays.size() && rays[i].code >> shift == rays[first].code >> shift) continue;
        if (i - first >= least) full += i - first;
        first = i;
    }
    return full;
}

} // namespace

FreeSpace::FreeSpace(const Octree& octree, const Viewpoints& viewpoints, double voxel_size)
    : voxel_size_(voxel_size) {
    if (viewpoints.sensors.empty()) return;
    std::vector<Index> place; // per scanner, the first one at the same place: they are one
    for (const Vec3& sensor : viewpoints.sensors)
        place.push_back(
            static_cast<Index>(std::ranges::find(viewpoints.sensors, sensor) - viewpoints.sensors.begin()));
    std::vector<Index> scanner = large_vector<Index>(octree.size());
    for_each_index(octree.size(), chunks::light, [&](Index i) {
        const Vec3* from = is_measured(octree.source[i]) ? viewpoints.of(octree.source[i]) : nullptr;
        scanner[i] = from != nullptr && *from != octree.positions[i]
                         ? place[static_cast<std::size_t>(from - viewpoints.sensors.data())]
                         : no_index;
    });
    const Groups seen(scanner, viewpoints.sensors.size());
    for (std::size_t s = 0; s < viewpoints.sensors.size(); ++s) {
        const std::span<const Index> points = seen.of(s);
        if (points.empty()) continue;
        std::vector<Ray> rays = unwritten_vector<Ray>(points.size());
        for_each_index(points.size(), chunks::quick, [&](Index i) {
            rays[i] = Ray::between(viewpoints.sensors[s], octree.positions[points[i]]);
        });
        views_.push_back(view_of(viewpoints.sensors[s], std::move(rays)));
    }
}

FreeSpace::FreeSpace(std::span<const Vec3> scanners, std::vector<std::vector<Ray>>&& rays, double voxel_size)
    : voxel_size_(voxel_size) {
    for (std::size_t s = 0; s < scanners.size(); ++s)
        if (!rays[s].empty()) views_.push_back(view_of(scanners[s], std::move(rays[s])));
}

FreeSpace::Ray FreeSpace::Ray::between(const Vec3& scanner, const Vec3& point) {
    const Vec3 way = point - scanner;
    return {morton_encode(bin_of(way, morton_levels)), way.norm()};
}

FreeSpace::View FreeSpace::view_of(const Vec3& from, std::vector<Ray> rays) {
    parallel_sort(rays, [](const Ray& a, const Ray& b) {
        return std::tie(a.code, a.depth) < std::tie(b.code, b.depth);
    });
    View view{from, {}};
    for (int level = 1; level <= morton_levels; ++level) {
        if (level > 1 && 2 * in_full_bins(rays, level, seeing::points_per_bin) < rays.size()) break;
        view.levels.push_back(bins_of(rays, level));
    }
    return view;
}

FreeSpace::Bins FreeSpace::bins_of(const std::vector<Ray>& rays, int level) {
    const int shift = 3 * (morton_levels - level);
    Bins bins;
    std::vector<double> least;
    for_each_in_order(rays.size(), [&](std::size_t i) {
        const MortonCode code = rays[i].code >> shift;
        if (bins.codes.empty() || bins.codes.back() != code) {
            bins.codes.push_back(code);
            bins.points.push_back(0);
            least.push_back(rays[i].depth);
        }
        ++bins.points.back();
        least.back() = std::min(least.back(), rays[i].depth);
    });
    bins.index.build(bins.codes);
    bins.depth = copy_of_large(least);
    const int last = (1 << level) - 1;
    for_each_index(bins.codes.size(), chunks::usual, [&](Index b) {
        const VoxelCoord c = morton_decode(bins.codes[b]);
        for (const VoxelCoord& o : neighbor_offsets) {
            const VoxelCoord beside{c[0] + o[0], c[1] + o[1], c[2] + o[2]};
            if (std::ranges::any_of(beside, [&](int k) { return k < 0 || k > last; })) continue;
            if (const Index k = bins.index.find(morton_encode(beside)); k != no_index)
                bins.depth[b] = std::min(bins.depth[b], least[k]);
        }
    });
    return bins;
}

bool FreeSpace::View::sees_through(const Vec3& place, double voxel_size) const {
    const Vec3 way = place - from;
    const double distance = way.norm(), most = way.max_abs();
    // A bin is 2 / 2^level wide on a cube with faces at distance 1, less where these lie aslant.
    const double bins = 2 * most * most / (distance * voxel_size);
    if (!(bins >= 2)) return false;
    const int level =
        static_cast<int>(std::min<double>(std::ilogb(bins), static_cast<double>(levels.size())));
    const Bins& map = levels[static_cast<std::size_t>(level) - 1];
    const Index bin = map.index.find(morton_encode(bin_of(way, level)));
    return bin != no_index && map.points[bin] >= two_agree
           && map.depth[bin] > distance + seeing::margin * voxel_size;
}

bool FreeSpace::holds(const Vec3& place) const {
    return std::ranges::any_of(views_,
                               [&](const View& view) { return view.sees_through(place, voxel_size_); });
}

} // namespace hsdm
