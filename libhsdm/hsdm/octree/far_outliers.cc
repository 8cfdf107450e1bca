#include "hsdm/octree/far_outliers.hh"

#include "hsdm/cloud/strided.hh"
#include "hsdm/core/chunks.hh"
#include "hsdm/core/large_vector.hh"
#include "hsdm/core/parallel_sort.hh"
#include "hsdm/octree/constants.hh"
#include "hsdm/octree/spacing.hh"

#include <algorithm>

namespace hsdm {
namespace {

/// Points of a part, far from all else though it is: eight voxels of a surface.
std::size_t fewest_of_part() {
    return static_cast<std::size_t>(8 * spacings::points_per_voxel);
}

/// The box of all but the outer two percent of a sample along each axis.
Box box_of_most(const Octree& octree, const PointView& cloud) {
    constexpr std::size_t samples = 1 << 12;
    const std::size_t stride = octree.size() / samples + 1;
    Box box{Vec3(0, 0, 0), Vec3(0, 0, 0)};
    std::vector<double> values;
    for (unsigned axis = 0; axis < 3; ++axis) {
        values.clear();
        for (std::size_t i = 0; i < octree.size(); i += stride)
            values.push_back(vec3_at(cloud.positions, octree.source[i])[axis]);
        std::sort(values.begin(), values.end());
        const std::size_t outer = std::max<std::size_t>(1, values.size() / far_points::one_outer_in);
        if (2 * outer >= values.size()) return box;
        box.lo[axis] = values[outer];
        box.hi[axis] = values[values.size() - 1 - outer];
    }
    return box;
}

/// A point's code in some grid, and its place in the octree.
using Places = std::vector<std::pair<MortonCode, Index>>;

/// Codes in the grid of a cube twice as large whose least corner lies a third of a cube below: points
/// separated by the planes of one grid on all levels lie together in the other.
Places shifted_places(const Octree& octree) {
    constexpr double last = (1 << morton_levels) - 1;
    Places places(octree.size());
    for_each_index(places.size(), chunks::light, [&](Index i) {
        std::array<std::uint32_t, 3> c;
        for (unsigned k = 0; k < 3; ++k) {
            const double x = (octree.positions[i][k] / octree.extent + 1.0 / 3) / 2;
            c[k] = static_cast<std::uint32_t>(std::clamp(x * (last + 1), 0.0, last));
        }
        places[i] = {morton_encode(c[0], c[1], c[2]), i};
    });
    parallel_sort(places);
    return places;
}

/// Unmarks parts: marked points of a voxel that have the space around for themselves. (Outliers spread over a
/// volume are 512 times as many in a voxel eight times as large.)
void spare_parts(const Places& places, std::vector<std::uint8_t>& far) {
    constexpr unsigned levels_around = 3;
    std::vector<Index> marked(places.size() + 1, 0); // number of marked points before each
    for (std::size_t i = 0; i < places.size(); ++i) marked[i + 1] = marked[i] + far[places[i].second];
    for (unsigned level = morton_levels; level >= levels_around; --level) {
        const unsigned shift = 3 * (morton_levels - level), shift_around = shift + 3 * levels_around;
        for (std::size_t begin = 0, end = 0; begin < places.size(); begin = end) {
            while (end < places.size() && places[end].first >> shift == places[begin].first >> shift) ++end;
            const Index count = marked[end] - marked[begin];
            if (count < fewest_of_part()) continue;
            const auto place = [&](MortonCode first) { // place of the first point whose code is not below
                return std::partition_point(places.begin(), places.end(),
                                            [&](const auto& p) { return p.first >> shift_around < first; });
            };
            const MortonCode around = places[begin].first >> shift_around;
            const auto first = place(around), last = place(around + 1);
            if (static_cast<std::size_t>(last - first) <= 2 * std::size_t{count})
                for (auto p = first; p != last; ++p) far[p->second] = 0;
        }
    }
}

void spare_parts(const Octree& octree, std::vector<std::uint8_t>& far) {
    Places places(octree.size());
    for (std::size_t i = 0; i < places.size(); ++i) places[i] = {octree.codes[i], static_cast<Index>(i)};
    spare_parts(places, far);
    spare_parts(shifted_places(octree), far);
}

/// A frame for the points left: the removed ones may alone have made it large.
CloudFrame frame_of_rest(const Octree& octree, const PointView& cloud) {
    Box left;
    for (Index point : octree.source) left.add(vec3_at(cloud.positions, point));
    return CloudFrame(left);
}

/// Takes all positions again, in the frame, in a cube about their box. False, and nothing done, if that box
/// has no voxels, as for parts 2^1000 times as far apart as they are large.
bool take_anew(Octree& octree, const PointView& cloud, const CloudFrame& frame) {
    std::vector<Vec3> positions = large_vector<Vec3>(octree.size());
    for_each_index(positions.size(), chunks::light, [&](Index i) {
        positions[i] = frame.to_work(vec3_at(cloud.positions, octree.source[i]));
    });
    const Box bounds = bounds_of(positions);
    if (!has_voxels(bounds)) return false;
    octree.bounds = bounds;
    octree.extent = bounds.extent();
    octree.origin = centred_origin(bounds, octree.extent);
    for (Vec3& p : positions) p -= octree.origin;
    rearrange(octree, std::move(positions), octree.extent);
    return true;
}

/// Cuts gaps along every axis. Returns the longest stretch between cuts.
double cut_gaps(const Octree& octree, const PointView& cloud, double widest, CloudFrame& frame) {
    const CloudFrame uncut = frame = frame.without_cuts();
    std::vector<double> coordinates = large_vector<double>(octree.size());
    double longest = 0;
    for (unsigned axis = 0; axis < 3; ++axis) {
        for_each_index(coordinates.size(), chunks::light, [&](Index i) {
            coordinates[i] = uncut.to_work(vec3_at(cloud.positions, octree.source[i]))[axis];
        });
        longest = std::max(longest, frame.cut_gaps(axis, coordinates, widest));
    }
    return longest;
}

/// Marks the points of stretches between cuts that hold too few to be a part. Returns how many.
std::size_t mark_scraps(const Octree& octree, const PointView& cloud, const CloudFrame& frame,
                        std::vector<std::uint8_t>& marks) {
    const CloudFrame uncut = frame.without_cuts();
    std::vector<std::pair<std::array<Index, 3>, Index>> points(octree.size());
    for_each_index(points.size(), chunks::light, [&](Index i) {
        points[i] = {frame.stretch_of_uncut(uncut.to_work(vec3_at(cloud.positions, octree.source[i]))), i};
    });
    parallel_sort(points);
    std::size_t count = 0;
    marks.assign(points.size(), 0);
    for (std::size_t begin = 0, end = 0; begin < points.size(); begin = end) {
        while (end < points.size() && points[end].first == points[begin].first) ++end;
        if (end - begin >= fewest_of_part()) continue;
        for (std::size_t i = begin; i < end; ++i) marks[points[i].second] = 1;
        count += end - begin;
    }
    return count;
}

/// The frame with all gaps cut that are wide compared with parts; without cuts if there are none.
CloudFrame with_cuts(const Octree& octree, const PointView& cloud, CloudFrame frame, double least_gap) {
    double widest = std::max(octree.extent / far_points::boxes_across, least_gap);
    for (;;) {
        const double longest = cut_gaps(octree, cloud, widest, frame);
        if (!(longest > 0)) return frame.without_cuts();              // each stretch is a single place
        if (widest <= std::max(2 * longest, least_gap)) return frame; // kept gaps are as wide as parts
        widest = std::max(longest, least_gap);
    }
}

} // namespace

Occurrences drop_far_outliers(Octree& octree, const PointView& cloud, CloudFrame& frame) {
    // in the cloud's own units: outliers may have made the frame's unit huge
    const Box core = box_of_most(octree, cloud);
    const double extent = core.extent();
    if (!(extent > 0) || far_points::boxes_across * extent >= octree.extent * frame.unit()) return {};
    std::vector<std::uint8_t> far = large_vector<std::uint8_t>(octree.size(), 0);
    for (std::size_t i = 0; i < far.size(); ++i) {
        const Vec3 p = vec3_at(cloud.positions, octree.source[i]);
        const Vec3 below = core.lo - p, above = p - core.hi;
        far[i] = std::max(below.max(), above.max()) > far_points::boxes_across / 4 * extent;
    }
    spare_parts(octree, far);
    Occurrences discarded = remove_points(octree, far);
    if (discarded.count == 0) return {};
    discarded.first = frame.to_cloud(discarded.first);
    if (const CloudFrame rest = frame_of_rest(octree, cloud); take_anew(octree, cloud, rest)) frame = rest;
    return discarded;
}

Occurrences cut_empty_space(Octree& octree, const PointView& cloud, CloudFrame& frame, double least_gap) {
    Occurrences discarded;
    while (spacings::spacings_per_voxel * estimate_spacing(octree) < octree.voxel_size(deepest_level)) {
        const CloudFrame cut = with_cuts(octree, cloud, frame, least_gap / frame.unit());
        if (!cut.has_cuts()) return discarded;
        std::vector<std::uint8_t> marks;
        const std::size_t scraps = mark_scraps(octree, cloud, cut, marks);
        if (scraps * far_points::one_outer_in > octree.size()) // scattered, and no parts
            return discarded;
        if (scraps == 0) {
            if (take_anew(octree, cloud, cut)) frame = cut;
            return discarded;
        }
        Occurrences some = remove_points(octree, marks);
        some.first = frame.to_cloud(some.first);
        discarded.add(some);
        const CloudFrame rest = frame_of_rest(octree, cloud);
        if (!take_anew(octree, cloud, rest)) return discarded;
        frame = rest;
    }
    return discarded;
}

} // namespace hsdm
