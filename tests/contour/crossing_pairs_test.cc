#include "contour/stages.hh"

#include <catch2/catch.hpp>
#include <tbb/global_control.h>

#include <map>
#include <optional>
#include <set>
#include <string>

using namespace hsdm;
using support::open_sides;
using support::rim_sides;
using support::Stages;

namespace {

/// Twice the middle of the grid face that a side passes through.
VoxelCoord middle_of_face(const Stages& stages, FacetSide side) {
    const Index edge = stages.crossings.of(side).edge;
    const unsigned axis = edge % 3, k = side.j();
    VoxelCoord at = stages.grid.coord(edge / 3);
    for (auto& c : at) c *= 2;
    ++at[axis];
    at[(axis + (k % 2 == 1 ? 1 : 2)) % 3] += k == 1 || k == 2 ? 1 : -1;
    return at;
}

/// Does the way round the face leave the solid at the crossing? Ways along a and b lead round it one after
/// the other, so those of faces 0 and 1 run up their edges, those of 2 and 3 down.
bool exits(const Stages& stages, FacetSide side) {
    return stages.crossings.of(side).leaving == (side.j() < 2);
}

/// What is wrong with the first link that is not as it should be; empty if all are.
std::string link_fault(const Stages& stages) {
    const auto& list = stages.crossings.crossings;
    if (stages.links.of_crossing.size() != list.size()) return "no four sides for each crossing";
    for (Index x = 0; x < list.size(); ++x)
        for (const FacetSide side : corners_of_facet(x)) {
            const Link& link = stages.links.of(side);
            if (link.open()) continue;
            const Link& back = stages.links.of(link.twin);
            const std::string what = "side " + std::to_string(side.number());
            if (back.twin != side || back.rim != link.rim) return what + " is not linked both ways";
            if (middle_of_face(stages, side) != middle_of_face(stages, link.twin))
                return what + " is linked with a side through another face";
            if (exits(stages, side) == exits(stages, link.twin))
                return what + " and its twin both leave the solid, or both enter it";
            if (link.rim != opposed(list[x], stages.crossings.of(link.twin)))
                return what + " takes a rim for none, or none for a rim";
        }
    return "";
}

/// How far round its face a side's crossing is, from 0 to 4.
double way_round(const Stages& stages, FacetSide side) {
    const double t = stages.crossings.of(side).t;
    return std::array{1 + t, t, 4 - t, 3 - t}[side.j()];
}

/// Of the links of crowded faces, pairs that cross each other in their face.
int links_that_cross(const Stages& stages) {
    int count = 0;
    std::vector<std::array<double, 2>> links; // where they begin and end
    for (const FacetSide side : stages.links.crowded) {
        if (side == no_side) {
            links.clear();
            continue;
        }
        if (stages.links.of(side).open()) continue;
        double begin = way_round(stages, side), end = way_round(stages, stages.links.of(side).twin);
        if (end < begin) std::swap(begin, end);
        for (const auto& [from, to] : links)
            count += (from > begin && from < end) != (to > begin && to < end);
        links.push_back({begin, end});
    }
    return count;
}

/// Per face of the grid, how many links and open sides there are, where these are two or more. Where the grid
/// ends sides are open as well, but of no face.
std::map<VoxelCoord, int> crowded_faces(const Stages& stages) {
    std::map<VoxelCoord, int> count;
    std::set<VoxelCoord> points;
    for (Index c = 0; c < stages.grid.size(); ++c) points.insert(stages.grid.coord(c));
    for (Index x = 0; x < stages.crossings.crossings.size(); ++x)
        for (const FacetSide side : corners_of_facet(x))
            count[middle_of_face(stages, side)] +=
                stages.links.of(side).open() ? 2 : 1; // a link has two ends
    std::erase_if(count, [&](const auto& face) {
        bool whole = true;
        for (int corner = 0; corner < 8; ++corner) { // along its own axis twice the same
            VoxelCoord at = face.first;
            for (unsigned k = 0; k < 3; ++k) at[k] = (at[k] + (at[k] % 2 != 0 && corner >> k & 1)) >> 1;
            whole = whole && points.contains(at);
        }
        return face.second <= 2 || !whole;
    });
    return count;
}

support::Solid plate() {
    return support::box({1, 1, 0.02}).placed(support::turned(Vec3(1, 2, 3), 0.4));
}

} // namespace

TEST_CASE("links round a face do not cross, whatever passes there", "[contour]") {
    CHECK(links_that_cross(Stages(support::mechanical_part(), 8000, 4)) == 0);
    CHECK(links_that_cross(Stages(plate(), 5000, 3)) == 0);
    for (std::uint64_t seed = 1; seed <= 3; ++seed)
        CHECK(links_that_cross(Stages(support::random_cloud(500, seed), 3)) == 0);
}

