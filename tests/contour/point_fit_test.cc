#include "hsdm/contour/point_fit.hh"

#include "contour/stages.hh"

#include <catch2/catch.hpp>
#include <tbb/global_control.h>

#include <numeric>

using namespace hsdm;
using support::Stages;

namespace {

Stages sheet() {
    return {support::flat_sheet(60, 1, 0.3), 3, 1};
}

PointFit fit_of(const Stages& stages) {
    return {stages.octree, stages.level, stages.duals, stages.vertices};
}

/// Heights of the same points round every vertex.
std::vector<PointFit::Heights> everywhere(const Stages& stages, const std::vector<double>& heights) {
    PointFit::Heights sum;
    for (double h : heights) sum.add(1, h);
    return std::vector<PointFit::Heights>(stages.duals.size(), sum);
}

bool is_inner_smooth(const Stages& stages, std::size_t v) {
    return !stages.duals.open[v] && stages.vertices.classes[v] == VertexClass::smooth;
}

} // namespace

TEST_CASE("heights have the mean and the variance of the mean that weighted points have", "[contour]") {
    const std::vector<double> values{1, 2, 4, 7};
    for (const double weight : {1.0, 0.3}) {
        PointFit::Heights heights;
        for (double value : values) heights.add(weight, value);
        CHECK(heights.mean() == Approx(3.5));
        // 6.25 + 2.25 + 0.25 + 12.25 over n (n - 1)
        CHECK(heights.variance() == Approx(21.0 / 12));
    }
    PointFit::Heights uneven;
    uneven.add(0.75, 2);
    uneven.add(0.25, 6);
    CHECK(uneven.mean() == Approx(3));
    CHECK(uneven.variance() == Approx((0.5625 * 1 + 0.0625 * 9) / (1 - 0.625)));
}

TEST_CASE("one point's height may be off by all of it, none have none", "[contour]") {
    PointFit::Heights one, none;
    one.add(0.5, 3);
    CHECK(one.mean() == Approx(3));
    CHECK(one.variance() == Approx(9));
    CHECK(none.mean() == 0);
    CHECK(none.variance() == 0);
}

TEST_CASE("vertices rise by what their points agree on and not at all by what chance makes", "[contour]") {
    const Stages stages = sheet();
    const PointFit fit = fit_of(stages);
    for (double rise : fit.rises(everywhere(stages, {0.02, 0.02, 0.02, 0.02}))) CHECK(rise == Approx(0.02));
    for (double rise : fit.rises(everywhere(stages, {-0.05, 0.06, -0.04, 0.04}))) CHECK(rise == 0);
    // In between the rise shrinks by twice the variance over the square.
    const PointFit::Heights some = everywhere(stages, {0.01, 0.03, 0.02, 0.02})[0];
    const double expected = 0.02 * (1 - 2 * some.variance() / (0.02 * 0.02));
    CHECK(expected > 0.01);
    for (double rise : fit.rises(everywhere(stages, {0.01, 0.03, 0.02, 0.02})))
        CHECK(rise == Approx(expected));
    for (double rise : fit.rises(everywhere(stages, {}))) CHECK(rise == 0);
}

TEST_CASE("points on the facets are no misfit, points over them are one of as much", "[contour]") {
    const Stages stages = sheet();
    const PointFit fit = fit_of(stages);
    const PointFit::Measure on = fit.measure(stages.vertices.positions);
    std::vector<Vec3> lower = stages.vertices.positions;
    const double depth = 0.1 * stages.h();
    for (Vec3& p : lower) p[2] -= depth;
    const PointFit::Measure under = fit.measure(lower);
    REQUIRE(under.misfit.size() == stages.level.size());
    REQUIRE(under.heights.size() == stages.duals.size());
    std::size_t inner = 0;
    for (Index v = 0; v < stages.duals.size(); ++v) {
        CHECK(on.heights[v].mean() == Approx(0).margin(1e-9));
        if (!is_inner_smooth(stages, v)) {
            CHECK(under.heights[v].weight == 0);
            continue;
        }
        ++inner;
        CHECK(under.heights[v].mean() == Approx(depth));
        CHECK(under.heights[v].variance() == Approx(0).margin(1e-12));
        // Amid the sheet the points of a voxel all have their feet on facets.
        const Index voxel = stages.vertices.voxel[v];
        CHECK(on.misfit[voxel] == Approx(0).margin(1e-9));
        const auto points = stages.level.first_point[voxel + 1] - stages.level.first_point[voxel];
        const auto taken = static_cast<double>(std::min(points, 8u));
        CHECK(under.misfit[voxel] >= 0.6 * taken * depth);
        CHECK(under.misfit[voxel] <= 1.001 * taken * depth);
    }
    CHECK(inner > 20);
}

TEST_CASE("each point counts in all for one, by its weights at the corners of its triangle", "[contour]") {
    const Stages stages(support::sphere(1), 20000, 4); // of more voxels than are looked at together
    const PointFit::Measure found = fit_of(stages).measure(stages.vertices.positions);
    double weight = 0, points = 0;
    for (const PointFit::Heights& heights : found.heights) weight += heights.weight;
    for (Index v = 0; v < stages.level.size(); ++v) {
        const Index count = stages.level.first_point[v + 1] - stages.level.first_point[v];
        const Index stride = (count + 7) / 8; // at most eight, evenly taken
        points += (count + stride - 1) / stride;
    }
    CHECK(points > 2000);
    CHECK(weight == Approx(points));
}

TEST_CASE("round a sphere that is too small all smooth vertices are to rise", "[contour]") {
    const Stages stages(support::sphere(1), 20000, 4);
    const PointFit fit = fit_of(stages);
    const Vec3 centre = -stages.octree.origin;
    std::vector<Vec3> shrunk = stages.vertices.positions;
    for (Vec3& p : shrunk) p = centre + (p - centre) * 0.98;
    const PointFit::Measure before = fit.measure(shrunk);
    const std::vector<double> rises = fit.rises(before.heights);
    for (std::size_t v = 0; v < rises.size(); ++v) {
        CHECK(rises[v] > 0.01);
        CHECK(rises[v] < 0.04);
        shrunk[v] += stages.vertices.directions[v] * rises[v];
    }
    const PointFit::Measure after = fit.measure(shrunk);
    const auto sum = [](const std::vector<double>& all) {
        return std::accumulate(all.begin(), all.end(), 0.0);
    };
    CHECK(sum(after.misfit) < 0.3 * sum(before.misfit));
}

TEST_CASE("the fit does not depend on the number of threads", "[contour]") {
    const Stages stages(support::mechanical_part(), 20000, 5);
    const PointFit fit = fit_of(stages);
    const PointFit::Measure many = fit.measure(stages.vertices.positions);
    const std::vector<double> rises = fit.rises(many.heights);
    const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
    const PointFit::Measure single = fit.measure(stages.vertices.positions);
    CHECK(single.misfit == many.misfit);
    CHECK(fit.rises(single.heights) == rises);
}
