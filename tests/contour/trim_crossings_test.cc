#include "hsdm/contour/trim_crossings.hh"

#include "contour/stages.hh"

#include <catch2/catch.hpp>

using namespace hsdm;
using support::Stages;

namespace {

Stages sphere() {
    return {support::sphere(1), 20000, 4};
}

Vec3 place_of(const Stages& stages, Index x) {
    return crossing_position(stages.grid, stages.crossings.crossings[x], stages.h());
}

/// The crossings from `least` up to `most` voxels from one of them.
std::vector<std::uint8_t> ring_about(const Stages& stages, Index middle, double least, double most) {
    std::vector<std::uint8_t> marked(stages.crossings.crossings.size(), 0);
    for (Index x = 0; x < marked.size(); ++x) {
        const double distance = (place_of(stages, x) - place_of(stages, middle)).norm() / stages.h();
        marked[x] = distance >= least && distance <= most;
    }
    return marked;
}

std::size_t count(const std::vector<std::uint8_t>& marked) {
    return static_cast<std::size_t>(std::count(marked.begin(), marked.end(), 1));
}

/// Supported but for those that are marked.
void support_others(Crossings& crossings, const std::vector<std::uint8_t>& marked) {
    for (std::size_t x = 0; x < marked.size(); ++x) crossings.crossings[x].supported = !marked[x];
}

/// Takes a disc away, so that the data end there, and says of a ring about it that nothing carries it.
/// Returns how many are in the ring and how many of these go.
std::pair<std::size_t, std::size_t> trimmed_about(double hole, double ring) {
    Stages stages = sphere();
    const Index middle = 400;
    std::vector<std::uint8_t> marked = ring_about(stages, middle, hole + 1e-9, ring);
    support_others(stages.crossings, marked);
    stages.crossings = support::without(stages.crossings, ring_about(stages, middle, 0, hole));
    stages.pair();
    REQUIRE(support::open_sides(stages.links) > 0);
    const std::size_t before = stages.crossings.crossings.size();
    const std::size_t gone = trim_unsupported(stages.crossings, stages.links);
    CHECK(stages.crossings.crossings.size() == before - gone);
    CHECK(stages.crossings.first.back() == before - gone);
    CHECK(stages.crossings.trimmed == gone);
    return {count(marked), gone};
}

/// Two crossings on one edge, the only one, joined to each other on so many sides.
struct Pair {
    NormalSets sets;
    Crossings crossings;
    Links links;

    Pair(const NormalSet& a, const NormalSet& b, int joined) {
        sets.sets = {a, b};
        crossings.crossings = {{0.4, a.normal, 1, 0, false, true}, {0.6, b.normal, 1, 1, true, true}};
        crossings.first = {0, 0, 2, 2};
        links.of_crossing.resize(2);
        for (unsigned j = 0; j < static_cast<unsigned>(joined); ++j) {
            links.of({0, j}).twin = {1, j};
            links.of({1, j}).twin = {0, j};
        }
    }
    std::size_t drop() { return drop_tips(sets, RelationTest({}, 1), links, crossings); }
};

NormalSet set_at(const Vec3& centroid, const Vec3& normal) {
    return {centroid, normal.normalized(), 20, 0, Spread{{0.05, 0.05, 0.05, 0, 0, 0}}};
}

} // namespace

TEST_CASE("a closed surface loses no crossing, whatever the data carry", "[contour]") {
    Stages stages = sphere();
    const std::size_t before = stages.crossings.crossings.size();
    for (const double reach : {3.0, 100.0}) {
        support_others(stages.crossings, ring_about(stages, 400, 0, reach));
        CHECK(trim_unsupported(stages.crossings, stages.links) == 0);
        CHECK(stages.crossings.crossings.size() == before);
        CHECK(stages.crossings.trimmed == 0);
    }
}

TEST_CASE("beyond a border what the data do not carry goes, and nothing else", "[contour]") {
    Stages stages(support::flat_sheet(60, 1, 0.3), 4, 1);
    stages.trim();
    stages.crossings.trimmed = 0;
    auto& list = stages.crossings.crossings;
    const std::size_t before = list.size();
    std::size_t beyond = 0, island = 0;
    for (Index x = 0; x < list.size(); ++x) {
        const Vec3 p = place_of(stages, x);
        const bool is_beyond = p[0] < 0.3, is_inside = (p - Vec3(0.7, 0.5, 0.3)).norm() < 0.1;
        list[x].supported = !is_beyond && !is_inside;
        beyond += is_beyond;
        island += is_inside;
    }
    CHECK(beyond > 20);
    CHECK(island > 3);
    CHECK(trim_unsupported(stages.crossings, stages.links) == beyond);
    CHECK(stages.crossings.trimmed == beyond);
    CHECK(list.size() == before - beyond);
    std::size_t wrong = 0;
    for (Index edge = 0; edge + 1 < stages.crossings.first.size(); ++edge)
        for (const Crossing& x : stages.crossings.on_edge(edge)) wrong += x.edge != edge;
    for (Index x = 0; x < list.size(); ++x) wrong += place_of(stages, x)[0] < 0.3;
    CHECK(wrong == 0);
    stages.pair();
    CHECK(trim_unsupported(stages.crossings, stages.links) == 0);
}