TEST_CASE("links go both ways across a grid face, from what leaves the solid to what enters it",
          "[contour]") {
    CHECK(link_fault(Stages(support::sphere(1), 5000, 3)) == "");
    CHECK(link_fault(Stages(support::mechanical_part(), 8000, 4)) == "");
    CHECK(link_fault(Stages(plate(), 5000, 3)) == "");
    CHECK(link_fault(Stages(support::flat_sheet(40, 0.8, 0.3), 3, 1)) == "");
    const Stages anyhow(support::random_cloud(500, 1), 3);
    CHECK(link_fault(anyhow) == "");
    CHECK(open_sides(anyhow.links) > 0);
    CHECK(rim_sides(anyhow.links) > 0);
}

TEST_CASE("a round surface is linked all round, without rims", "[contour]") {
    const Stages stages(support::torus(1, 0.4), 10000, 4);
    CHECK(open_sides(stages.links) == 0);
    CHECK(rim_sides(stages.links) == 0);
}

TEST_CASE("away from the rim each side of a plate is linked with itself", "[contour]") {
    const Stages stages(plate(), 8000, 4);
    const support::Pose pose = support::turned(Vec3(1, 2, 3), 0.4);
    std::size_t sides = 0, across = 0, doubled = 0;
    const auto& list = stages.crossings.crossings;
    for (Index x = 0; x < list.size(); ++x) {
        const Vec3 p =
            pose.to_local(crossing_position(stages.grid, list[x], stages.h()) + stages.octree.origin);
        if (std::max(std::abs(p[0]), std::abs(p[1])) > 0.5 - 2 * stages.h()) continue;
        doubled += stages.crossings.on_edge(list[x].edge).size() == 2;
        for (const Link& link : stages.links.of_crossing[x]) {
            ++sides;
            across += link.open() || (stages.crossings.of(link.twin).normal | list[x].normal) < 0.9;
        }
    }
    CHECK(sides > 200);
    CHECK(doubled > sides / 8); // most edges are crossed by both sides
    CHECK(across == 0);
    CHECK(open_sides(stages.links) == 0);
    CHECK(rim_sides(stages.links) > 0);
}

TEST_CASE("without one of its crossings a closed surface is open on that one's four sides", "[contour]") {
    Stages stages(support::sphere(1), 5000, 3);
    const Links before = stages.links;
    const Index lost = 30;
    std::vector<std::uint8_t> marked(stages.crossings.crossings.size(), 0);
    marked[lost] = 1;
    stages.crossings = support::without(stages.crossings, marked);
    stages.pair();
    CHECK(open_sides(stages.links) == 4);
    CHECK(link_fault(stages) == "");
    for (const Link& link : before.of_crossing[lost]) {
        const Index x = link.twin.crossing() - (link.twin.crossing() > lost);
        CHECK(stages.links.of({x, link.twin.j()}).open());
    }
}

TEST_CASE("faces with two links or more are listed, one end of each", "[contour]") {
    for (const bool is_plate : {true, false}) {
        const Stages stages = is_plate ? Stages(plate(), 5000, 3) : Stages(support::random_cloud(500, 1), 3);
        std::map<VoxelCoord, int> listed;
        std::set<VoxelCoord> done;
        std::optional<VoxelCoord> face;
        for (const FacetSide side : stages.links.crowded) {
            if (side == no_side) { // after each face's
                REQUIRE(face);
                CHECK(done.insert(*face).second);
                face.reset();
                continue;
            }
            const VoxelCoord at = middle_of_face(stages, side);
            CHECK(face.value_or(at) == at);
            face = at;
            listed[at] += 2;
        }
        CHECK(!face);
        CHECK(listed.size() > 20);
        CHECK(listed == crowded_faces(stages));
    }
    CHECK(Stages(support::sphere(1), 5000, 3).links.crowded.empty());
}

TEST_CASE("links do not depend on the number of threads", "[contour]") {
    const Stages many(support::mechanical_part(), 8000, 5);
    const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
    const Links single = pair_crossings(many.grid, many.crossings, many.sets, many.related);
    std::size_t differ = 0;
    for (Index x = 0; x < single.of_crossing.size(); ++x)
        for (const FacetSide side : corners_of_facet(x)) {
            const Link &a = many.links.of(side), &b = single.of(side);
            differ += a.twin != b.twin || a.rim != b.rim;
        }
    CHECK(differ == 0);
    CHECK(many.links.crowded == single.crowded);
}
