#include "hsdm/simplify/intersection_check.hh"
#include "hsdm/spatial/self_intersections.hh"
#include "support/random.hh"

#include <catch2/catch.hpp>

#include <algorithm>
#include <array>
#include <utility>

using namespace hsdm;
using support::Random;

namespace {

Vec3 place(Random& random) {
    return {random.uniform(), random.uniform(), random.uniform()};
}

/// Triangles and quads, most of them small, and some with a corner in common.
PolygonMesh soup(Random& random, Index count) {
    PolygonMesh mesh;
    for (Index i = 0; i < count; ++i) {
        const double size = i % 50 == 0 ? 0.4 : 0.04;
        const Vec3 middle = place(random);
        const Index v = static_cast<Index>(mesh.positions.size());
        for (int k = 0; k < 4; ++k) mesh.positions.push_back(middle + random.direction() * size);
        if (i % 4 == 1)
            mesh.add_facet(std::array{v, v + 1, v + 2, v + 3});
        else
            mesh.add_facet(std::array{i % 3 == 2 ? v - 3 : v, v + 1, v + 2});
    }
    return mesh;
}

/// The same mesh with a few vertices elsewhere, some triangles twice, and all in another order.
PolygonMesh changed(const PolygonMesh& mesh, Random& random) {
    PolygonMesh result;
    result.positions = mesh.positions;
    for (int i = 0; i < 5; ++i) result.positions[random.below(mesh.vertex_count())] = place(random);
    std::vector<std::size_t> order;
    for (std::size_t f = 0; f < mesh.facet_count(); ++f) order.push_back(f);
    order.push_back(random.below(mesh.facet_count()));
    for (std::size_t i = order.size(); i > 1; --i) std::swap(order[i - 1], order[random.below(i)]);
    for (std::size_t f : order) result.add_facet(mesh.facet(f));
    return result;
}

} // namespace

TEST_CASE("of meshes one after the other just those facets cross that cross in each", "[simplify]") {
    for (std::uint64_t seed = 1; seed <= 5; ++seed) {
        Random random(seed);
        PolygonMesh mesh = soup(random, 150);
        IntersectionCheck check;
        PolygonMesh before;
        for (int round = 0; round < 12; ++round) {
            INFO("seed " << seed << ", round " << round);
            const auto expected = find_self_intersections(mesh).facet_pairs;
            REQUIRE(!expected.empty());
            CHECK(check.find(mesh, find_unchanged(before, mesh)) == expected);
            before = std::exchange(mesh, changed(mesh, random));
        }
    }
}

TEST_CASE("a mesh that moves as a whole is looked at as a whole", "[simplify]") {
    Random random(7);
    PolygonMesh mesh = soup(random, 60);
    IntersectionCheck check;
    const std::size_t before = check.find(mesh, find_unchanged({}, mesh)).size();
    const PolygonMesh first = mesh;
    for (Vec3& p : mesh.positions) p = Vec3(p[0], p[1], 0.01 * p[2] * p[2]); // brings all close together
    const auto expected = find_self_intersections(mesh).facet_pairs;
    REQUIRE(expected.size() > before);
    CHECK(check.find(mesh, find_unchanged(first, mesh)) == expected);
    CHECK(check.find({}, find_unchanged(mesh, {})).empty());
}