TEST_CASE("beside a short loop a patch stays, as the boundary would get longer, beside a border it goes",
          "[contour]") {
    const auto [beside_short, gone] = trimmed_about(1, 2);
    CHECK(beside_short > 5);
    CHECK(gone == 0);
    const auto [beside_long, all] = trimmed_about(4, 5);
    CHECK(beside_long > 5);
    CHECK(all == beside_long);
}

TEST_CASE("a loop of up to 16 sides is a defect, a longer one a border", "[contour]") {
    const Stages whole = sphere();
    std::size_t most_of_defects = 0, least_of_borders = 100;
    for (double hole = 0; hole < 4; hole += 0.25) {
        Stages stages = whole;
        stages.crossings = support::without(whole.crossings, ring_about(whole, 400, 0, hole));
        stages.pair();
        Index beside = 0; // by one side
        while (std::ranges::count_if(stages.links.of_crossing[beside], &Link::open) != 1) ++beside;
        support_others(stages.crossings, ring_about(stages, beside, 0, 1e-9));
        const std::size_t sides = support::open_sides(stages.links);
        if (trim_unsupported(stages.crossings, stages.links) > 0)
            least_of_borders = std::min(least_of_borders, sides);
        else
            most_of_defects = std::max(most_of_defects, sides);
    }
    CHECK(most_of_defects <= 16);
    CHECK(most_of_defects >= 12);
    CHECK(least_of_borders > 16);
    CHECK(least_of_borders <= 18);
}

TEST_CASE("a short loop amid a wide patch is a border", "[contour]") {
    const auto [in_patch, gone] = trimmed_about(1, 5); // the patch's outline is what counts
    CHECK(in_patch > 30);
    CHECK(gone == in_patch);
}

TEST_CASE("a crossing that hangs by one side goes, whether carried or not", "[contour]") {
    Stages stages = sphere();
    const Index hanging = 400;
    std::vector<std::uint8_t> marked(stages.crossings.crossings.size(), 0);
    for (unsigned j = 0; j < 3; ++j) marked[stages.links.of({hanging, j}).twin.crossing()] = 1;
    REQUIRE(count(marked) == 3);
    const Vec3 place = place_of(stages, hanging);
    support_others(stages.crossings, std::vector<std::uint8_t>(marked.size(), 0));
    stages.crossings = support::without(stages.crossings, marked);
    stages.pair();
    CHECK(trim_unsupported(stages.crossings, stages.links) == 1);
    for (Index x = 0; x < stages.crossings.crossings.size(); ++x) CHECK(place_of(stages, x) != place);
}

TEST_CASE("two crossings of one edge joined on three sides are a tip and go", "[contour]") {
    const NormalSet left = set_at({-0.3, 0, 0}, {-1, 0, 1}), right = set_at({0.3, 0, 0}, {1, 0, 1});
    for (int joined = 0; joined <= 4; ++joined) {
        INFO("joined on " << joined << " sides");
        Pair pair(left, right, joined);
        CHECK(pair.drop() == (joined >= 3 ? 1 : 0));
        CHECK(pair.crossings.tips == (joined >= 3 ? 1 : 0));
        CHECK(pair.crossings.crossings.size() == (joined >= 3 ? 0 : 2));
        CHECK(pair.crossings.first.back() == pair.crossings.crossings.size());
    }
}

TEST_CASE("the two sides of a thin part stay, others go", "[contour]") {
    const NormalSet below = set_at({0, 0, 0}, {0, 0, -1}), above = set_at({0, 0, 0.5}, {0, 0, 1});
    REQUIRE(RelationTest({}, 1)(below, above) == Relation::none);
    CHECK(Pair(below, above, 4).drop() == 0);
    const NormalSet left = set_at({-0.1, 0, -0.2}, {-1, 0, 0.4}), right = set_at({0.1, 0, -0.2}, {1, 0, 0.4});
    REQUIRE(RelationTest({}, 1)(left, right) == Relation::convex);
    REQUIRE((left.normal | right.normal) < -0.3);
    CHECK(Pair(left, right, 4).drop() == 1);
    const NormalSet lower = set_at({0, 0, 0}, {0, 0, 1});
    REQUIRE(RelationTest({}, 1)(lower, above) == Relation::none);
    CHECK(Pair(lower, above, 4).drop() == 1); // both face up
}

TEST_CASE("a surface stays closed without its tips", "[contour]") {
    std::size_t tips = 0;
    support::Random random(5);
    for (int i = 0; i < 12; ++i) {
        Stages stages(support::wedge(0.4, 1, 0.5).placed(support::random_pose(random)), 1500, 3);
        if (support::open_sides(stages.links) > 0) continue;
        for (int round = 0; round < 3; ++round) {
            tips += drop_tips(stages.sets, stages.related, stages.links, stages.crossings);
            stages.pair();
        }
        CHECK(support::open_sides(stages.links) == 0);
        CHECK(drop_tips(stages.sets, stages.related, stages.links, stages.crossings) == 0);
    }
    CHECK(tips > 0);
}
