#include "hsdm/normals/outliers.hh"

#include "hsdm/core/chunks.hh"
#include "hsdm/core/large_vector.hh"
#include "hsdm/normals/constants.hh"
#include "hsdm/normals/plane_fit.hh"
#include "hsdm/octree/spacing.hh"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace hsdm {
namespace {

double at_rank(std::vector<double> values, std::size_t rank) {
    const auto place = values.begin() + static_cast<std::ptrdiff_t>(rank);
    std::nth_element(values.begin(), place, values.end());
    return *place;
}

/// Of many values a sample tells between which two the middle one lies; those few are put in order.
double median(const std::vector<double>& values) {
    constexpr std::size_t sampled = 1 << 12;
    const std::size_t rank = values.size() / 2, stride = values.size() / sampled;
    if (stride < 16) return at_rank(values, rank);
    std::vector<double> sample;
    for (std::size_t i = 0; i < values.size(); i += stride) sample.push_back(values[i]);
    std::sort(sample.begin(), sample.end());
    const double least = sample[sample.size() * 9 / 20], most = sample[sample.size() * 11 / 20];
    std::vector<std::size_t> below(chunk_count(values.size(), chunks::light), 0);
    std::vector<std::vector<double>> between(below.size());
    for_chunks(values.size(), chunks::light, [&](std::size_t begin, std::size_t end, std::size_t chunk) {
        for (std::size_t i = begin; i < end; ++i) {
            below[chunk] += values[i] < least;
            if (values[i] >= least && values[i] <= most) between[chunk].push_back(values[i]);
        }
    });
    std::vector<double> middle = joined(between);
    const std::size_t before = std::accumulate(below.begin(), below.end(), std::size_t{0});
    if (rank < before || rank - before >= middle.size()) return at_rank(values, rank);
    return at_rank(std::move(middle), rank - before);
}

/// The plane of a point's neighbours, without the point, relative to it.
PlaneFit plane_around(const Octree& octree, const Neighbors& neighbors, std::size_t i) {
    PlaneSums sums;
    for (Index n : neighbors.of(i)) sums.add(octree.positions[n] - octree.positions[i], 1);
    return fit_plane(sums);
}

double deviation_from(const PlaneFit& plane) {
    return std::sqrt(std::max(0.0, plane.variance));
}

/// Do the neighbours of most points fill a volume? Then the noise is as wide as the neighbourhoods, and a
/// volume is no sign of an outlier. A sample tells.
bool fill_volume(const Octree& octree, const Neighbors& neighbors, const OutlierOptions& options) {
    const std::size_t step = volume_stride(octree.size());
    const std::size_t looked_at = chunk_count(octree.size(), step);
    const std::vector<Index> volumes = indices_where(looked_at, chunks::heavy, [&](Index k) {
        return fills_volume(octree, neighbors, k * step, options);
    });
    return 2 * volumes.size() > looked_at;
}

/// Does a plane through the point and two of its neighbours hold many of the others? One does at the rims of
/// thin wedges, on each of their faces; hardly ever one of points that fill a volume.
bool lies_on_face(const Octree& octree, const Neighbors& neighbors, std::size_t i) {
    const auto around = neighbors.of(i);
    const double thickness = distance_outliers::face_thickness * neighbors.reach[i];
    const std::size_t enough =
        std::max<std::size_t>(3, around.size() * distance_outliers::face_percent / 100); // two make the plane
    const auto offset = [&](std::size_t k) { return octree.positions[around[k]] - octree.positions[i]; };
    for (std::size_t a = 0; a < around.size(); ++a)
        for (std::size_t b = a + 1; b < around.size(); ++b) {
            const Vec3 normal = offset(a) % offset(b);
            if (normal.norm() <= distance_outliers::face_thickness * offset(a).norm() * offset(b).norm())
                continue; // on a line: many planes
            std::size_t held = 0;
            for (std::size_t k = 0; k < around.size(); ++k)
                held += std::abs(normal | offset(k)) <= thickness * normal.norm();
            if (held >= enough) return true;
        }
    return false;
}

/// Do the neighbours, without the point, fill a volume, or lie on a plane that the point is off?
bool is_off_surface(const Octree& octree, const Neighbors& neighbors, std::size_t i,
                    const OutlierOptions& options) {
    const PlaneFit plane = plane_around(octree, neighbors, i);
    const double deviation = deviation_from(plane), reach = neighbors.reach[i];
    if (deviation > options.least_volume * reach) return !lies_on_face(octree, neighbors, i);
    const double height = std::abs(plane.normal | plane.centroid);
    return height > options.least_height * reach && height > noise::deviations * deviation;
}

/// How many neighbours continue the point's plane with a normal like its own. A dense surface far away does
/// not.
int support(const Octree& octree, Index i, std::span<const Index> neighbors,
            const std::vector<std::uint8_t>& is_sparse, double farthest,
            const NormalOutlierOptions& options) {
    const double least_cosine = std::cos(options.most_angle);
    int count = 0;
    for (Index n : neighbors) {
        const Vec3 d = octree.positions[n] - octree.positions[i];
        const Vec3& normal = octree.normals[i];
        count += (is_sparse[n] || d.sqrnorm() <= farthest * farthest)
                 && (normal | octree.normals[n]) > least_cosine
                 && std::abs(normal | d) <= options.most_rise * d.norm();
    }
    return count;
}

} // namespace

