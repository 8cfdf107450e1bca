#include "hsdm/octree/far_points.hh"

#include "hsdm/chunks.hh"
#include "hsdm/octree/spacing.hh"

#include <algorithm>

namespace hsdm {
namespace {

constexpr std::size_t points_per_chunk = 1 << 14;
constexpr int deepest = 16; // level of voxels

/// All but the outer two percent along each axis, of a sample.
Box box_of_most(const Octree& octree, const PointCloud& cloud) {
    constexpr std::size_t samples = 1 << 12;
    const std::size_t stride = octree.size() / samples + 1;
    Box box{Vec3(0, 0, 0), Vec3(0, 0, 0)};
    std::vector<double> values;
    for (unsigned axis = 0; axis < 3; ++axis) {
        values.clear();
        for (std::size_t i = 0; i < octree.size(); i += stride)
            values.push_back(cloud.positions[octree.source[i]][axis]);
        std::sort(values.begin(), values.end());
        const std::size_t outer = std::max<std::size_t>(1, values.size() / 50);
        if (2 * outer >= values.size()) return box;
        box.lo[axis] = values[outer];
        box.hi[axis] = values[values.size() - 1 - outer];
    }
    return box;
}

/// Takes the marks off what is a part: marked points of a voxel that have the space around for themselves.
/// Strays over a volume are 512 times as many in a voxel eight times as large.
void spare_parts(const Octree& octree, std::vector<std::uint8_t>& far) {
    constexpr Index fewest = 64; // eight voxels of a surface, by eight points each
    constexpr unsigned levels_around = 3;
    const auto& codes = octree.codes;
    std::vector<Index> marked(codes.size() + 1, 0); // of the points before
    for (std::size_t i = 0; i < codes.size(); ++i) marked[i + 1] = marked[i] + far[i];
    for (unsigned level = morton_levels; level >= levels_around; --level) {
        const unsigned shift = 3 * (morton_levels - level), shift_around = shift + 3 * levels_around;
        for (std::size_t begin = 0, end = 0; begin < codes.size(); begin = end) {
            while (end < codes.size() && codes[end] >> shift == codes[begin] >> shift) ++end;
            const Index count = marked[end] - marked[begin];
            if (count < fewest) continue;
            const auto place = [&](MortonCode first) { // of the first point that is not before
                return std::partition_point(codes.begin(), codes.end(),
                                            [&](MortonCode c) { return c >> shift_around < first; })
                       - codes.begin();
            };
            const MortonCode around = codes[begin] >> shift_around;
            const auto first = place(around), last = place(around + 1);
            if (static_cast<std::size_t>(last - first) <= 2 * std::size_t{count})
                std::fill(far.begin() + first, far.begin() + last, std::uint8_t{0});
        }
    }
}

/// Positions as the frame has them, in a cube about their box. False, and nothing done, if that has no size.
bool take_anew(Octree& octree, const PointCloud& cloud, const CloudFrame& frame) {
    std::vector<Vec3> positions(octree.size());
    for_chunks(positions.size(), points_per_chunk, [&](std::size_t begin, std::size_t end, std::size_t) {
        for (std::size_t i = begin; i < end; ++i)
            positions[i] = frame.to_work(cloud.positions[octree.source[i]]);
    });
    const Box bounds = bounds_of(positions);
    if (!(bounds.extent() > 0)) return false;
    octree.bounds = bounds;
    octree.extent = bounds.extent();
    octree.origin = centred_origin(bounds, octree.extent);
    for (Vec3& p : positions) p -= octree.origin;
    rearrange(octree, std::move(positions), octree.extent);
    return true;
}

/// Cuts gaps along every axis. Returns the longest stretch between cuts.
double cut_gaps(const Octree& octree, const PointCloud& cloud, double widest, CloudFrame& frame) {
    const CloudFrame uncut = frame = frame.without_cuts();
    std::vector<double> coordinates(octree.size());
    double longest = 0;
    for (unsigned axis = 0; axis < 3; ++axis) {
        for_chunks(coordinates.size(), points_per_chunk,
                   [&](std::size_t begin, std::size_t end, std::size_t) {
                       for (std::size_t i = begin; i < end; ++i)
                           coordinates[i] = uncut.to_work(cloud.positions[octree.source[i]])[axis];
                   });
        longest = std::max(longest, frame.cut_gaps(axis, coordinates, widest));
    }
    return longest;
}

} // namespace

Discarded drop_far_away(Octree& octree, const PointCloud& cloud, CloudFrame& frame) {
    constexpr double cubes_least = 1 << 12, margin = 1 << 10; // of the box that most points lie in
    const Box core = box_of_most(octree, cloud); // as the cloud has it: strays may have made its unit huge
    const double extent = core.extent();
    if (!(extent > 0) || cubes_least * extent >= octree.extent * frame.unit()) return {};
    std::vector<std::uint8_t> far(octree.size(), 0);
    for (std::size_t i = 0; i < far.size(); ++i) {
        const Vec3& p = cloud.positions[octree.source[i]];
        const Vec3 below = core.lo - p, above = p - core.hi;
        far[i] = std::max(below.max(), above.max()) > margin * extent;
    }
    spare_parts(octree, far);
    Discarded discarded = remove_points(octree, far);
    if (discarded.count == 0) return {};
    discarded.first = frame.to_cloud(discarded.first);
    Box left;
    for (Index point : octree.source) left.add(cloud.positions[point]);
    frame = CloudFrame(left);
    take_anew(octree, cloud, frame);
    return discarded;
}

void cut_empty_space(Octree& octree, const PointCloud& cloud, CloudFrame& frame, double least_gap) {
    constexpr double spacings_per_voxel = 3, gaps_per_extent = 1 << 12;
    if (spacings_per_voxel * estimate_spacing(octree) >= octree.voxel_size(deepest)) return;
    double widest = std::max(octree.extent / gaps_per_extent, least_gap);
    for (;;) {
        const double longest = cut_gaps(octree, cloud, widest, frame);
        if (!frame.has_cuts()) return;
        if (widest <= std::max(2 * longest, least_gap))
            break; // as wide as parts: apart at any depth they show
        widest = std::max(longest, least_gap);
    }
    take_anew(octree, cloud, frame);
}

} // namespace hsdm
