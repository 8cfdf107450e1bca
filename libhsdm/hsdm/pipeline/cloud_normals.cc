#include "hsdm/pipeline/cloud_normals.hh"

#include "hsdm/normals/arcs.hh"
#include "hsdm/normals/noise.hh"
#include "hsdm/pipeline/cell_attributes.hh"
#include "hsdm/pipeline/cloud_signs.hh"
#include "hsdm/pipeline/cloud_smoothing.hh"
#include "hsdm/pipeline/stray_search.hh"

#include <algorithm>
#include <optional>

namespace hsdm {
namespace {

/// Gives the parts' points normals with their sides.
class SidedPass {
public:
    SidedPass(const Estimating& how, const SignsOfAll& signs, PartStore& store, const ScratchCloud& cloud,
              ScratchCloud& next)
        : how_(how), signs_(signs), store_(store), beside_(cloud), next_(next) {}

    std::size_t bent = 0, missing = 0; ///< points of this rank, as in NormalsReport

    /// Returns false, and takes nothing, if not all is known.
    bool add(const CloudPart& part) {
        if (part.lacks_neighbors(how_.neighbors.count)) return false;
        PartNormals made(part, how_, store_);
        EstimatedNormals& estimate = made.estimate;
        const std::vector<std::uint8_t> turns = turns_of(made.patches, made.signs(signs_));
        std::vector<Vec3> refined = made.refine(part);
        turn_normals({turns, {}}, refined);
        estimate.normals = std::move(refined);
        made.vote(part);
        const bool bends = signs_.report.of_layers == 0; // as make_normals() has it
        if (bends) bend_to_arcs(part.octree(), made.neighbors, estimate);
        // Which are on arcs at first, the rounds, and which are backed.
        if (bends && !(estimate.noise > estimation::rough)) made.known.step(estimate.bent, arcs::rounds + 2);
        if (!made.known.all(part.begin(), part.end())) return false;
        keep(part, std::move(estimate));
        return true;
    }

private:
    void keep(const CloudPart& part, EstimatedNormals&& estimate) {
        Octree octree = part.octree();
        octree.normals = std::move(estimate.normals);
        for (std::size_t i = part.begin(); i < part.end(); ++i) {
            next_.add(octree, i, beside_.of(octree, i));
            missing += octree.normals[i].sqrnorm() == 0;
        }
        bent += static_cast<std::size_t>(std::ranges::lower_bound(estimate.bent, part.end())
                                         - std::ranges::lower_bound(estimate.bent, part.begin()));
    }

    const Estimating& how_;
    const SignsOfAll& signs_;
    PartStore& store_;
    CellAttributes beside_;
    ScratchCloud& next_;
};

/// What has been done before the normals are made.
struct Begun {
    bool is_sided = false;
    CloudScanners scanners{}; ///< relative to the cube as it is then
    NormalsReport report;
    Estimating how;
    SignsOfAll signs; ///< if it is
};

/// How neighbours are sought and planes fitted, by the noise of all points relative to how far neighbours
/// are.
Estimating estimating(ScratchCloud& cloud, const CloudSurvey& survey, const CloudPasses& passes,
                      double noise) {
    Estimating how;
    if (const int wanted = neighbors_for_noise(noise); wanted > how.neighbors.count) {
        how.neighbors.count = wanted;
        noise = relative_noise(cloud, survey, passes, wanted);
    }
    how.neighbors.finest_level = survey.sums.finest_leaves();
    how.estimate.noise = noise;
    return how;
}

/// As make_normals() begins.
void clean(ScratchCloud& cloud, CloudSurvey& survey, const CloudPasses& passes, PartStore& store,
           std::optional<ScratchCloud>& as_read, Begun& begun) {
    NormalsReport& report = begun.report;
    std::vector<PointRow> out;
    report.outliers =
        leave_outliers_out(cloud, survey, passes.plan, passes.most_points, store, OutlierOptions(), out);
    if (const Vec3 before = cloud.origin();
        report.outliers.count > 0 && fit_to_points_left(cloud, passes.most_points)) {
        survey = survey_cloud(cloud, survey.sums.points(), passes.most_points);
        begun.scanners.move(before - cloud.origin());
    }
    CloudNoise noise = cloud_noise(cloud, survey, passes);
    if (!(noise.deviation <= SmoothOptions().least_noise * survey.spacing)) {
        report.smoothed =
            smooth_cloud(cloud, survey, noise.deviation, passes.plan, passes.most_points, store, as_read);
        noise.relative = relative_noise(cloud, survey, passes);
    }
    begun.how = estimating(cloud, survey, passes, noise.relative);
    report.noise = *begun.how.estimate.noise;
}

Ranks::Bytes bytes_of_begun(const Begun& begun) {
    Ranks::Bytes bytes;
    put(begun.is_sided, bytes), put(begun.report, bytes), put(begun.how, bytes), begun.scanners.put(bytes);
    put_vector(begun.signs.number, bytes), put_vector(begun.signs.sign, bytes);
    put(begun.signs.report, bytes);
    return bytes;
}

Begun begun_from(const Ranks::Bytes& bytes) {
    ByteReader reader(bytes);
    Begun begun;
    begun.is_sided = reader.take<bool>();
    begun.report = reader.take<NormalsReport>(), begun.how = reader.take<Estimating>(),
    begun.scanners = CloudScanners::from(reader);
    begun.signs.number = reader.take_vector<Index>(), begun.signs.sign = reader.take_vector<std::int8_t>();
    begun.signs.report = reader.take<OrientReport>();
    return begun;
}

} // namespace

NormalsReport make_cloud_normals(ScratchCloud& cloud, CloudSurvey& survey, const CloudNormalsOptions& options,
                                 std::optional<ScratchCloud>& as_read) {
    Begun begun = options.begun.empty() ? Begun() : begun_from(options.begun);
    const auto keep = [&](bool sided) {
        begun.is_sided = sided;
        if (options.keep) options.keep(sided, bytes_of_begun(begun));
    };
    PartStore store(cloud, options.passes.ghost_voxels);
    if (options.begun.empty()) {
        begun.scanners = options.scanners;
        clean(cloud, survey, options.passes, store, as_read, begun);
        keep(false);
    }
    if (!begun.is_sided) {
        begun.signs = find_signs(cloud, survey, begun.how, begun.scanners.orientation(), options.passes,
                                 options.memory, store);
        begun.report.orientation = begun.signs.report;
        keep(true);
    }
    ScratchCloud next = cloud.emptied(true, true);
    SidedPass pass(begun.how, begun.signs, store, cloud, next);
    const std::vector<VoxelRange> ranges = options.passes.plan(cloud, options.passes.ghost_voxels);
    for_parts(cloud, survey.sums, ranges, store.widths,
              [&](const CloudPart& part) { return pass.add(part); });
    NormalsReport report = begun.report;
    report.bent = cloud.ranks().sum(pass.bent), report.missing = cloud.ranks().sum(pass.missing);
    next.finish_sorted();
    cloud.take(std::move(next));
    return report;
}

} // namespace hsdm