std::size_t volume_stride(std::size_t points) {
    constexpr std::size_t sample = 4096; // its share is off by a hundredth
    return std::max<std::size_t>(1, points / sample);
}

bool fills_volume(const Octree& octree, const Neighbors& neighbors, std::size_t point,
                  const OutlierOptions& options) {
    return deviation_from(plane_around(octree, neighbors, point))
           > options.least_volume * neighbors.reach[point];
}

std::vector<std::uint8_t> outliers_by_distance(const Octree& octree, const Neighbors& neighbors,
                                               const ReachOfAll& all, const OutlierOptions& options) {
    const double typical = all.typical;
    const double least_stretch = std::min(options.most_stretch, options.doubtful_stretch);
    std::vector<std::uint8_t> found = large_vector<std::uint8_t>(octree.size(), 0);
    for_each_index(octree.size(), chunks::quick, [&](Index i) {
        const double reach = neighbors.reach[i], sparseness = reach / typical;
        const auto around = neighbors.of(i);
        // Is the reach more than `times` the neighbours' median reach, that is, more than that for over
        // half of them?
        const auto is_stretched = [&](double times) {
            std::size_t count = 0;
            for (Index n : around) count += reach > times * neighbors.reach[n];
            return count > around.size() / 2;
        };
        const bool is_doubtful = // as all is that is stretched by more
            sparseness > options.doubtful_sparseness || is_stretched(least_stretch);
        if (sparseness > options.most_sparseness || (is_doubtful && is_stretched(options.most_stretch)))
            found[i] = 1;
        else if (is_doubtful && !all.fill_volume)
            found[i] = is_off_surface(octree, neighbors, i, options);
    });
    return found;
}

Occurrences drop_outliers_by_distance(Octree& octree, Neighbors& neighbors, const OutlierOptions& options) {
    Occurrences total;
    for (int round = 0; round < options.rounds && neighbors.count > 0; ++round) {
        const ReachOfAll all{median(neighbors.reach), fill_volume(octree, neighbors, options)};
        const Occurrences some = remove_points(octree, outliers_by_distance(octree, neighbors, all, options));
        if (some.count == 0) break;
        total.add(some);
        neighbors = find_neighbors(octree, {.count = static_cast<int>(neighbors.count)});
        if (some.count < octree.size() / 1000) break; // too few removed to have hidden others
    }
    return total;
}

SparseLevel sparse_level(std::size_t points, const std::array<std::size_t, morton_levels + 1>& voxels,
                         const std::function<double(int)>& squares_at, double points_per_voxel) {
    int depth = morton_levels; // the typical count is above the mean, but not much
    while (depth > 0
           && static_cast<double>(points)
                  < 0.25 * points_per_voxel * static_cast<double>(voxels[static_cast<std::size_t>(depth)]))
        --depth;
    for (;; --depth) {
        const double typical = squares_at(depth) / static_cast<double>(points);
        if (typical >= points_per_voxel || depth == 0) return {depth, typical};
    }
}

std::vector<std::uint8_t> strays_by_normals(const Octree& octree, const SparseLevel& level,
                                            const NormalOutlierOptions& options, std::vector<double>* reach,
                                            std::optional<int> finest_level) {
    const std::vector<Index> first = first_points(octree, level.depth);
    const auto most = static_cast<Index>(std::max(1.0, options.most_share * level.typical));
    std::vector<Index> sparse;
    std::vector<std::uint8_t> is_sparse = large_vector<std::uint8_t>(octree.size(), 0);
    for_each_in_order(first.size() - 1, [&](std::size_t v) {
        if (first[v + 1] - first[v] <= most)
            for (Index i = first[v]; i < first[v + 1]; ++i) sparse.push_back(i), is_sparse[i] = 1;
    });
    const Neighbors neighbors =
        find_neighbors_of(octree, sparse, {.count = options.neighbors, .finest_level = finest_level});
    const double farthest = options.most_distance * octree.voxel_size(level.depth);
    std::vector<std::uint8_t> stray = large_vector<std::uint8_t>(octree.size(), 0);
    if (reach) assign_large(*reach, octree.size(), 0);
    for_each_index(sparse.size(), chunks::quick, [&](Index k) {
        stray[sparse[k]] =
            support(octree, sparse[k], neighbors.of(k), is_sparse, farthest, options) < options.least_support;
        if (reach) (*reach)[sparse[k]] = neighbors.reach[k];
    });
    return stray;
}

Occurrences drop_outliers_by_normals(Octree& octree, const NormalOutlierOptions& options) {
    const auto squares_at = [&](int depth) {
        const std::vector<Index> first = first_points(octree, depth);
        double squares = 0;
        for_each_in_order(first.size() - 1, [&](std::size_t v) {
            const auto count = static_cast<double>(first[v + 1] - first[v]);
            squares += count * count;
        });
        return squares;
    };
    const SparseLevel level =
        sparse_level(octree.size(), count_voxels(octree), squares_at, options.points_per_voxel);
    return remove_points(octree, strays_by_normals(octree, level, options));
}

} // namespace hsdm
