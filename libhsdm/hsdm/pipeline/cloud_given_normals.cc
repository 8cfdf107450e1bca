#include "hsdm/pipeline/cloud_given_normals.hh"

#include "hsdm/core/large_vector.hh"
#include "hsdm/normals/steady_normals.hh"
#include "hsdm/pipeline/cell_attributes.hh"
#include "hsdm/pipeline/cloud_signs.hh"

#include <algorithm>

namespace hsdm {
namespace {

Estimating estimating(ScratchCloud& cloud, const CloudSurvey& survey, const CloudPasses& passes) {
    Estimating how;
    how.neighbors.finest_level = survey.sums.finest_leaves();
    how.estimate.noise = relative_noise(cloud, survey, passes);
    return how;
}

/// The told normals of the points that check_normals() looks at.
NormalSample sample_of_told(ScratchCloud& cloud, const Survey& sums, std::span<const VoxelRange> ranges,
                            const Estimating& how, PartStore& store) {
    struct Row {
        std::size_t number;
        NormalSample::Point point;
    };
    std::vector<Row> rows;
    for_parts(cloud, sums, ranges, store.widths, [&](const CloudPart& part) {
        if (part.lacks_neighbors(how.neighbors.count)) return false;
        PartEstimate told(part, how, store);
        const std::vector<Vec3> normals = told.refine(part);
        if (!told.known.all(part.begin(), part.end())) return false;
        for (std::size_t i = part.begin(); i < part.end(); ++i)
            if (const std::size_t number = part.number(i); NormalSample::holds(number, sums.points()))
                push_large(rows, Row{number, {part.octree().positions[i], normals[i]}});
        return true;
    });
    std::vector<Row> all = values_of_all(cloud.ranks(), rows);
    std::ranges::sort(all, {}, &Row::number);
    NormalSample sample;
    for (const Row& row : all) sample.points.push_back(row.point);
    return sample;
}

/// work(part, octree) gives an octree of the part's points its normals; returns false if not all is known.
/// The cloud that has these.
template <class Work>
ScratchCloud with_normals(ScratchCloud& cloud, const Survey& sums, std::span<const VoxelRange> ranges,
                          PartStore& store, const Work& work) {
    ScratchCloud next = cloud.emptied(true, true);
    CellAttributes beside(cloud);
    for_parts(cloud, sums, ranges, store.widths, [&](const CloudPart& part) {
        std::vector<Vec3> normals = part.octree().normals;
        if (!work(part, normals)) return false;
        for (std::size_t i = part.begin(); i < part.end(); ++i) {
            PointRow row = ScratchCloud::row_at(part.octree(), i);
            std::copy_n(normals[i].data(), 3, row.begin() + 3);
            next.add(part.octree().codes[i], row, beside.of(part.octree(), i));
        }
        return true;
    });
    next.finish_sorted();
    return next;
}

NormalConsistency consistency_of(const CloudSurvey& survey, const ScratchCloud& cloud) {
    const Survey& sums = survey.sums;
    return check_normals(sums.normals(), sums.points(), estimate_spacing(sums.counts(), cloud.cube_extent()));
}

} // namespace

std::size_t steady_cloud_normals(ScratchCloud& cloud, CloudSurvey& survey, const CloudPasses& passes,
                                 PartStore& store) {
    const Survey& sums = survey.sums;
    const Estimating how = estimating(cloud, survey, passes);
    const std::vector<VoxelRange> ranges = passes.plan(cloud, passes.ghost_voxels);
    const NormalSample told_sample = sample_of_told(cloud, sums, ranges, how, store);
    if (!are_steadier(told_sample, sums.normals(), sums.points())) return 0;
    std::uint64_t changed = 0;
    ScratchCloud next =
        with_normals(cloud, sums, ranges, store, [&](const CloudPart& part, std::vector<Vec3>& normals) {
            if (part.lacks_neighbors(how.neighbors.count)) return false;
            PartEstimate told(part, how, store);
            told.estimate.normals = told.refine(part);
            turn_along(normals, told.estimate.normals);
            told.vote(part);
            if (!told.known.all(part.begin(), part.end())) return false;
            for (std::size_t i = part.begin(); i < part.end(); ++i)
                changed += take_axis(told.estimate.normals[i], normals[i]);
            return true;
        });
    cloud.take(std::move(next));
    survey.sums = survey_cloud(cloud, sums.points(), passes.most_points).sums;
    return cloud.ranks().sum(changed);
}

std::size_t mend_cloud_normals(ScratchCloud& cloud, CloudSurvey& survey, OrientOptions options,
                               const CloudPasses& passes, std::size_t memory, PartStore& store) {
    const NormalConsistency before = consistency_of(survey, cloud);
    Estimating how = estimating(cloud, survey, passes);
    const bool askew = before.askew();
    how.normals = askew ? Estimating::Normals::along_given : Estimating::Normals::given;
    if (!askew) how.estimate.rounds = 0;
    options.signs_count = true;
    const SignsOfAll signs = find_signs(cloud, survey, how, options, passes, memory, store);
    std::uint64_t turned = 0;
    ScratchCloud next =
        with_normals(cloud, survey.sums, passes.plan(cloud, passes.ghost_voxels), store,
                     [&](const CloudPart& part, std::vector<Vec3>& normals) {
                         if (part.lacks_neighbors(how.neighbors.count)) return false;
                         PartNormals made(part, how, store);
                         turn_normals({turns_of(made.patches, made.signs(signs)), {}}, made.estimate.normals);
                         if (askew) {
                             turn_to_neighbors(made.estimate.normals, made.neighbors, normals);
                             made.known.step();
                         } else {
                             normals = std::move(made.estimate.normals);
                         }
                         if (!made.known.all(part.begin(), part.end())) return false;
                         for (std::size_t i = part.begin(); i < part.end(); ++i)
                             turned += (normals[i] | part.octree().normals[i]) < 0;
                         return true;
                     });
    CloudSurvey after = survey_cloud(next, survey.sums.points(), passes.most_points);
    if (came_of_noise(before, consistency_of(after, next))) return 0;
    cloud.take(std::move(next));
    survey.sums = std::move(after.sums);
    return cloud.ranks().sum(turned);
}

} // namespace hsdm
