#include "hsdm/normals/smooth_points.hh"

#include "hsdm/core/check_option.hh"
#include "hsdm/core/chunks.hh"
#include "hsdm/core/constants.hh"
#include "hsdm/normals/constants.hh"
#include "hsdm/normals/noise.hh"
#include "hsdm/normals/outliers.hh"
#include "hsdm/normals/plane_smoothing.hh"
#include "hsdm/octree/spacing.hh"

#include <algorithm>

namespace hsdm {
namespace {

double noise_of_moves(const std::vector<Vec3>& from, const std::vector<Vec3>& to) {
    std::vector<float> moves(from.size());
    for (std::size_t i = 0; i < moves.size(); ++i) moves[i] = static_cast<float>((to[i] - from[i]).norm());
    const auto third = moves.begin() + static_cast<std::ptrdiff_t>(moves_below(moves.size()));
    std::nth_element(moves.begin(), third, moves.end());
    return noise_of_move(*third);
}

/// The last step of moving points to one sheet, or all of them to two where these are within the noise of
/// each other. Normals that come with the points would not follow these. Returns the noise.
double centred(const Octree& octree, double spacing, double noise, const PlaneSmoothing& smoothing,
               MovedPoints& moved) {
    const std::vector<Vec3>& from = octree.positions;
    const VoxelLattice lattice = smoothing.around(moved.positions, bounds_of(moved.positions));
    double of_each = 0;
    if (octree.normals.empty())
        of_each = smoothing.noise_of_two_sheets(
            smoothing.count_sheets(from, lattice, moved, [](Index) { return true; }));
    if (of_each > 0) {
        const auto finer = PlaneSmoothing::between_sheets(spacing, of_each);
        moved = finer.onto_planes(from, bounds_of(from), std::move(moved.normals));
        finer.undo_shrinking(from, finer.around(moved.positions, bounds_of(moved.positions)), moved);
        return of_each;
    }
    smoothing.undo_shrinking(from, lattice, moved);
    return noise;
}

void validate(const SmoothOptions& options) {
    check_option(options.least_noise >= 0, "least_noise", options.least_noise, "be 0 or more");
    check_option(options.most_stretch > 1, "most_stretch", options.most_stretch, "be above 1");
}

} // namespace

double smooth_points(Octree& octree, double noise) {
    const double spacing = estimate_spacing(octree);
    const Box box = bounds_of(octree.positions);
    MovedPoints moved;
    for (int round = 0; round < enough_rounds; ++round) {
        const PlaneSmoothing smoothing(spacing, noise);
        moved = smoothing.onto_planes(octree.positions, box);
        const double found = noise_of_moves(octree.positions, moved.positions);
        const bool again = is_clearly_less(found, noise);
        if (again) noise = found;
        if (!again || round + 1 == enough_rounds) {
            noise = centred(octree, spacing, noise, smoothing, moved);
            break;
        }
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
    report.between = drop_outliers_by_distance(octree, neighbors, outliers_between_sheets(options));
    return report;
}

OutlierOptions outliers_between_sheets(const SmoothOptions& options) {
    return {.most_stretch = options.most_stretch, .rounds = repeats::twice};
}

} // namespace hsdm
