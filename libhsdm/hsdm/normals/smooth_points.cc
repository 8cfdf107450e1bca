#include "hsdm/normals/smooth_points.hh"

#include "hsdm/core/check_option.hh"
#include "hsdm/core/chunks.hh"
#include "hsdm/normals/constants.hh"
#include "hsdm/normals/neighborhood.hh"
#include "hsdm/normals/noise.hh"
#include "hsdm/normals/outliers.hh"
#include "hsdm/normals/plane_fit.hh"
#include "hsdm/octree/spacing.hh"

#include <algorithm>
#include <cmath>

namespace hsdm {
namespace {

/// Points, mean and second moments about it of one voxel.
struct VoxelSums {
    double count = 0;
    Vec3 mean{0, 0, 0};
    std::array<double, 6> spread{}; // xx, yy, zz, xy, yz, zx, summed
};

void add(PlaneSums& sums, const VoxelSums& voxel, const Vec3& base, double weight) {
    sums.add(voxel.mean - base, weight * voxel.count);
    for (std::size_t k = 0; k < 6; ++k) sums.second[k] += weight * voxel.spread[k];
}

/// Points in voxels, and what lies round each: all voxels that come within `reach` of its own.
class Surroundings {
public:
    Surroundings(const std::vector<Vec3>& positions, double edge) : points_(in_voxels(positions, edge)) {
        level_ = extract_level(points_, depth_);
    }

    const Vec3& origin() const { return points_.origin; }
    std::size_t voxels() const { return level_.size(); }

    /// work(position relative to the origin, index among the positions given) for the points of a voxel.
    template <class Work>
    void for_points_of(Index voxel, const Work& work) const {
        for (Index i = level_.first_point[voxel]; i < level_.first_point[voxel + 1]; ++i)
            work(points_.positions[i], points_.source[i]);
    }

    /// work(position relative to the origin, index among the positions given, voxels around) for all points.
    template <class Work>
    void for_each_point(const Work& work) const {
        for_chunks(level_.size(), chunks::heavy, [&](std::size_t begin, std::size_t end, std::size_t) {
            std::vector<Index> around;
            for (auto v = static_cast<Index>(begin); v < end; ++v) {
                find_around(v, around);
                for_points_of(v, [&](const Vec3& p, Index i) { work(p, i, around); });
            }
        });
    }

private:
    /// The points in a cube for which the voxels of some level have the edge wanted.
    Octree in_voxels(const std::vector<Vec3>& positions, double edge) {
        PointCloud cloud;
        cloud.positions = positions;
        const double extent = cloud.bounds().extent();
        double cube = edge;
        for (depth_ = 0; cube < extent && depth_ < morton_levels; ++depth_) cube *= 2;
        return build_octree(cloud, {.merge_duplicates = false, .cube_extent = std::max(cube, extent)});
    }

    void find_around(Index voxel, std::vector<Index>& around) const {
        const VoxelCoord c = level_.coord(voxel);
        around.clear();
        for (std::int32_t z = -smoothing::reach; z <= smoothing::reach; ++z)
            for (std::int32_t y = -smoothing::reach; y <= smoothing::reach; ++y)
                for (std::int32_t x = -smoothing::reach; x <= smoothing::reach; ++x)
                    if (const Index v = level_.find(VoxelCoord{c[0] + x, c[1] + y, c[2] + z}); v != no_index)
                        around.push_back(v);
    }

    int depth_ = 0;
    Octree points_;
    OctreeLevel level_;
};

/// Moved points, and the normals, of either sign, of the planes that they were moved to.
struct MovedPoints {
    std::vector<Vec3> positions, normals;
};

class Smoothing {
public:
    Smoothing(double spacing, double noise)
        : radius_(
            std::max(smoothing::least_radius * noise, smoothing::steady_radius * std::sqrt(noise * spacing))),
          inverse_radius_(1 / radius_),
          inverse_gap_(1 / (smoothing::another_sheet * noise)) {}

    /// Each point on the plane of its surroundings.
    MovedPoints onto_planes(const std::vector<Vec3>& positions) const {
        const Surroundings surroundings = around(positions);
        const std::vector<VoxelSums> sums = sums_of(surroundings);
        MovedPoints moved{std::vector<Vec3>(positions.size()), std::vector<Vec3>(positions.size())};
        surroundings.for_each_point([&](const Vec3& p, Index i, const std::vector<Index>& around) {
            moved.positions[i] = project(p, sums, around, moved.normals[i]) + surroundings.origin();
        });
        return moved;
    }

    /// A plane through a bent sheet lies on its hollow side, so all points came to lie there. What tells how
    /// far is where they came from: they scatter about the true surface, so the mean of their ways back says
    /// where that is. Moves the points by it, along their normals (twicing: Tukey 1977).
    void undo_shrinking(const std::vector<Vec3>& from, MovedPoints& moved) const {
        const Surroundings surroundings = around(moved.positions);
        const std::vector<WayBack> ways = ways_back(surroundings, from, moved.positions);
        std::vector<Vec3> centred(moved.positions.size());
        surroundings.for_each_point([&](const Vec3& p, Index i, const std::vector<Index>& around) {
            const Vec3& normal = moved.normals[i];
            double sum = 0, way = 0;
            for (const Index v : around) {
                const double weight = ways[v].count * weight_of(ways[v].at - p, normal);
                sum += weight, way += weight * (ways[v].way | normal);
            }
            centred[i] = moved.positions[i] + (sum > 0 ? way / sum : 0) * normal;
        });
        moved.positions = std::move(centred);
    }

private:
    /// Points, their mean, and that of their ways back, of one voxel.
    struct WayBack {
        double count = 0;
        Vec3 at{0, 0, 0}, way{0, 0, 0};
    };

