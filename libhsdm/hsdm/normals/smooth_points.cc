#include "hsdm/normals/smooth_points.hh"

#include "hsdm/core/check_option.hh"
#include "hsdm/core/chunks.hh"
#include "hsdm/core/constants.hh"
#include "hsdm/normals/constants.hh"
#include "hsdm/normals/neighborhood.hh"
#include "hsdm/normals/noise.hh"
#include "hsdm/normals/outliers.hh"
#include "hsdm/normals/plane_fit.hh"
#include "hsdm/octree/spacing.hh"

#include <algorithm>
#include <cmath>
#include <numbers>

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
    Surroundings(const std::vector<Vec3>& positions, double edge, std::int32_t reach)
        : reach_(reach), points_(in_voxels(positions, edge)) {
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

    /// work(voxel, voxels around) for all voxels.
    template <class Work>
    void for_each_voxel(const Work& work) const {
        for_chunks(level_.size(), chunks::heavy, [&](std::size_t begin, std::size_t end, std::size_t) {
            std::vector<Index> around;
            for (auto v = static_cast<Index>(begin); v < end; ++v) {
                find_around(v, around);
                work(v, around);
            }
        });
    }

    /// work(position relative to the origin, index among the positions given, voxels around) for all points.
    template <class Work>
    void for_each_point(const Work& work) const {
        for_each_voxel([&](Index v, const std::vector<Index>& around) {
            for_points_of(v, [&](const Vec3& p, Index i) { work(p, i, around); });
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
        for (std::int32_t z = -reach_; z <= reach_; ++z)
            for (std::int32_t y = -reach_; y <= reach_; ++y)
                for (std::int32_t x = -reach_; x <= reach_; ++x)
                    if (const Index v = level_.find(VoxelCoord{c[0] + x, c[1] + y, c[2] + z}); v != no_index)
                        around.push_back(v);
    }

    std::int32_t reach_;
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
          inverse_gap_(1 / (smoothing::least_radius * noise)) {}

    /// For the points of two sheets that mix: half as far off the plane the other one begins, so that each
    /// keeps a mode of its own; voxels half as wide do not hold both, and modes take more rounds than means.
    static Smoothing between_sheets(double spacing, double noise) {
        Smoothing result(spacing, noise);
        result.inverse_gap_ *= 2;
        result.reach_ *= 2;
        result.rounds_ *= 2;
        return result;
    }

    double radius() const { return radius_; }

    /// Each point on the plane of its surroundings; `normals` are those of planes to begin with, if known.
    MovedPoints onto_planes(const std::vector<Vec3>& positions, std::vector<Vec3> normals = {}) const {
        const Surroundings surroundings = around(positions);
        const std::vector<VoxelSums> sums = sums_of(surroundings);
        if (normals.empty()) normals = first_normals(surroundings, sums, positions.size());
        MovedPoints moved{std::vector<Vec3>(positions.size()), std::move(normals)};
        surroundings.for_each_point([&](const Vec3& p, Index i, const std::vector<Index>& around) {
            moved.positions[i] = project(p, sums, around, moved.normals[i]) + surroundings.origin();
        });
        return moved;
    }

    /// A plane through a bent sheet lies on its hollow side, so all points came to lie there. What tells how
    /// far is where they came from: they scatter about the true surface, so the mean of their ways back says
    /// where that is. Moves the points by it, along their normals (twicing: Tukey 1977).
    void undo_shrinking(const std::vector<Vec3>& from, const Surroundings& surroundings,
                        MovedPoints& moved) const {
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

    Surroundings around(const std::vector<Vec3>& positions) const {
        return {positions, radius_ / reach_, reach_};
    }

private:
    /// Points, their mean, and that of their ways back, of one voxel.
    struct WayBack {
        double count = 0;
        Vec3 at{0, 0, 0}, way{0, 0, 0};
    };

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

    /// All points around: those of a wall as thick as they are far spread lie as much across it as along it,
    /// so that the plane of a point midway stands across the wall. But most points are not midway. So a point
    /// begins with the plane of discs around it that lie in theirs, weighted by how flat these are (tensor
    /// voting: Medioni, Lee, Tang 2000).
    std::vector<Vec3> first_normals(const Surroundings& surroundings, const std::vector<VoxelSums>& sums,
                                    std::size_t points) const {
        std::vector<PlaneSums> discs(sums.size());
        surroundings.for_each_voxel([&](Index v, const std::vector<Index>& around) {
            discs[v] = disc(plane_sums(sums[v].mean, sums, around), sums[v].count);
        });
        std::vector<Vec3> normals(points);
        surroundings.for_each_point([&](const Vec3& p, Index i, const std::vector<Index>& around) {
            PlaneSums moments;
            for (const Index v : around) {
                const double weight = closeness((sums[v].mean - p).norm(), inverse_radius_);
                moments.weight += weight * discs[v].weight;
                for (std::size_t k = 0; k < 6; ++k) moments.second[k] += weight * discs[v].second[k];
            }
            normals[i] = fit_plane(moments).normal;
        });
        return normals;
    }

    /// Second moments of a disc in the plane of some points, weighted by their flatness: 1 of a plane, 0 of a
    /// ball.
    static PlaneSums disc(const PlaneSums& points, double count) {
        const PlaneFit plane = fit_plane(points);
        const double across = plane.variance * points.weight;
        const double along = points.second[0] + points.second[1] + points.second[2]
                             - points.first.sqrnorm() / points.weight - across;
        const Vec3& n = plane.normal;
        PlaneSums result;
        result.weight = along > 0 && n.sqrnorm() > 0 ? count * (1 - 2 * across / along) : 0;
        const double w = result.weight;
        result.second = {w * (1 - n[0] * n[0]), w * (1 - n[1] * n[1]), w * (1 - n[2] * n[2]),
                         -w * n[0] * n[1],      -w * n[1] * n[2],      -w * n[2] * n[0]};
        return result;
    }

    /// Of the points around p; off the plane through it, those of another sheet do not count.
    PlaneSums plane_sums(const Vec3& p, const std::vector<VoxelSums>& voxels,
                         const std::vector<Index>& around, const Vec3& normal = Vec3(0, 0, 0)) const {
        PlaneSums sums;
        for (const Index v : around) {
            const double weight = weight_of(voxels[v].mean - p, normal);
            if (weight > 0) add(sums, voxels[v], p, weight);
        }
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
        for (int round = 0; round < rounds_; ++round) {
            const PlaneFit plane = fit_plane(plane_sums(p, voxels, around, normal));
            if (plane.normal.sqrnorm() == 0) return p;
            normal = plane.normal;
            p += normal * (plane.centroid | normal);
        }
        return p;
    }

    double radius_, inverse_radius_, inverse_gap_;
    std::int32_t reach_ = smoothing::reach;
    int rounds_ = repeats::few;
};

/// How points scatter about where they were moved to, and where they lie; all summed.
struct Scatter {
    double count = 0, squares = 0, fourths = 0; ///< of the distances: to the second and fourth power
    Vec3 at{0, 0, 0}, normal{0, 0, 0};          ///< normals all on one side

    void add_moments(const Scatter& other) {
        count += other.count, squares += other.squares, fourths += other.fourths;
        at += other.at;
    }
    double variance() const { return squares / count; }
    /// The square of half the distance of two normal distributions, alike and as strong, that make this one
    /// (the method of moments: Pearson 1894); 0 if nothing says that there are two.
    double squared_half_gap() const {
        return std::sqrt(std::max(0.0, 1.5 * variance() * variance() - 0.5 * fourths / count));
    }
};

std::vector<Scatter> scatter_of(const Surroundings& surroundings, const std::vector<Vec3>& from,
                                const MovedPoints& moved) {
    std::vector<Scatter> scatter(surroundings.voxels());
    for_each_index(scatter.size(), chunks::heavy, [&](Index v) {
        Scatter& sum = scatter[v];
        surroundings.for_points_of(v, [&](const Vec3& p, Index i) {
            const Vec3& normal = moved.normals[i];
            const double square = (from[i] - moved.positions[i]).sqrnorm();
            sum.at += p, sum.normal += (sum.normal | normal) < 0 ? -normal : normal;
            sum.squares += square, sum.fourths += square * square, ++sum.count;
        });
    });
    return scatter;
}

/// Points in strips as wide as a half gap, of which the second two have the two sheets in their middle.
struct Strips {
    double between = 0, at_sheets = 0;

    void add(double distance, double half_gap) {
        between += distance < 0.5 * half_gap;
        at_sheets += std::abs(distance - half_gap) < 0.25 * half_gap;
    }
};

/// Points of voxels, those of them at the surface's ends, and of these those that scatter as about two
/// sheets.
struct SheetCounts {
    double points = 0, at_ends = 0, ends_of_two = 0;
    std::vector<double> noises; ///< deviation about each sheet, per voxel of two
    Strips strips;              ///< of these voxels

    /// Noise that is bounded, as of depths in steps, has two moments as of two sheets, but no fewer points in
    /// the middle than beside it. Are there fewer, by more than twice the deviation of chance?
    bool are_apart() const {
        const double fewer = strips.at_sheets - strips.between;
        return fewer > 2 * std::sqrt(strips.at_sheets + strips.between);
    }
};

SheetCounts count_sheets(const Surroundings& surroundings, const std::vector<Vec3>& from,
                         const MovedPoints& moved, double far_aside) {
    const std::vector<Scatter> scatter = scatter_of(surroundings, from, moved);
    std::vector<std::uint8_t> at_end(scatter.size());
    std::vector<Strips> strips(scatter.size());
    std::vector<double> variance(scatter.size()); // about each of two; below 0: of one
    surroundings.for_each_voxel([&](Index v, const std::vector<Index>& around) {
        Scatter sum;
        for (const Index k : around) sum.add_moments(scatter[k]);
        const double square = sum.squared_half_gap(), left = std::max(0.0, sum.variance() - square);
        variance[v] = square > left ? left : -1; // nearer sheets have no two modes
        if (square > left)
            surroundings.for_points_of(v, [&](const Vec3&, Index i) {
                strips[v].add((from[i] - moved.positions[i]).norm(), std::sqrt(square));
            });
        const Vec3 away = sum.at / sum.count - scatter[v].at / scatter[v].count;
        at_end[v] = (away % scatter[v].normal.normalized()).norm() > far_aside;
    });
    SheetCounts counts;
    for_each_in_order(scatter.size(), [&](std::size_t v) {
        counts.points += scatter[v].count;
        counts.at_ends += at_end[v] * scatter[v].count;
        if (variance[v] < 0) return;
        counts.ends_of_two += at_end[v] * scatter[v].count;
        counts.noises.push_back(std::sqrt(variance[v]));
        counts.strips.between += strips[v].between, counts.strips.at_sheets += strips[v].at_sheets;
    });
    return counts;
}

/// The deviation of each of two sheets that points were moved between; 0 where they are of one. Layers of
/// scans that do not register scatter as the sides of a wall do. But a wall's sides end together, and layers
/// each where its scan ends: so it is a wall if most points at the ends of what they were moved to scatter as
/// about two. And that is a sheet itself: as long around as a disc of its area at least.
double noise_of_two_sheets(const Surroundings& surroundings, const std::vector<Vec3>& from,
                           const MovedPoints& moved, double spacing, double radius) {
    // What lies around reaches half a voxel farther. At a straight end its mean is half of that off, a third
    // of the way in from there a third.
    const double strip = radius * (1 + 0.5 / smoothing::reach) / 3;
    SheetCounts counts = count_sheets(surroundings, from, moved, strip);
    if (counts.noises.empty() || !counts.are_apart() || 2 * counts.ends_of_two < counts.at_ends) return 0;
    const double area = counts.points * spacing * spacing;
    const double length = counts.at_ends / counts.points * area / strip;
    if (length * length < 4 * std::numbers::pi * area) return 0;
    const auto middle = counts.noises.begin() + static_cast<std::ptrdiff_t>(counts.noises.size() / 2);
    std::nth_element(counts.noises.begin(), middle, counts.noises.end());
    return *middle;
}

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

/// The last step of moving points to one sheet, or all of them to two where these are within the noise of
/// each other. Normals that come with the points would not follow these. Returns the noise.
double centred(const Octree& octree, double spacing, double noise, const Smoothing& smoothing,
               MovedPoints& moved) {
    const std::vector<Vec3>& from = octree.positions;
    const Surroundings surroundings = smoothing.around(moved.positions);
    const double of_each = octree.normals.empty()
                               ? noise_of_two_sheets(surroundings, from, moved, spacing, smoothing.radius())
                               : 0;
    if (of_each > 0) {
        const Smoothing finer = Smoothing::between_sheets(spacing, of_each);
        moved = finer.onto_planes(from, std::move(moved.normals));
        finer.undo_shrinking(from, finer.around(moved.positions), moved);
        return of_each;
    }
    smoothing.undo_shrinking(from, surroundings, moved);
    return noise;
}

void validate(const SmoothOptions& options) {
    check_option(options.least_noise >= 0, "least_noise", options.least_noise, "be 0 or more");
    check_option(options.most_stretch > 1, "most_stretch", options.most_stretch, "be above 1");
}

} // namespace

double smooth_points(Octree& octree, double noise) {
    const double spacing = estimate_spacing(octree);
    MovedPoints moved;
    for (int round = 0; round < enough_rounds; ++round) {
        const Smoothing smoothing(spacing, noise);
        moved = smoothing.onto_planes(octree.positions);
        const double found = noise_of_moves(octree.positions, moved.positions);
        const bool again = found > 0 && found <= smoothing::clearly_less * noise;
        if (!again || round + 1 == enough_rounds) {
            noise = centred(octree, spacing, again ? found : noise, smoothing, moved);
            break;
        }
        noise = found;
    }
    rearrange(octree, std::move(moved.positions), octree.extent);
    return noise;
}

SmoothReport smooth_noise(Octree& octree, Neighbors& neighbors, const SmoothOptions& options) {
    const double noise = noise_deviation(octree, neighbors);
    return is_noisy(octree, noise, options) ? smooth_known_noise(octree, noise, neighbors, options)
                                            : SmoothReport{};
}

bool is_noisy(const Octree& octree, double noise, const SmoothOptions& options) {
    validate(options);
    return !(noise <= options.least_noise * estimate_spacing(octree));
}

SmoothReport smooth_known_noise(Octree& octree, double noise, Neighbors& neighbors,
                                const SmoothOptions& options) {
    validate(options);
    SmoothReport report;
    report.noise = smooth_points(octree, noise);
    neighbors = find_neighbors(octree);
    report.between = drop_outliers_by_distance(
        octree, neighbors, {.most_stretch = options.most_stretch, .rounds = repeats::twice});
    return report;
}

} // namespace hsdm
