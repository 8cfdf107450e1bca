#include "hsdm/mesh/triangle_sides.hh"
#include "support/random.hh"

#include <catch2/catch.hpp>

#include <algorithm>
#include <array>

using namespace hsdm;

namespace {

/// Corners of the triangles of a torus of m * n quads, each cut in two.
std::vector<Index> torus_triangles(Index m, Index n) {
    std::vector<Index> corners;
    for (Index i = 0; i < m; ++i)
        for (Index j = 0; j < n; ++j) {
            const Index a = i * n + j, b = (i + 1) % m * n + j;
            const Index c = (i + 1) % m * n + (j + 1) % n, d = i * n + (j + 1) % n;
            for (Index v : {a, b, c, a, c, d}) corners.push_back(v);
        }
    return corners;
}

/// Twins are twins of each other and run along one edge, either way.
void check_twins(const std::vector<Index>& corners, const TriangleSides& sides) {
    REQUIRE(sides.twin.size() == corners.size());
    std::size_t wrong = 0;
    for (Index s = 0; s < corners.size(); ++s) {
        const Index t = sides.twin[s];
        if (t == no_index) continue;
        wrong +=
            sides.twin[t] != s || corners[s] != corners[next_side(t)] || corners[t] != corners[next_side(s)];
    }
    CHECK(wrong == 0);
}

std::size_t without_twin(const TriangleSides& sides) {
    return static_cast<std::size_t>(std::count(sides.twin.begin(), sides.twin.end(), no_index));
}

std::size_t at_border(const TriangleSides& sides) {
    return static_cast<std::size_t>(std::count(sides.border.begin(), sides.border.end(), 1));
}

} // namespace

TEST_CASE("the sides of a triangle follow each other round it", "[mesh]") {
    for (Index s = 0; s < 9; ++s) {
        CHECK(next_side(s) / 3 == s / 3);
        CHECK(next_side(s) != s);
        CHECK(previous_side(next_side(s)) == s);
        CHECK(next_side(next_side(next_side(s))) == s);
    }
}

TEST_CASE("every side of a closed surface has a twin", "[mesh]") {
    const std::vector<Index> corners = torus_triangles(50, 60); // several chunks of triangles
    const TriangleSides sides = link_triangles(corners, {}, 3000);
    check_twins(corners, sides);
    CHECK(without_twin(sides) == 0);
    CHECK(at_border(sides) == 0);
    CHECK_FALSE(sides.crowded);
}

TEST_CASE("sides at a border have no twin, and their ends are at the border", "[mesh]") {
    std::vector<Index> corners = torus_triangles(10, 10);
    corners.erase(corners.begin(), corners.begin() + 6); // the quad of 0, 10, 11 and 1
    const TriangleSides sides = link_triangles(corners, {}, 101);
    check_twins(corners, sides);
    CHECK(without_twin(sides) == 4);
    CHECK(at_border(sides) == 4);
    for (Index v : {0u, 1u, 10u, 11u}) CHECK(sides.border[v]);
    CHECK_FALSE(sides.border[100]); // without facets
    CHECK_FALSE(sides.crowded);
}

TEST_CASE("an edge of three sides, or of two that run the same way, has no twins", "[mesh]") {
    const std::vector<Index> three{0, 1, 2, 1, 0, 3, 0, 1, 4};
    TriangleSides sides = link_triangles(three, {}, 5);
    CHECK(sides.crowded);
    CHECK(without_twin(sides) == 9);
    CHECK(at_border(sides) == 5);
    const std::vector<Index> same_way{0, 1, 2, 0, 1, 3};
    sides = link_triangles(same_way, {}, 4);
    CHECK(sides.crowded);
    CHECK(without_twin(sides) == 6);
    const std::vector<Index> either_way{0, 1, 2, 1, 0, 3};
    sides = link_triangles(either_way, {}, 4);
    CHECK_FALSE(sides.crowded);
    CHECK(sides.twin[0] == 3);
    CHECK(sides.twin[3] == 0);
    CHECK(without_twin(sides) == 4);
}

TEST_CASE("a side shared with another facet has no twin and is at no border", "[mesh]") {
    // A tetrahedron whose last triangle is another facet.
    const std::vector<Index> three{0, 2, 1, 0, 1, 3, 1, 2, 3};
    PolygonMesh lid;
    lid.add_facet(std::array<Index, 3>{2, 0, 3});
    TriangleSides sides = link_triangles(three, lid, 4);
    check_twins(three, sides);
    CHECK(without_twin(sides) == 3);
    CHECK(at_border(sides) == 0);
    CHECK_FALSE(sides.crowded);
    CHECK(at_border(link_triangles(three, {}, 4)) == 3);
    lid.add_facet(std::array<Index, 4>{1, 0, 5, 4}); // along a side that two triangles share
    sides = link_triangles(three, lid, 6);
    check_twins(three, sides);
    CHECK(sides.crowded);
    CHECK(without_twin(sides) == 5);
    CHECK(at_border(sides) == 4); // the quad's other sides
}

TEST_CASE("other facets that share a side with each other alone concern no triangle", "[mesh]") {
    const std::vector<Index> corners{1, 0, 4};
    PolygonMesh others;
    others.add_facet(std::array<Index, 4>{0, 1, 2, 3});
    others.add_facet(std::array<Index, 3>{0, 3, 5});
    const TriangleSides sides = link_triangles(corners, others, 6);
    CHECK(sides.twin == std::vector<Index>(3, no_index));
    CHECK_FALSE(sides.crowded);
}

TEST_CASE("twins do not depend on the order of the triangles", "[mesh]") {
    const std::vector<Index> corners = torus_triangles(12, 9);
    support::Random random(1);
    std::vector<Index> order(corners.size() / 3), mixed;
    for (Index t = 0; t < order.size(); ++t) order[t] = t;
    for (std::size_t i = order.size(); i > 1; --i) std::swap(order[i - 1], order[random.below(i)]);
    for (Index t : order)
        for (Index k = 0; k < 3; ++k) mixed.push_back(corners[3 * t + k]);
    const TriangleSides before = link_triangles(corners, {}, 108), after = link_triangles(mixed, {}, 108);
    std::size_t wrong = 0;
    for (Index s = 0; s < mixed.size(); ++s) {
        const Index t = after.twin[s], was = 3 * order[s / 3] + s % 3;
        wrong += t == no_index || before.twin[was] != 3 * order[t / 3] + t % 3;
    }
    CHECK(wrong == 0);
}