    Surroundings around(const std::vector<Vec3>& positions) const {
        return {positions, radius_ / smoothing::reach};
    }
    double weight_of(const Vec3& away, const Vec3& normal) const {
        return closeness(away.norm(), inverse_radius_) * closeness(away | normal, inverse_gap_);
    }

    static std::vector<VoxelSums> sums_of(const Surroundings& surroundings) {
        std::vector<VoxelSums> sums(surroundings.voxels());
        for_each_index(sums.size(), chunks::heavy, [&](Index v) {
            VoxelSums& sum = sums[v];
            surroundings.for_points_of(v, [&](const Vec3& p, Index) { sum.mean += p, ++sum.count; });
            sum.mean /= sum.count;
            PlaneSums spread;
            surroundings.for_points_of(v, [&](const Vec3& p, Index) { spread.add(p - sum.mean, 1); });
            sum.spread = spread.second;
        });
        return sums;
    }

    static std::vector<WayBack> ways_back(const Surroundings& surroundings, const std::vector<Vec3>& from,
                                          const std::vector<Vec3>& to) {
        std::vector<WayBack> ways(surroundings.voxels());
        for_each_index(ways.size(), chunks::heavy, [&](Index v) {
            WayBack& mean = ways[v];
            surroundings.for_points_of(
                v, [&](const Vec3& p, Index i) { mean.at += p, mean.way += from[i] - to[i], ++mean.count; });
            mean.at /= mean.count, mean.way /= mean.count;
        });
        return ways;
    }

    /// Projects onto the plane around the point itself, then onto that around the result.
    Vec3 project(const Vec3& point, const std::vector<VoxelSums>& voxels, const std::vector<Index>& around,
                 Vec3& normal) const {
        Vec3 p = point;
        normal = Vec3(0, 0, 0);
        for (int round = 0; round < smoothing::rounds; ++round) {
            PlaneSums sums;
            for (const Index v : around) {
                const double weight = weight_of(voxels[v].mean - p, normal);
                if (weight > 0) add(sums, voxels[v], p, weight);
            }
            const PlaneFit plane = fit_plane(sums);
            if (plane.normal.sqrnorm() == 0) return p;
            normal = plane.normal;
            p += normal * (plane.centroid | normal);
        }
        return p;
    }

    double radius_, inverse_radius_, inverse_gap_;
};

/// Most points lie on surfaces that no smoothing moves; creases move theirs farther, so the lower third of
/// the moves is taken, which is 0.43 standard deviations.
double noise_of_moves(const std::vector<Vec3>& from, const std::vector<Vec3>& to) {
    constexpr double lower_third = 0.4307;
    std::vector<double> moves(from.size());
    for (std::size_t i = 0; i < moves.size(); ++i) moves[i] = (to[i] - from[i]).norm();
    const auto third = moves.begin() + static_cast<std::ptrdiff_t>(moves.size() / 3);
    std::nth_element(moves.begin(), third, moves.end());
    return *third / lower_third;
}

void validate(const SmoothOptions& options) {
    check_option(options.least_noise >= 0, "least_noise", options.least_noise, "be 0 or more");
    check_option(options.most_stretch > 1, "most_stretch", options.most_stretch, "be above 1");
}

} // namespace

double smooth_points(Octree& octree, double noise) {
    const double spacing = estimate_spacing(octree);
    MovedPoints moved;
    for (int round = 0; round < smoothing::most_rounds; ++round) {
        const Smoothing smoothing(spacing, noise);
        moved = smoothing.onto_planes(octree.positions);
        const double found = noise_of_moves(octree.positions, moved.positions);
        const bool again = found > 0 && found <= smoothing::clearly_less * noise;
        if (!again || round + 1 == smoothing::most_rounds) smoothing.undo_shrinking(octree.positions, moved);
        if (!again) break;
        noise = found;
    }
    rearrange(octree, std::move(moved.positions), octree.extent);
    return noise;
}

SmoothReport smooth_noise(Octree& octree, Neighbors& neighbors, const SmoothOptions& options) {
    validate(options);
    const double noise = noise_deviation(octree, neighbors);
    if (noise <= options.least_noise * estimate_spacing(octree)) return {};
    return smooth_known_noise(octree, noise, neighbors, options);
}

SmoothReport smooth_known_noise(Octree& octree, double noise, Neighbors& neighbors,
                                const SmoothOptions& options) {
    validate(options);
    SmoothReport report;
    report.noise = smooth_points(octree, noise);
    neighbors = find_neighbors(octree);
    report.between = drop_outliers_by_distance(
        octree, neighbors, {.most_stretch = options.most_stretch, .rounds = smoothing::removal_rounds});
    return report;
}

} // namespace hsdm
