#include "hsdm/pipeline/prepared_cloud.hh"

#include "hsdm/cloud/point_attributes.hh"
#include "hsdm/contour/constants.hh"
#include "hsdm/errors.hh"
#include "hsdm/normals/noise.hh"
#include "hsdm/normals/normals.hh"
#include "hsdm/normals/steady_normals.hh"
#include "hsdm/octree/far_outliers.hh"
#include "hsdm/octree/spacing.hh"
#include "hsdm/pipeline/cloud_detail.hh"
#include "hsdm/pipeline/method.hh"
#include "hsdm/pipeline/options.hh"
#include "hsdm/pipeline/warnings.hh"

#include <algorithm>
#include <cstdio>
#include <utility>

namespace hsdm {
namespace {

/// Throws Error for points that span no surface.
void check_spread(const Octree& octree) {
    constexpr std::size_t fewest = 4;
    constexpr double negligible = 1e-9;
    if (octree.size() < fewest)
        throw Error("only " + std::to_string(octree.size())
                    + " different points; a surface needs 4, and a good one many more");
    const Vec3& first = octree.positions.front();
    // At least one end of the box's longest side is half its length away from any point.
    const double far = octree.bounds.extent() / 4;
    const auto other = std::find_if(octree.positions.begin(), octree.positions.end(),
                                    [&](const Vec3& p) { return (p - first).max_abs() > far; });
    // Far from the origin the coordinates' own last digit is the larger noise.
    const double reach = std::max(octree.bounds.lo.max_abs(), octree.bounds.hi.max_abs());
    const double tolerance = negligible * octree.extent + 4 * std::numeric_limits<double>::epsilon() * reach;
    const Vec3 along = other != octree.positions.end() ? (*other - first).normalized() : Vec3(0, 0, 0);
    for (const Vec3& p : octree.positions)
        if (((p - first) % along).norm() > tolerance) return;
    throw Error("all points lie on a line; there is no surface in them");
}

} // namespace

PreparedCloud::PreparedCloud(InputCloud& input, const ReconstructOptions& options, const Phases& phases) {
    const PointView& cloud = *input;
    report.input.has_normals = cloud.has_normals(); // before the octree takes them
    OctreeOptions octree_options;
    octree_options.placement = CubePlacement::centred;
    octree_options.use_normals = options.normals != NormalSource::estimate;
    octree_options.whole = finite_bounds(cloud.positions);
    frame = CloudFrame(*octree_options.whole);
    octree_options.unit = frame.unit();
    octree =
        phases.run("octree", 0, report.seconds.octree, [&] { return input.take_octree(octree_options); });
    Occurrences far = drop_far_outliers(octree, cloud, frame);
    frame.check_reach();
    constexpr double voxels_between_parts = 16; // more than any stage reaches from voxel to voxel
    far.add(cut_empty_space(octree, cloud, frame, voxels_between_parts * options.voxel_size.value_or(0)));
    frame.check_reach();
    far_away_ = far.count;
    if (far_away_ > 0) report.rejected["points_outlying"] = far_away_;
    note_dropped("points far from all others", far, CloudFrame(), report);
    check_spread(octree);
    report.input.points = input.finite_size();
    report.input.merged_duplicates = octree.merged_duplicates;
    report.input.bbox = octree.bounds;
    report.input.spacing = estimate_spacing(octree);
}

void PreparedCloud::provide_normals(const PointView& cloud, const Phases& phases) {
    NormalsOptions normals_options;
    normals_options.orient = orientation_of(cloud);
    const NormalsReport made = phases.run("normals", 0.05, report.seconds.normals,
                                          [&] { return make_normals(octree, normals_options); });
    note_outliers(made.outliers);
    note_smoothing(made.smoothed);
    report.rejected["normals_near_creases"] = made.bent;
    report.rejected["normals_missing"] = made.missing;
    report.rejected["normals_by_volume"] = made.orientation.by_volume;
    has_layers_ = made.orientation.of_layers > 0;
    report.rejected["normals_of_layers"] = made.orientation.of_layers;
    phases.run("normals", 0.1, report.seconds.normals, [&] { warn_of_sides(check_normals(octree), true); });
}

void PreparedCloud::check_given_normals(const PointView& cloud, const Phases& phases) {
    bool scattered = false, trusted = false;
    phases.run("normals", 0.05, report.seconds.normals, [&] {
        scattered = are_scattered(octree);
        if (scattered) return;
        const NormalConsistency consistency = check_normals(octree, report.input.spacing);
        trusted = !consistency.doubtful();
        if (trusted) measure_noise(consistency); // outliers included, as tiles do, which spares them a pass
    });
    // Before normals are changed: outliers that take the axes of their positions agree with each other.
    note_outliers(phases.run("strays", 0.08, report.seconds.normals, [&] {
        const Occurrences outliers = drop_outliers_by_normals(octree);
        if (outliers.count > 0) fit_to_points(octree);
        return outliers;
    }));
    report.rejected["normals_steadied"] = report.rejected["normals_mended"] = 0;
    if (!trusted)
        phases.run("normals", 0.1, report.seconds.normals, [&] { correct_normals(scattered, cloud); });
}

void PreparedCloud::measure_noise(const NormalConsistency& consistency) {
    if (consistency.rough() && octree.size() > 1) noise_ = noise_deviation(octree, find_neighbors(octree));
}

void PreparedCloud::correct_normals(bool scattered, const PointView& cloud) {
    if (scattered) report.rejected["normals_steadied"] = steady_normals(octree);
    NormalConsistency consistency = check_normals(octree, report.input.spacing);
    measure_noise(consistency);
    if (!consistency.doubtful()) return;
    const std::size_t mended = mend_normals(octree, orientation_of(cloud));
    report.rejected["normals_mended"] = mended;
    if (mended > 0) consistency = check_normals(octree);
    warn_of_sides(consistency, false);
}

int PreparedCloud::choose_resolution(const ReconstructOptions& options) {
    const auto rearrange_in = [&](const VoxelCube& cube) {
        looked_.reset();
        rearrange(octree, std::move(octree.positions), cube.extent);
    };
    const PlacedPoints points{octree, frame, noise_, rearrange_in, [&](int depth) { return detail(depth); }};
    return hsdm::choose_resolution(options, points, report);
}

void PreparedCloud::smooth_for_depth(int depth, const Phases& phases) {
    // Noise as large as what tells sheets apart decides topology; less leaves it alone, and creases are as
    // crisp as they are.
    if (moved_ || noise_ <= relations::smooth_gap * octree.voxel_size(depth)) return;
    looked_.reset();
    note_smoothing(phases.run("noise", 0.1, report.seconds.normals, [&] {
        Neighbors neighbors;
        return smooth_known_noise(octree, noise_, neighbors);
    }));
}

Detail PreparedCloud::detail(int depth) {
    looked_.emplace(Looked{extract_level(octree, depth), {}});
    looked_->sets = build_normal_sets(octree, looked_->level);
    return detail_of(octree, looked_->level, looked_->sets);
}

OctreeLevel PreparedCloud::take_level(int depth, std::optional<NormalSets>& sets) {
    if (!looked_ || looked_->level.depth != depth) return extract_level(octree, depth);
    Looked looked = std::move(*looked_);
    looked_.reset();
    sets = std::move(looked.sets);
    return std::move(looked.level);
}

void PreparedCloud::release_sources(const PointView& cloud) {
    const bool asked_for = moved_ || !cloud.sensors.empty() || !attributes_of(cloud).empty();
    if (!asked_for) octree.source = std::vector<Index>();
}

void PreparedCloud::note_outliers(const Occurrences& outliers) {
    report.rejected["points_outlying"] = far_away_ + outliers.count;
    note_dropped("points off every surface", outliers, frame, report);
    if (outliers.count == 0) return;
    report.input.bbox = octree.bounds;
    report.input.spacing = estimate_spacing(octree);
}

OrientOptions PreparedCloud::orientation_of(const PointView& cloud) const {
    OrientOptions options;
    if (cloud.sensor) options.sensor = frame.to_work(*cloud.sensor) - octree.origin;
    options.viewpoints = viewpoints_of(cloud);
    return options;
}

Viewpoints PreparedCloud::viewpoints_of(const PointView& cloud) const {
    Viewpoints viewpoints;
    for (const Vec3& sensor : cloud.sensors)
        viewpoints.sensors.push_back(frame.to_work(sensor) - octree.origin);
    viewpoints.sensor_of = cloud.sensor_of;
    return viewpoints;
}

void PreparedCloud::warn_of_sides(const NormalConsistency& consistency, bool estimated) {
    Occurrences sides = doubtful_sides(octree, consistency, estimated);
    sides.first += octree.origin;
    warn(warning_of::sides, sides, frame, report);
}

void PreparedCloud::note_smoothing(const SmoothReport& smoothed) {
    report.rejected["points_between_sheets"] = smoothed.between.count;
    note_dropped("noisy points between sheets", smoothed.between, frame, report);
    noise_ = smoothed.noise;
    moved_ = noise_ > 0;
    if (!moved_) return;
    report.rejected["points_moved"] = octree.size();
    report.input.spacing = estimate_spacing(octree); // measured again: noise had made it look wider
}

} // namespace hsdm
