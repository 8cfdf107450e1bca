#include "hsdm/mesh/turn_outward.hh"
#include "hsdm/quality/topology.hh"
#include "support/check.hh"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>

using namespace hsdm;

namespace {

/// A box of six quads about `at`, outward or not.
void add_box(PolygonMesh& mesh, const Vec3& at, double size, bool outward) {
    const auto base = static_cast<Index>(mesh.vertex_count());
    for (int i = 0; i < 8; ++i)
        mesh.positions.push_back(at + Vec3(i & 1, i >> 1 & 1, i >> 2) * size - Vec3(1, 1, 1) * (size / 2));
    constexpr Index faces[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4},
                                   {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
    for (const auto& f : faces) {
        std::array<Index, 4> ring{base + f[0], base + f[1], base + f[2], base + f[3]};
        if (!outward) std::reverse(ring.begin(), ring.end());
        mesh.add_facet(ring);
    }
}

double volume_of_box(const PolygonMesh& mesh, std::size_t box) {
    PolygonMesh one;
    one.positions = mesh.positions;
    for (std::size_t f = 6 * box; f < 6 * box + 6; ++f) one.add_facet(mesh.facet(f));
    return signed_volume(one);
}

std::size_t turned(PolygonMesh& mesh, FeatureHints hints = {}) {
    FacetLinks links = link_facets(mesh);
    return turn_outward(mesh, links, hints);
}

} // namespace

TEST_CASE("closed components face outward unless they are the wall of a cavity", "[mesh]") {
    const Vec3 far = GENERATE(Vec3(0, 0, 0), Vec3(1e5, -2e5, 7));
    PolygonMesh mesh;
    add_box(mesh, far, 1, true);                         // 0: as it should be
    add_box(mesh, far + Vec3(5, 0.1, -0.2), 1, false);   // 1: alone
    add_box(mesh, far + Vec3(0, 9, 0), 4, true);         // 2: with a cavity
    add_box(mesh, far + Vec3(0.1, 9.2, 0.3), 2, false);  // 3: which this is the wall of
    add_box(mesh, far + Vec3(0.2, 9.3, 0.35), 1, false); // 4: inside of that
    CHECK(turned(mesh) == 12);
    CHECK(volume_of_box(mesh, 0) == Approx(1));
    CHECK(volume_of_box(mesh, 1) == Approx(1));
    CHECK(volume_of_box(mesh, 2) == Approx(64));
    CHECK(volume_of_box(mesh, 3) == Approx(-8));
    CHECK(volume_of_box(mesh, 4) == Approx(1));
    CHECK(support::faults(mesh) == "");
    CHECK(turned(mesh) == 0);
}

TEST_CASE("a hollow body that is inside out turns as a whole", "[mesh]") {
    PolygonMesh mesh;
    add_box(mesh, Vec3(0, 0, 0), 8, false);   // 0: its outer wall
    add_box(mesh, Vec3(0.1, 0, 0), 6, true);  // 1: that of its cavity
    add_box(mesh, Vec3(0.2, 0, 0), 4, false); // 2: a body in there
    add_box(mesh, Vec3(20, 0, 0), 8, true);   // 3: another body, as it should be
    add_box(mesh, Vec3(20.1, 0, 0), 6, false);
    CHECK(turned(mesh) == 18);
    const double expected[] = {512, -216, 64, 512, -216};
    for (std::size_t i = 0; i < 5; ++i) CHECK(volume_of_box(mesh, i) == Approx(expected[i]));
}

TEST_CASE("many components in a row are looked at each for itself", "[mesh]") {
    PolygonMesh mesh;
    for (int i = 0; i < 3000; ++i) add_box(mesh, Vec3(i % 60 * 3, 0, i / 60 * 3), 1, i % 3 == 0);
    CHECK(turned(mesh) == 6 * 2000);
    CHECK(signed_volume(mesh) == Approx(3000));
}

TEST_CASE("rays that meet edges and corners are counted once", "[mesh]") {
    PolygonMesh mesh;
    add_box(mesh, Vec3(0, 0, 0), 4, true);
    add_box(mesh, Vec3(0, 0, 0), 2, false); // its first corner's ray runs along facets' diagonals
    add_box(mesh, Vec3(9, 0, 0), 2, false); // beside, at the same height
    CHECK(turned(mesh) == 6);
    CHECK(volume_of_box(mesh, 1) == Approx(-8));
    CHECK(volume_of_box(mesh, 2) == Approx(8));
}

TEST_CASE("what has a border is not turned", "[mesh]") {
    PolygonMesh mesh;
    add_box(mesh, Vec3(0, 0, 0), 1, false);
    mesh.corners.resize(mesh.corners.size() - 4);
    mesh.first.pop_back();
    CHECK(turned(mesh) == 0);
}

TEST_CASE("hints go with the sides of facets that turn", "[mesh]") {
    PolygonMesh mesh;
    add_box(mesh, Vec3(0, 0, 0), 1, false);
    FeatureHints hints;
    hints.sides.assign(mesh.corners.size(), EdgeHint::smooth);
    const auto sharp_sides = [&] { // by their vertices, in either order
        std::vector<std::pair<Index, Index>> result;
        for (std::size_t f = 0; f < mesh.facet_count(); ++f)
            for (std::size_t i = 0; i < 4; ++i)
                if (hints.sides[4 * f + i] == EdgeHint::sharp)
                    result.push_back(std::minmax(mesh.facet(f)[i], mesh.facet(f)[(i + 1) % 4]));
        std::sort(result.begin(), result.end());
        return result;
    };
    for (std::size_t i : {0u, 3u, 5u, 10u, 15u, 16u}) hints.sides[i] = EdgeHint::sharp;
    const auto before = sharp_sides();
    FacetLinks links = link_facets(mesh);
    CHECK(turn_outward(mesh, links, hints) == 6);
    CHECK(sharp_sides() == before);
    CHECK(signed_volume(mesh) == Approx(1));
    CHECK(links.twin == link_facets(mesh).twin);
}
