#include "hsdm/contour/relax_vertices.hh"

#include "contour/stages.hh"
#include "hsdm/contour/point_fit.hh"
#include "hsdm/errors.hh"

#include <catch2/catch.hpp>
#include <tbb/global_control.h>

#include <numeric>

using namespace hsdm;
using support::Stages;

namespace {

Stages part() {
    return {support::mechanical_part(support::turned(Vec3(1, 2, 3), 0.5)), 20000, 5};
}

PlacedVertices relaxed(const Stages& stages, const RelaxOptions& options = {}) {
    PlacedVertices vertices = stages.vertices;
    relax_vertices(stages.octree, stages.level, stages, options, vertices);
    return vertices;
}

bool is_inside(const Box& box, const Vec3& p, double slack) {
    for (unsigned k = 0; k < 3; ++k)
        if (p[k] < box.lo[k] - slack || p[k] > box.hi[k] + slack) return false;
    return true;
}

/// Mean of the squared lengths of the facets' sides over the square of their mean: 1 where all are alike.
double unevenness(const Stages& stages, const std::vector<Vec3>& positions) {
    double sum = 0, squares = 0, count = 0;
    for (Index x = 0; x < stages.crossings.crossings.size(); ++x)
        for (const FacetSide side : corners_of_facet(x)) {
            const Index a = stages.duals.from(side), b = stages.duals.to(side);
            const double length = (positions[a] - positions[b]).norm();
            sum += length, squares += length * length, ++count;
        }
    return squares * count / (sum * sum);
}

double misfit(const Stages& stages, const std::vector<Vec3>& positions) {
    const PointFit fit(stages.octree, stages.level, stages.duals, stages.vertices);
    const std::vector<double> all = fit.measure(positions).misfit;
    return std::accumulate(all.begin(), all.end(), 0.0);
}

/// How many vertices of a kind have moved.
template <class IsKind>
std::size_t moved(const Stages& stages, const PlacedVertices& vertices, const IsKind& is_kind) {
    std::size_t count = 0;
    for (Index v = 0; v < stages.duals.size(); ++v)
        count += is_kind(v) && vertices.positions[v] != stages.vertices.positions[v];
    return count;
}

} // namespace

TEST_CASE("options of relaxation out of range are refused, without rounds and fit nothing moves",
          "[contour]") {
    const Stages stages(support::sphere(1), 3000, 3);
    CHECK_THROWS_AS(relaxed(stages, {.rounds = -1}), OptionError);
    CHECK_THROWS_AS(relaxed(stages, {.step = 0}), OptionError);
    CHECK_THROWS_AS(relaxed(stages, {.step = 1.1}), OptionError);
    CHECK(relaxed(stages, {.rounds = 0, .fit = false}).positions == stages.vertices.positions);
}

TEST_CASE("corners and borders stay, vertices of creases move along these", "[contour]") {
    const Stages stages = part();
    const PlacedVertices after = relaxed(stages);
    const auto is = [&](VertexClass kind) {
        return [&, kind](Index v) { return stages.vertices.classes[v] == kind; };
    };
    CHECK(moved(stages, after, is(VertexClass::smooth)) > 500);
    CHECK(moved(stages, after, is(VertexClass::edge)) > 100);
    CHECK(moved(stages, after, is(VertexClass::corner)) == 0);
    double aside = 0;
    for (Index v = 0; v < stages.duals.size(); ++v) {
        if (stages.vertices.classes[v] != VertexClass::edge) continue;
        const Vec3 way = after.positions[v] - stages.vertices.positions[v];
        aside = std::max(aside, (way % stages.vertices.directions[v]).norm());
    }
    CHECK(aside < 1e-12);
    Stages sheet(support::flat_sheet(60, 0.8, 0.3), 3, 1);
    sheet.trim();
    extend_borders(sheet, sheet.sets, sheet.vertices);
    const PlacedVertices on_sheet = relaxed(sheet, {.fit = false}); // which might put them back
    CHECK(moved(sheet, on_sheet, [&](Index v) { return sheet.duals.open[v] == 0; }) > 0);
    CHECK(moved(sheet, on_sheet, [&](Index v) { return sheet.duals.open[v] != 0; }) == 0);
}

