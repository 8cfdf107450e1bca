#include "hsdm/normals/plane_smoothing.hh"

#include "hsdm/cloud/strided.hh"
#include "hsdm/normals/neighborhood.hh"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace hsdm {

struct PlaneSmoothing::VoxelSums {
    double count = 0;
    Vec3 mean{0, 0, 0};
    std::array<double, 6> spread{}; // xx, yy, zz, xy, yz, zx, summed
};

/// Points, their mean, and that of their ways back, of one voxel.
struct PlaneSmoothing::WayBack {
    double count = 0;
    Vec3 at{0, 0, 0}, way{0, 0, 0};
};

namespace {

/// The level of a cube that holds the box whose voxels have this edge, and that cube's.
struct LatticeCube {
    int depth = 0;
    double extent;

    LatticeCube(const Box& box, double edge) : extent(edge) {
        for (; extent < box.extent() && depth < morton_levels; ++depth) extent *= 2;
        extent = std::max(extent, box.extent());
    }
};

Octree points_in_cube(const std::vector<Vec3>& positions, const Box& box, double extent) {
    PointView view;
    view.positions = rows_of(positions);
    return build_octree(view, {.merge_duplicates = false, .cube_extent = extent, .whole = box});
}

/// Second moments of a disc in the plane of some points, weighted by their flatness: 1 of a plane, 0 of a
/// ball.
PlaneSums disc(const PlaneSums& points, double count) {
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

std::vector<Scatter> scatter_of(const VoxelLattice& lattice, const std::vector<Vec3>& from,
                                const MovedPoints& moved) {
    std::vector<Scatter> scatter(lattice.voxels());
    for_each_index(scatter.size(), chunks::heavy, [&](Index v) {
        Scatter& sum = scatter[v];
        lattice.for_points_of(v, [&](const Vec3& p, Index i) {
            const Vec3& normal = moved.normals[i];
            const double square = (from[i] - moved.positions[i]).sqrnorm();
            sum.at += p, sum.normal += (sum.normal | normal) < 0 ? -normal : normal;
            sum.squares += square, sum.fourths += square * square, ++sum.count;
        });
    });
    return scatter;
}

} // namespace

VoxelLattice::VoxelLattice(const std::vector<Vec3>& positions, const Box& box, double edge,
                           std::int32_t reach)
    : reach_(reach) {
    const LatticeCube cube(box, edge);
    points_ = points_in_cube(positions, box, cube.extent);
    level_ = extract_level(points_, cube.depth);
}

void VoxelLattice::find_around(Index voxel, std::vector<Index>& around) const {
    const VoxelCoord c = level_.coord(voxel);
    around.clear();
    for (std::int32_t z = -reach_; z <= reach_; ++z)
        for (std::int32_t y = -reach_; y <= reach_; ++y)
            for (std::int32_t x = -reach_; x <= reach_; ++x)
                if (const Index v = level_.find(VoxelCoord{c[0] + x, c[1] + y, c[2] + z}); v != no_index)
                    around.push_back(v);
}

void SheetStrips::add(double distance, double half_gap) {
    between += distance < 0.5 * half_gap;
    at_sheets += std::abs(distance - half_gap) < 0.25 * half_gap;
}

void SheetCounts::operator+=(const SheetCounts& other) {
    points += other.points, at_ends += other.at_ends, ends_of_two += other.ends_of_two;
    noises.insert(noises.end(), other.noises.begin(), other.noises.end());
    strips.between += other.strips.between, strips.at_sheets += other.strips.at_sheets;
}

PlaneSmoothing::PlaneSmoothing(double spacing, double noise)
    : spacing_(spacing),
      radius_(
          std::max(smoothing::least_radius * noise, smoothing::steady_radius * std::sqrt(noise * spacing))),
      inverse_radius_(1 / radius_),
      inverse_gap_(1 / (smoothing::least_radius * noise)) {}

PlaneSmoothing PlaneSmoothing::between_sheets(double spacing, double noise) {
    PlaneSmoothing result(spacing, noise);
    result.inverse_gap_ *= 2;
    result.reach_ *= 2;
    result.rounds_ *= 2;
    return result;
}

double PlaneSmoothing::weight_of(const Vec3& away, const Vec3& normal) const {
    return closeness(away.norm(), inverse_radius_) * closeness(away | normal, inverse_gap_);
}

MovedPoints PlaneSmoothing::onto_planes(const std::vector<Vec3>& positions, const Box& box,
                                        std::vector<Vec3> normals) const {
    const VoxelLattice lattice = around(positions, box);
    const std::vector<VoxelSums> sums = sums_of(lattice);
    if (normals.empty()) normals = first_normals(lattice, sums, positions.size());
    MovedPoints moved{std::vector<Vec3>(positions.size()), std::move(normals)};
    lattice.for_each_point([&](const Vec3& p, Index i, const std::vector<Index>& around) {
        moved.positions[i] = project(p, sums, around, moved.normals[i]) + lattice.origin();
    });
    return moved;
}

void PlaneSmoothing::undo_shrinking(const std::vector<Vec3>& from, const VoxelLattice& lattice,
                                    MovedPoints& moved) const {
    const std::vector<WayBack> ways = ways_back(lattice, from, moved.positions);
    std::vector<Vec3> centred(moved.positions.size());
    lattice.for_each_point([&](const Vec3& p, Index i, const std::vector<Index>& around) {
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

std::vector<PlaneSmoothing::VoxelSums> PlaneSmoothing::sums_of(const VoxelLattice& lattice) {
    std::vector<VoxelSums> sums(lattice.voxels());
    for_each_index(sums.size(), chunks::heavy, [&](Index v) {
        VoxelSums& sum = sums[v];
        lattice.for_points_of(v, [&](const Vec3& p, Index) { sum.mean += p, ++sum.count; });
        sum.mean /= sum.count;
        PlaneSums spread;
        lattice.for_points_of(v, [&](const Vec3& p, Index) { spread.add(p - sum.mean, 1); });
        sum.spread = spread.second;
    });
    return sums;
}

/// All points around: those of a wall as thick as they are far spread lie as much across it as along it,
/// so that the plane of a point midway stands across the wall. But most points are not midway. So a point
/// begins with the plane of discs around it that lie in theirs, weighted by how flat these are (tensor
/// voting: Medioni, Lee, Tang 2000).
std::vector<Vec3> PlaneSmoothing::first_normals(const VoxelLattice& lattice,
                                                const std::vector<VoxelSums>& sums,
                                                std::size_t points) const {
    std::vector<PlaneSums> discs(sums.size());
    lattice.for_each_voxel([&](Index v, const std::vector<Index>& around) {
        discs[v] = disc(plane_sums(sums[v].mean, sums, around), sums[v].count);
    });
    std::vector<Vec3> normals(points);
    lattice.for_each_point([&](const Vec3& p, Index i, const std::vector<Index>& around) {
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

/// Of the points around p; off the plane through it, those of another sheet do not count.
PlaneSums PlaneSmoothing::plane_sums(const Vec3& p, const std::vector<VoxelSums>& voxels,
                                     const std::vector<Index>& around, const Vec3& normal) const {
    PlaneSums sums;
    for (const Index v : around) {
        const double weight = weight_of(voxels[v].mean - p, normal);
        if (weight <= 0) continue;
        sums.add(voxels[v].mean - p, weight * voxels[v].count);
        for (std::size_t k = 0; k < 6; ++k) sums.second[k] += weight * voxels[v].spread[k];
    }
    return sums;
}

std::vector<PlaneSmoothing::WayBack> PlaneSmoothing::ways_back(const VoxelLattice& lattice,
                                                               const std::vector<Vec3>& from,
                                                               const std::vector<Vec3>& to) {
    std::vector<WayBack> ways(lattice.voxels());
    for_each_index(ways.size(), chunks::heavy, [&](Index v) {
        WayBack& mean = ways[v];
        lattice.for_points_of(
            v, [&](const Vec3& p, Index i) { mean.at += p, mean.way += from[i] - to[i], ++mean.count; });
        mean.at /= mean.count, mean.way /= mean.count;
    });
    return ways;
}

/// Projects onto the plane around the point itself, then onto that around the result.
Vec3 PlaneSmoothing::project(const Vec3& point, const std::vector<VoxelSums>& voxels,
                             const std::vector<Index>& around, Vec3& normal) const {
    Vec3 p = point;
    for (int round = 0; round < rounds_; ++round) {
        const PlaneFit plane = fit_plane(plane_sums(p, voxels, around, normal));
        if (plane.normal.sqrnorm() == 0) return p;
        normal = plane.normal;
        p += normal * (plane.centroid | normal);
    }
    return p;
}

SheetCounts PlaneSmoothing::count_sheets(const std::vector<Vec3>& from, const VoxelLattice& lattice,
                                         const MovedPoints& moved,
                                         const std::function<bool(Index)>& is_own) const {
    const std::vector<Scatter> scatter = scatter_of(lattice, from, moved);
    std::vector<std::uint8_t> at_end(scatter.size());
    std::vector<SheetStrips> strips(scatter.size());
    std::vector<double> variance(scatter.size()); // about each of two; below 0: of one
    lattice.for_each_voxel([&](Index v, const std::vector<Index>& around) {
        Scatter sum;
        for (const Index k : around) sum.add_moments(scatter[k]);
        const double square = sum.squared_half_gap(), left = std::max(0.0, sum.variance() - square);
        variance[v] = square > left ? left : -1; // nearer sheets have no two modes
        if (square > left)
            lattice.for_points_of(v, [&](const Vec3&, Index i) {
                strips[v].add((from[i] - moved.positions[i]).norm(), std::sqrt(square));
            });
        const Vec3 away = sum.at / sum.count - scatter[v].at / scatter[v].count;
        at_end[v] = (away % scatter[v].normal.normalized()).norm() > strip_at_end();
    });
    SheetCounts counts;
    for_each_in_order(scatter.size(), [&](std::size_t v) {
        if (!is_own(lattice.first_of(static_cast<Index>(v)))) return;
        counts.points += scatter[v].count;
        counts.at_ends += at_end[v] * scatter[v].count;
        if (variance[v] < 0) return;
        counts.ends_of_two += at_end[v] * scatter[v].count;
        counts.noises.push_back(std::sqrt(variance[v]));
        counts.strips.between += strips[v].between, counts.strips.at_sheets += strips[v].at_sheets;
    });
    return counts;
}

double PlaneSmoothing::noise_of_two_sheets(SheetCounts&& counts) const {
    // Noise that is bounded, as of depths in steps, has two moments as of two sheets, but no fewer points in
    // the middle than beside it. Are there fewer, by more than twice the deviation of chance?
    const SheetStrips& strips = counts.strips;
    const double fewer = strips.at_sheets - strips.between;
    const bool are_apart = fewer > 2 * std::sqrt(strips.at_sheets + strips.between);
    if (counts.noises.empty() || !are_apart || 2 * counts.ends_of_two < counts.at_ends) return 0;
    const double area = counts.points * spacing_ * spacing_;
    const double length = counts.at_ends / counts.points * area / strip_at_end();
    if (length * length < 4 * std::numbers::pi * area) return 0;
    const auto middle = counts.noises.begin() + static_cast<std::ptrdiff_t>(counts.noises.size() / 2);
    std::nth_element(counts.noises.begin(), middle, counts.noises.end());
    return *middle;
}

double noise_of_move(float move) {
    constexpr double lower_third = 0.4307;
    return static_cast<double>(move) / lower_third;
}

bool is_clearly_less(double found, double noise) {
    return found > 0 && found <= smoothing::clearly_less * noise;
}

} // namespace hsdm
