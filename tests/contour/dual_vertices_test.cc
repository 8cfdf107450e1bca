#include "contour/stages.hh"

#include <catch2/catch.hpp>
#include <tbb/global_control.h>

#include <set>

using namespace hsdm;
using support::Stages;

namespace {

/// How often each facet corner stands in a vertex.
std::vector<int> uses(const Stages& stages) {
    std::vector<int> count(4 * stages.crossings.crossings.size(), 0);
    for (FacetCorner corner : stages.duals.corners) ++count[corner.number()];
    return count;
}

/// The crossing that a vertex's facets lead to from one of its corners, or from which they come there.
Index beside(const Stages& stages, FacetCorner corner, bool onwards) {
    const Link& link =
        stages.links.of(stages.crossings.of(corner).leaving == onwards ? corner : corner.previous());
    return link.open() ? no_index : link.twin.crossing();
}

/// The corners of a vertex lie in one voxel, each linked with the next, round it or from end to end; every
/// corner has a vertex to either side.
void check_vertices(const Stages& stages) {
    const DualVertices& duals = stages.duals;
    std::vector<std::uint8_t> cut(duals.size() + 1, 0);
    for (Index v : duals.after_cut) cut[v] = cut[v - 1] = 1;
    std::size_t wrong = 0;
    for (Index v = 0; v < duals.size(); ++v) {
        const auto corners = duals.corners_of(v);
        REQUIRE(!corners.empty());
        std::set<Index> crossings;
        for (std::size_t i = 0; i < corners.size(); ++i) {
            wrong += !crossings.insert(corners[i].crossing()).second;
            wrong += stages.voxel_of(corners[i]).lo != stages.voxel_of(corners[0]).lo;
            if (i > 0) wrong += beside(stages, corners[i - 1], true) != corners[i].crossing();
        }
        if (cut[v]) continue;
        const Index before = beside(stages, corners.front(), false),
                    after = beside(stages, corners.back(), true);
        wrong += before != (duals.open[v] ? no_index : corners.back().crossing());
        wrong += after != (duals.open[v] ? no_index : corners.front().crossing());
    }
    REQUIRE(duals.of_corner.size() == 8 * stages.crossings.crossings.size());
    for (Index v : duals.of_corner) wrong += v >= duals.size();
    CHECK(wrong == 0);
}

support::Solid thin_plate() {
    return support::box({1, 1, 0.02}).placed(support::turned(Vec3(1, 2, 3), 0.4));
}

/// Does a piece of a chain go on in another, the way facets run round their vertices: at the same corner or
/// across a link?
bool follows(const Stages& stages, Index before, Index after) {
    const FacetCorner last = stages.duals.corners_of(before).back();
    const FacetCorner next = stages.duals.corners_of(after).front();
    const FacetSide way_on = stages.crossings.of(last).leaving ? last : last.previous();
    const Link& link = stages.links.of(way_on);
    const bool is_shared = stages.duals.to(last.previous()) != stages.duals.from(last);
    return is_shared ? last == next : !link.open() && (link.twin == next || link.twin.next() == next);
}

} // namespace

TEST_CASE("vertices are chains of linked corners in one voxel", "[contour]") {
    check_vertices(Stages(support::torus(1, 0.4), 10000, 4));
    check_vertices(Stages(support::mechanical_part(), 8000, 4));
    check_vertices(Stages(thin_plate(), 5000, 3));
    check_vertices(Stages(support::flat_sheet(40, 0.8, 0.3), 3, 1));
    check_vertices(Stages(support::random_cloud(200, 1), 2));
}

TEST_CASE("where nothing is cut each corner stands in one vertex, and Euler's formula holds", "[contour]") {
    for (const bool ring : {false, true}) {
        INFO((ring ? "torus" : "sphere"));
        const Stages stages(ring ? support::torus(1, 0.4) : support::sphere(1), 10000, 4);
        CHECK(stages.duals.after_cut.empty());
        CHECK(stages.duals.caps.empty());
        const std::vector<int> count = uses(stages);
        CHECK(std::count(count.begin(), count.end(), 1) == std::ssize(count));
        CHECK(std::count(stages.duals.open.begin(), stages.duals.open.end(), 0)
              == std::ssize(stages.duals.open));
        // V - E + F, with F crossings and 4 F / 2 links.
        const auto facets = std::ssize(stages.crossings.crossings);
        CHECK(std::ssize(stages.duals.first) - 1 - facets == (ring ? 0 : 2));
    }
}

