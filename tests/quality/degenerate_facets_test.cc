#include "hsdm/quality/degenerate_facets.hh"
#include "hsdm/quality/topology.hh"
#include "support/meshes.hh"

#include <catch2/catch.hpp>

#include <cmath>

using namespace hsdm;

namespace {

/// A square of two triangles and a pillow over four vertices of its own.
PolygonMesh square_and_pillow() {
    PolygonMesh mesh;
    for (double x : {0.0, 5.0})
        for (const Vec3& p : {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(1, 1, 0), Vec3(0, 1, 0.1)})
            mesh.positions.push_back(p + Vec3(x, 0, 0));
    mesh.add_facet(std::array<Index, 3>{0, 1, 2});
    mesh.add_facet(std::array<Index, 3>{0, 2, 3});
    mesh.add_facet(std::array<Index, 4>{4, 5, 6, 7});
    mesh.add_facet(std::array<Index, 4>{7, 6, 5, 4});
    return mesh;
}

Occurrences dropped(PolygonMesh& mesh, const Vec3& origin = {0, 0, 0}) {
    FacetLinks links = link_facets(mesh);
    FeatureHints hints;
    const Occurrences result = drop_degenerate_facets(mesh, origin, {}, links, hints);
    CHECK(links.twin == link_facets(mesh).twin);
    return result;
}

} // namespace

TEST_CASE("both facets of a pillow go", "[quality]") {
    PolygonMesh mesh = square_and_pillow();
    const Occurrences pillow = dropped(mesh);
    CHECK(pillow.count == 2);
    CHECK(pillow.first[0] == 5);
    CHECK(mesh.facet_count() == 2);
    CHECK(dropped(mesh).count == 0);
}

TEST_CASE("a closed surface of three facets goes, one of four stays", "[quality]") {
    PolygonMesh flat;
    flat.positions = {Vec3(0, 0, 0), Vec3(3, 0, 0), Vec3(0, 3, 0), Vec3(1, 1, 0)};
    flat.add_facet(std::array<Index, 4>{0, 2, 1, 3}); // its back
    flat.add_facet(std::array<Index, 3>{1, 2, 3});
    flat.add_facet(std::array<Index, 3>{3, 2, 0});
    REQUIRE(measure_connectivity(flat).closed());
    CHECK(dropped(flat).count == 3);
    PolygonMesh tetrahedron = support::tetrahedron();
    CHECK(dropped(tetrahedron).count == 0);
}

TEST_CASE("facets that rounding leaves without area where they will stand go", "[quality]") {
    PolygonMesh mesh = square_and_pillow();
    CHECK(dropped(mesh, Vec3(1e17, 1e17, 0)).count == 4);
    mesh = square_and_pillow();
    mesh.positions[2] = Vec3(0.5, 1e-14, 0); // the first triangle is a needle
    CHECK(dropped(mesh).count == 3);
}

TEST_CASE("hints of facets that stay stay theirs", "[quality]") {
    PolygonMesh mesh = square_and_pillow();
    mesh.positions[1] = Vec3(0.5, 0.5, 0); // on the diagonal: the first triangle goes
    FeatureHints hints;
    for (std::size_t i = 0; i < mesh.corners.size(); ++i)
        hints.sides.push_back(i == 4 ? EdgeHint::sharp : EdgeHint::smooth);
    FacetLinks links = link_facets(mesh);
    CHECK(drop_degenerate_facets(mesh, Vec3(0, 0, 0), {}, links, hints).count == 3);
    CHECK(hints.sides == std::vector<EdgeHint>{EdgeHint::smooth, EdgeHint::sharp, EdgeHint::smooth});
}

TEST_CASE("whether a polygon has area does not depend on its scale", "[quality]") {
    const double needle = GENERATE(0.9e-12, 1e-11, 1.0);
    std::vector<Vec3> ring{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0.5, 2 * needle, 0)};
    CHECK(has_no_area(ring) == (needle < 1e-12));
    for (int exponent : {-1000, -600, 600, 1000}) {
        std::vector<Vec3> other = ring;
        for (Vec3& p : other) p *= std::ldexp(1.0, exponent);
        CHECK(has_no_area(other) == has_no_area(ring));
    }
    CHECK(has_no_area(std::vector<Vec3>(4, Vec3(1, 2, 3))));
}