TEST_CASE("no vertex leaves its voxel", "[contour]") {
    const Stages stages = part();
    const PlacedVertices after = relaxed(stages, {.rounds = 10, .step = 1});
    std::size_t inside = 0, left = 0;
    for (Index v = 0; v < stages.duals.size(); ++v) {
        const Box voxel = stages.voxel_of(stages.duals.corners_of(v)[0]);
        if (!is_inside(voxel, stages.vertices.positions[v], 0)) continue; // was placed beyond
        ++inside;
        left += !is_inside(voxel, after.positions[v], 1e-12);
    }
    CHECK(inside > stages.duals.size() / 2);
    CHECK(left == 0);
}

TEST_CASE("the vertices of a plane stay on it, and their distances get more even", "[contour]") {
    const Stages stages(support::box({1, 1, 1}).placed(support::turned(Vec3(1, 2, 3), 0.5)), 6000, 3);
    const PlacedVertices after = relaxed(stages, {.fit = false});
    double off = 0;
    for (Index v = 0; v < stages.duals.size(); ++v) {
        if (stages.vertices.classes[v] != VertexClass::smooth || stages.vertices.is_clamped[v]) continue;
        const Vec3 way = after.positions[v] - stages.vertices.positions[v];
        off = std::max(off, std::abs(stages.vertices.directions[v] | way));
    }
    CHECK(off < 1e-6 * stages.h());
    CHECK(unevenness(stages, after.positions) < unevenness(stages, stages.vertices.positions));
    const Stages round(support::sphere(1), 20000, 4);
    CHECK(unevenness(round, relaxed(round, {.fit = false}).positions)
          < 0.99 * unevenness(round, round.vertices.positions));
}

TEST_CASE("each round makes distances more even, a tiny step moves vertices but little", "[contour]") {
    const Stages stages(support::sphere(1), 20000, 4);
    double before = unevenness(stages, stages.vertices.positions);
    for (const int rounds : {1, 2, 3}) {
        const double after = unevenness(stages, relaxed(stages, {.rounds = rounds, .fit = false}).positions);
        CHECK(after < before);
        before = after;
    }
    const PlacedVertices barely = relaxed(stages, {.rounds = 1, .step = 1e-9, .fit = false});
    double farthest = 0;
    for (Index v = 0; v < stages.duals.size(); ++v)
        farthest = std::max(farthest, (barely.positions[v] - stages.vertices.positions[v]).norm());
    CHECK(farthest > 0);
    CHECK(farthest < 0.1 * stages.h()); // onto the sheet of those around
}

TEST_CASE("on a curved surface the sheet moves amid the points", "[contour]") {
    const Stages stages(support::sphere(1), 20000, 4);
    const double placed = misfit(stages, stages.vertices.positions);
    CHECK(misfit(stages, relaxed(stages).positions) < 0.436 * placed); // 0.45 without the second step
    CHECK(misfit(stages, relaxed(stages, {.rounds = 0}).positions) < 0.5 * placed);
    // Even vertices are nearer without that, if they keep to the sheet.
    const double even = misfit(stages, relaxed(stages, {.fit = false}).positions);
    CHECK(even < 0.9 * placed);
    CHECK(even > 0.7 * placed);
}

TEST_CASE("where relaxation brings the points farther off vertices go back, and all if these are in all",
          "[contour]") {
    const Stages whole(support::sphere(1), 20000, 4);
    for (const bool everywhere : {false, true}) {
        Stages stages = whole;
        const auto is_bad = [&](Index v) {
            return everywhere || (stages.vertices.positions[v] + stages.octree.origin)[2] > 0.85;
        };
        for (Index v = 0; v < stages.duals.size(); ++v) // directions that lead off the sheet
            if (is_bad(v))
                stages.vertices.directions[v] = (stages.vertices.directions[v] + Vec3(2, 1, 0)).normalized();
        const PlacedVertices free = relaxed(stages, {.fit = false}), after = relaxed(stages);
        CHECK(misfit(stages, free.positions) > misfit(stages, stages.vertices.positions));
        CHECK(misfit(stages, after.positions) <= misfit(stages, stages.vertices.positions));
        const std::size_t bad = moved(stages, free, is_bad);
        CHECK(bad > 30);
        CHECK(moved(stages, after, is_bad) < (everywhere ? 1 : bad / 2));
        if (!everywhere) CHECK(moved(stages, after, [&](Index v) { return !is_bad(v); }) > bad);
    }
}

TEST_CASE("relaxed vertices do not depend on the number of threads", "[contour]") {
    const Stages stages = part();
    const PlacedVertices many = relaxed(stages);
    const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
    CHECK(relaxed(stages).positions == many.positions);
}