TEST_CASE("where the surface ends its vertices are open, two open sides at each", "[contour]") {
    const Stages stages(support::flat_sheet(60, 0.8, 0.3), 3, 1);
    std::size_t open = 0;
    for (Index v = 0; v < stages.duals.size(); ++v) {
        int sides = 0;
        for (FacetCorner corner : stages.duals.corners_of(v))
            sides += (beside(stages, corner, true) == no_index) + (beside(stages, corner, false) == no_index);
        CHECK(sides == (stages.duals.open[v] ? 2 : 0));
        open += stages.duals.open[v];
    }
    CHECK(open > 10);
    CHECK(support::open_sides(stages.links) == open);
}

TEST_CASE("no vertex has both sides of a plate, and what is cut apart stays in its voxel", "[contour]") {
    const Stages stages(thin_plate(), 5000, 3);
    const DualVertices& duals = stages.duals;
    const Vec3 up = support::turned(Vec3(1, 2, 3), 0.4).rotate(Vec3(0, 0, 1));
    CHECK(duals.after_cut.size() > 10);
    std::size_t both = 0;
    for (Index v = 0; v < duals.size(); ++v) {
        double least = 0, most = 0;
        for (FacetCorner corner : duals.corners_of(v)) {
            const double cosine = stages.crossings.of(corner).normal | up;
            least = std::min(least, cosine);
            most = std::max(most, cosine);
        }
        both += least < -0.9 && most > 0.9;
    }
    CHECK(both == 0);
    for (Index v : duals.after_cut)
        CHECK(stages.voxel_of(duals.corners_of(v)[0]).lo == stages.voxel_of(duals.corners_of(v - 1)[0]).lo);
    const std::vector<int> count = uses(stages);
    CHECK(*std::min_element(count.begin(), count.end()) == 1);
    CHECK(*std::max_element(count.begin(), count.end()) == 2); // cut in a facet: a corner of either
}

TEST_CASE("a corner that two vertices share has one of them beside either face", "[contour]") {
    const Stages stages(thin_plate(), 5000, 3);
    const DualVertices& duals = stages.duals;
    const std::vector<int> count = uses(stages);
    std::size_t wrong = 0;
    for (Index x = 0; x < stages.crossings.crossings.size(); ++x)
        for (const FacetCorner corner : corners_of_facet(x)) {
            const Index before = duals.to(corner.previous()), after = duals.from(corner);
            wrong += (before != after) != (count[corner.number()] == 2);
            for (Index v : {before, after}) {
                const auto corners = duals.corners_of(v);
                wrong += std::ranges::find(corners, corner) == corners.end();
            }
        }
    CHECK(wrong == 0);
}

TEST_CASE("three vertices and more of one closed chain have a cap, which runs against them", "[contour]") {
    std::size_t caps = 0, wrong = 0;
    for (std::uint64_t seed = 1; seed <= 2; ++seed) {
        const Stages stages(support::random_cloud(200, seed), 2);
        caps += stages.duals.caps.size();
        const auto& cut = stages.duals.after_cut;
        const auto is_after_cut = [&](Index v) { return std::binary_search(cut.begin(), cut.end(), v); };
        for (const std::vector<Index>& cap : stages.duals.caps) {
            REQUIRE(cap.size() >= 3);
            const auto last = cap[0] + static_cast<Index>(cap.size()) - 1;
            // Facets run from each vertex of the chain to the next, or to the one before.
            const bool up = follows(stages, cap[0], cap[0] + 1);
            wrong += up == follows(stages, cap[0] + 1, cap[0]);
            wrong += is_after_cut(cap[0]) || stages.duals.open[cap[0]] || is_after_cut(last + 1);
            for (Index i = 1; i < cap.size(); ++i)
                wrong += stages.duals.open[cap[i]] || !is_after_cut(cap[i])
                         || cap[i] != (up ? last + 1 - i : cap[0] + i);
        }
    }
    CHECK(caps > 0);
    CHECK(wrong == 0);
}

TEST_CASE("dual vertices do not depend on the number of threads", "[contour]") {
    const Stages many(thin_plate(), 8000, 4);
    const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
    const DualVertices single =
        build_dual_vertices(many.grid, many.crossings, many.sets, many.h(), many.links);
    CHECK(many.duals.corners == single.corners);
    CHECK(many.duals.first == single.first);
    CHECK(many.duals.of_corner == single.of_corner);
    CHECK(many.duals.open == single.open);
    CHECK(many.duals.after_cut == single.after_cut);
    CHECK(many.duals.caps == single.caps);
}
