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

class Smoothing {
public:
    Smoothing(const Octree& octree, double noise)
        : noise_(noise),
          radius_(std::max(smoothing::least_radius * noise,
                           smoothing::steady_radius * std::sqrt(noise * estimate_spacing(octree)))),
          grid_(grid_of(octree, radius_ / smoothing::reach)) {}

    /// The new positions, in the octree's order, relative to its origin.
    std::vector<Vec3> run() {
        sum_voxels();
        std::vector<Vec3> moved(grid_.size());
        for_chunks(level_.size(), chunks::heavy, [&](std::size_t begin, std::size_t end, std::size_t) {
            std::vector<Index> around;
            for (std::size_t v = begin; v < end; ++v) {
                find_around(static_cast<Index>(v), around);
                for (Index i = level_.first_point[v]; i < level_.first_point[v + 1]; ++i)
                    moved[grid_.source[i]] = project(grid_.positions[i], around) + grid_.origin;
            }
        });
        return moved;
    }

private:
    /// The same points in a cube for which the voxels of some level have the edge wanted.
    Octree grid_of(const Octree& octree, double edge) {
        PointCloud cloud;
        cloud.positions = octree.positions;
        const double extent = cloud.bounds().extent();
        double cube = edge;
        for (depth_ = 0; cube < extent && depth_ < morton_levels; ++depth_) cube *= 2;
        return build_octree(cloud, {.merge_duplicates = false, .cube_extent = std::max(cube, extent)});
    }

    void sum_voxels() {
        level_ = extract_level(grid_, depth_);
        sums_.resize(level_.size());
        for_each_index(level_.size(), chunks::heavy, [&](Index v) {
            const Index first = level_.first_point[v], last = level_.first_point[v + 1];
            VoxelSums& sum = sums_[v];
            sum.count = last - first;
            for (Index i = first; i < last; ++i) sum.mean += grid_.positions[i];
            sum.mean /= sum.count;
            PlaneSums spread;
            for (Index i = first; i < last; ++i) spread.add(grid_.positions[i] - sum.mean, 1);
            sum.spread = spread.second;
        });
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

    /// Projects onto the plane around the point itself, then onto that around the result.
    Vec3 project(const Vec3& point, const std::vector<Index>& around) const {
        const double inverse_radius = 1 / radius_, inverse_gap = 1 / (smoothing::another_sheet * noise_);
        Vec3 p = point, normal(0, 0, 0);
        for (int round = 0; round < smoothing::rounds; ++round) {
            PlaneSums sums;
            for (Index v : around) {
                const Vec3 d = sums_[v].mean - p;
                const double weight =
                    closeness(d.norm(), inverse_radius) * closeness(d | normal, inverse_gap);
                if (weight > 0) add(sums, sums_[v], p, weight);
            }
            const PlaneFit plane = fit_plane(sums);
            if (plane.normal.sqrnorm() == 0) return p;
            normal = plane.normal;
            p += normal * (plane.centroid | normal);
        }
        return p;
    }

    double noise_, radius_;
    int depth_ = 0;
    Octree grid_;
    OctreeLevel level_;
    std::vector<VoxelSums> sums_;
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
    std::vector<Vec3> moved;
    for (int round = 0; round < smoothing::most_rounds; ++round) {
        moved = Smoothing(octree, noise).run();
        const double found = noise_of_moves(octree.positions, moved);
        if (found > smoothing::clearly_less * noise || found == 0) break;
        noise = found;
    }
    rearrange(octree, std::move(moved), octree.extent);
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
