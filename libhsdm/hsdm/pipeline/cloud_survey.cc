#include "hsdm/pipeline/cloud_survey.hh"

#include "hsdm/pipeline/tile_plan.hh"

#include <numeric>

namespace hsdm {

namespace {

Survey survey_of(ScratchCloud& cloud, std::size_t expected, std::size_t before, std::size_t most_points) {
    Survey sums(cloud.depth(), cloud.cell_depth(), expected, before);
    cloud.sort_in_cells(most_points, [&](const Octree& part) { sums.add(part); });
    const std::vector<std::uint64_t> points = cloud.ranks().gather(std::uint64_t{sums.points()});
    const auto here = points.begin() + cloud.ranks().rank();
    const std::size_t all = std::accumulate(points.begin(), points.end(), std::size_t{0}),
                      really_before = std::accumulate(points.begin(), here, std::size_t{0});
    if (cloud.ranks().any(all != expected || really_before != before)) // other ones are sampled
        return survey_of(cloud, all, really_before, most_points);
    sums.join(cloud.ranks());
    return sums;
}

} // namespace

CloudSurvey survey_cloud(ScratchCloud& cloud, std::size_t expected, std::size_t most_points) {
    Survey sums = survey_of(cloud, expected, cloud.points_before(), most_points);
    const double spacing = estimate_spacing(sums.counts(), cloud.cube_extent());
    return {std::move(sums), spacing};
}

void refuse_unfit_places(const CloudSurvey& survey, const ScratchCloud& cloud) {
    const Survey& sums = survey.sums;
    if (spans_no_surface(sums.places(), cloud.cube_extent()))
        refuse_in_tiles("too few points, or all on a line");
    if (has_far_points(sums.places(), cloud.cube_extent(), survey.spacing))
        refuse_in_tiles("some points, or parts, are far from all others");
}

} // namespace hsdm
