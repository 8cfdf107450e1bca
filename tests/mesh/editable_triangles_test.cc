#include "hsdm/mesh/editable_triangles.hh"
#include "support/random.hh"

#include <catch2/catch.hpp>

#include <algorithm>
#include <string>

using namespace hsdm;
using support::Random;

namespace {

constexpr Index around = 12, along = 10;

/// A torus of 12 * 10 quads, each cut in two.
EditableTriangles torus() {
    std::vector<Index> corners;
    for (Index i = 0; i < around; ++i)
        for (Index j = 0; j < along; ++j) {
            const auto at = [&](Index x, Index y) { return (i + x) % around * along + (j + y) % along; };
            for (Index v : {at(0, 0), at(1, 0), at(1, 1), at(0, 0), at(1, 1), at(0, 1)}) corners.push_back(v);
        }
    return {std::move(corners), {}, around * along};
}

/// Empty if the links are those of a closed 2-manifold of Euler characteristic 0 and the facets of each
/// vertex as many as are counted; otherwise what is wrong.
std::string fault_of_torus(const EditableTriangles& triangles) {
    std::vector<Index> count(triangles.vertex_count(), 0);
    int sides = 0, vertices = 0;
    std::vector<Index> ring;
    for (Index s = 0; s < triangles.side_count(); ++s) {
        if (triangles.is_gone(s)) continue;
        ++sides;
        ++count[triangles.start(s)];
        const Index t = triangles.twin(s);
        if (t == no_index || triangles.is_gone(t) || triangles.twin(t) != s
            || triangles.start(t) != triangles.end(s) || triangles.end(t) != triangles.start(s)
            || !triangles.ring_of(s, ring))
            return "side " + std::to_string(s) + " is not linked as in a closed surface";
    }
    for (Index v = 0; v < count.size(); ++v) {
        vertices += count[v] > 0;
        if (count[v] > 0 && triangles.facet_count(v) != count[v])
            return "vertex " + std::to_string(v) + " has miscounted facets";
    }
    const int euler = vertices - sides / 2 + sides / 3;
    return euler == 0 ? "" : "its Euler characteristic is " + std::to_string(euler);
}

/// The neighbours of a vertex, from one of its sides.
std::vector<Index> neighbours(const EditableTriangles& triangles, Index side) {
    std::vector<Index> ring;
    triangles.ring_of(side, ring);
    return ring;
}

bool has(const std::vector<Index>& ring, Index v) {
    return std::ranges::find(ring, v) != ring.end();
}

} // namespace

TEST_CASE("flips keep the links of a closed surface", "[mesh]") {
    EditableTriangles triangles = torus();
    REQUIRE(fault_of_torus(triangles) == "");
    Random random(3);
    int flips = 0;
    for (int i = 0; i < 3000; ++i) {
        const auto s = static_cast<Index>(random.below(triangles.side_count()));
        const Index c = triangles.opposite(s), d = triangles.opposite(triangles.twin(s));
        if (!triangles.spares(triangles.start(s)) || !triangles.spares(triangles.end(s)) || c == d
            || has(neighbours(triangles, previous_side(s)), d))
            continue;
        const Index bc = next_side(s), ad = next_side(triangles.twin(s));
        const Index from_bc = triangles.start(bc), from_ad = triangles.start(ad);
        triangles.flip_edge(s);
        ++flips;
        REQUIRE(triangles.start(previous_side(s)) == c);
        REQUIRE(triangles.end(previous_side(s)) == d);
        REQUIRE(triangles.start(bc) == from_bc);
        REQUIRE(triangles.start(ad) == from_ad);
    }
    CHECK(flips > 1000);
    CHECK(fault_of_torus(triangles) == "");
}

TEST_CASE("collapses take two triangles and a vertex each", "[mesh]") {
    EditableTriangles triangles = torus();
    Random random(4);
    int collapses = 0;
    std::vector<Index> common;
    for (int i = 0; i < 3000 && collapses < 80; ++i) {
        const auto s = static_cast<Index>(random.below(triangles.side_count()));
        if (triangles.is_gone(s)) continue;
        std::vector<Index> from = neighbours(triangles, s), to = neighbours(triangles, triangles.twin(s));
        std::ranges::sort(from);
        std::ranges::sort(to);
        common.clear();
        std::ranges::set_intersection(from, to, std::back_inserter(common));
        if (common.size() != 2 || !triangles.spares(common[0]) || !triangles.spares(common[1])) continue;
        const Index gone = triangles.start(s), kept = triangles.end(s);
        const Index beyond = triangles.twin(next_side(s));
        triangles.collapse_edge(s);
        ++collapses;
        REQUIRE(triangles.is_gone(s));
        REQUIRE(!triangles.is_gone(beyond));
        REQUIRE(has(neighbours(triangles, beyond), kept) != (triangles.start(beyond) == kept));
        REQUIRE(!has(neighbours(triangles, beyond), gone));
    }
    CHECK(collapses == 80);
    CHECK(fault_of_torus(triangles) == "");
}

TEST_CASE("two triangles can count as one facet, and a vertex keeps three", "[mesh]") {
    EditableTriangles triangles = torus(); // of six triangles at each vertex
    const Index v = triangles.start(0);
    Index s = 0;
    for (int joined = 0; joined < 3; ++joined) {
        REQUIRE(triangles.spares(v));
        triangles.count_as_one(s);
        s = triangles.twin(previous_side(s));
    }
    CHECK(triangles.facet_count(v) == 3);
    CHECK_FALSE(triangles.spares(v));
}
