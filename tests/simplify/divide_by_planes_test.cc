#include "hsdm/simplify/divide_by_planes.hh"

#include <catch2/catch.hpp>

#include <cmath>

using namespace hsdm;

namespace {

using Adjacent = std::vector<std::pair<Index, Index>>;

struct PlaneAt {
    Vec3 normal, point;
};

Quadric planes(std::initializer_list<PlaneAt> all, const Vec3& at) {
    Quadric quadric;
    quadric.add_point(at);
    for (const PlaneAt& plane : all) quadric.add_plane(plane.normal, plane.point, 1);
    return quadric;
}

Box cell() {
    Box box;
    box.add(Vec3(-1, -1, -1));
    box.add(Vec3(1, 1, 1));
    return box;
}

} // namespace

TEST_CASE("a plate's rim makes two parts, each with its crease", "[simplify]") {
    const PlaneAt top{{0, 0, 1}, {0, 0, 0.1}}, bottom{{0, 0, -1}, {0, 0, -0.1}}, rim{{1, 0, 0}, {0.5, 0, 0}};
    const std::vector<Quadric> members = {planes({top}, {0, 0, 0.1}), planes({top, rim}, {0.5, 0, 0.1}),
                                          planes({rim}, {0.5, 0, 0}), planes({rim, bottom}, {0.5, 0, -0.1}),
                                          planes({bottom}, {0, 0, -0.1})};
    const Adjacent adjacent = {{0, 1}, {1, 2}, {2, 3}, {3, 4}};
    const std::vector<Index> parts = divide_by_planes(members, adjacent, cell(), 0.01);
    REQUIRE(parts.size() == 5);
    CHECK(parts[0] == 0);
    CHECK(parts[1] == 0);
    CHECK(parts[3] == parts[4]);
    CHECK(parts[3] != parts[0]);
    CHECK((parts[2] == parts[1] || parts[2] == parts[3]));

    CHECK(divide_by_planes(members, adjacent, cell(), 1) == std::vector<Index>{0, 0, 0, 0, 0});
}

TEST_CASE("what needs more than four parts is left to smaller cells", "[simplify]") {
    std::vector<Quadric> members;
    Adjacent adjacent;
    for (Index i = 0; i < 6; ++i) { // parallel planes, like steps
        const Vec3 at(0, 0, -0.6 + 0.2 * i);
        members.push_back(planes({{{0, 0, 1}, at}}, at));
        if (i > 0) adjacent.emplace_back(i - 1, i);
    }
    CHECK(divide_by_planes(members, adjacent, cell(), 0.01).empty());
    CHECK(divide_by_planes(std::span(members).first(4), std::span(adjacent).first(3), cell(), 0.01)
          == std::vector<Index>{0, 1, 2, 3});
    CHECK(divide_by_planes(members, adjacent, cell(), 0.5).size() == 6);
}

TEST_CASE("a place stays in its box", "[simplify]") {
    const Quadric far = planes({{{1, 0, 0}, {3, 0, 0}}}, {0.5, 0.2, 0.1});
    CHECK((place_in(far, cell()) - Vec3(1, 0.2, 0.1)).norm() < 1e-12);
}
