#include "hsdm/mesh/manifold.hh"
#include "hsdm/mesh/small_components.hh"
#include "hsdm/mesh/turn_outward.hh"
#include "hsdm/quality/topology.hh"
#include "support/meshes.hh"

#include <catch2/catch.hpp>

#include <array>

using namespace hsdm;

namespace {

/// A strip of n quads, of unit length and the given width, beside the mesh.
void add_strip(PolygonMesh& mesh, Index n, double width = 1) {
    const auto base = static_cast<Index>(mesh.vertex_count());
    for (Index i = 0; i <= n; ++i)
        for (double y : {0.0, width}) mesh.positions.emplace_back(i, y, base);
    for (Index i = 0; i < n; ++i)
        mesh.add_facet(std::array{base + 2 * i, base + 2 * i + 2, base + 2 * i + 3, base + 2 * i + 1});
    if (mesh.properties.empty()) return;
    for (std::size_t v = base; v < mesh.vertex_count(); ++v) mesh.properties[0].values.push_back(n);
}

/// A closed box of six quads beside the mesh.
void add_box(PolygonMesh& mesh) {
    const auto base = static_cast<Index>(mesh.vertex_count());
    const PolygonMesh box = support::unit_cube();
    for (const Vec3& p : box.positions) mesh.positions.push_back(p + Vec3(0, 0, base));
    for (std::size_t f = 0; f < box.facet_count(); ++f) {
        const auto q = box.facet(f);
        mesh.add_facet(std::array{base + q[0], base + q[1], base + q[2], base + q[3]});
    }
}

/// Strips of 2, 100, 40 and 10 quads; the third has the largest area.
PolygonMesh strips() {
    PolygonMesh mesh;
    mesh.properties.push_back({"length", VertexProperty::Type::float64, {}});
    add_strip(mesh, 2, 1);
    add_strip(mesh, 100, 1);
    add_strip(mesh, 40, 4);
    add_strip(mesh, 10, 1);
    return mesh;
}

std::size_t components_left(const SmallComponentOptions& options) {
    PolygonMesh mesh = strips();
    FeatureHints hints;
    drop_small_components(mesh, hints, options);
    return measure_topology(mesh).components;
}

} // namespace

TEST_CASE("splinters beside a large surface are dropped, small parts are not", "[mesh]") {
    PolygonMesh mesh;
    add_strip(mesh, 32);
    add_strip(mesh, 1100);
    add_strip(mesh, 33);
    add_strip(mesh, 1);
    add_box(mesh);
    CHECK(drop_splinters(mesh, {.most_facets = 5, .most_open = 32, .least_ratio = 32}).count == 33);
    CHECK(mesh.facet_count() == 1139);
    CHECK(drop_splinters(mesh).count == 6);
    CHECK(drop_splinters(mesh).count == 0);
}

TEST_CASE("a few facets are no splinter where all components are small", "[mesh]") {
    PolygonMesh mesh;
    add_strip(mesh, 4);
    add_strip(mesh, 120);
    CHECK(drop_splinters(mesh).count == 0);
    CHECK(drop_splinters(mesh, {.most_facets = 12, .most_open = 32, .least_ratio = 25}).count == 4);
    PolygonMesh none;
    CHECK(drop_splinters(none).count == 0);
}

TEST_CASE("components with less area than points can tell of are splinters beside any", "[mesh]") {
    PolygonMesh mesh;
    add_strip(mesh, 4); // of area 4, or less
    add_strip(mesh, 120);
    CHECK(drop_splinters(mesh, {.least_area = 0.1}).count == 0);
    CHECK(drop_splinters(mesh, {.least_area = 5}).count == 4);
    CHECK(drop_splinters(mesh, {.least_area = 500}).count == 0); // nothing is larger
}

TEST_CASE("components smaller than asked for are dropped, the largest never", "[mesh]") {
    CHECK(components_left({.least_facets = 0}) == 4);
    CHECK(components_left({.least_facets = 2}) == 4);
    CHECK(components_left({.least_facets = 3}) == 3);
    CHECK(components_left({.least_facets = 41}) == 2); // the largest by area has 40 facets
    CHECK(components_left({.least_facets = 1e9}) == 1);
    CHECK(components_left({.least_share = 0}) == 4);
    CHECK(components_left({.least_share = 0.0126}) == 3);
    CHECK(components_left({.least_share = 0.07}) == 2);
    CHECK(components_left({.least_share = 1}) == 1);
}

TEST_CASE("of two components of one size, only the first is the largest", "[mesh]") {
    PolygonMesh mesh = strips();
    add_strip(mesh, 40, 4);
    FeatureHints hints;
    CHECK(drop_small_components(mesh, hints, {.least_share = 1}).components == 4);
    CHECK(mesh.facet_count() == 40);
}

TEST_CASE("hints go with their component, and its vertices with their properties if nothing has them",
          "[mesh]") {
    PolygonMesh mesh = strips();
    FeatureHints hints;
    for (std::size_t f = 0; f < mesh.facet_count(); ++f)
        hints.sides.insert(hints.sides.end(), 4, f < 102 ? EdgeHint::smooth : EdgeHint::sharp);
    const SmallComponents dropped = drop_small_components(mesh, hints, {.least_facets = 11});
    CHECK(dropped.components == 2);
    CHECK(dropped.facets.count == 12);
    CHECK(remove_isolated_vertices(mesh) == 28);
    CHECK(measure_topology(mesh).isolated_vertices == 0);
    REQUIRE(mesh.properties[0].values.size() == mesh.vertex_count());
    CHECK(mesh.properties[0].values.front() == 100);
    CHECK(mesh.properties[0].values.back() == 40);
    REQUIRE(hints.sides.size() == 4 * 140);
    CHECK(hints.sides[4 * 100 - 1] == EdgeHint::smooth);
    CHECK(hints.sides[4 * 100] == EdgeHint::sharp);
    PolygonMesh empty;
    CHECK(drop_small_components(empty, hints, {.least_facets = 5}).components == 0);
}

TEST_CASE("a small bubble that encloses nothing is a splinter, a thicker part and a larger plate are not",
          "[mesh]") {
    const auto left = [](Index n, double thickness) {
        PolygonMesh mesh = support::divided_cube(n);
        for (Vec3& p : mesh.positions) p *= n * 0.5, p[2] *= thickness / n;
        const std::size_t facets = mesh.facet_count();
        add_strip(mesh, 64 * 32);
        drop_splinters(mesh, {.flat = 0.33});
        CHECK((mesh.facet_count() == 64 * 32 || mesh.facet_count() == 64 * 32 + facets));
        return mesh.facet_count() > 64 * 32;
    };
    CHECK_FALSE(left(3, 0.05)); // three by three facets on each side
    CHECK(left(3, 0.5));
    CHECK(left(5, 0.05));
}

TEST_CASE("what is thinner than layers lie apart goes with them: cavities, and what is small beside them",
          "[mesh]") {
    struct Thin {
        double thickness = 0.5, width = 5; // in a cube of 20 by 20 by 20, or beside it
        bool inward = false;
        Vec3 at{0, 0, 0};
        bool all_turned = false;
    };
    const auto stays = [](const Thin& thin, double layers) {
        PolygonMesh mesh = support::divided_cube(6);
        for (Vec3& p : mesh.positions)
            p = thin.at + Vec3(p[0], p[1], p[2] * thin.thickness / thin.width) * (thin.width / 2);
        const std::size_t facets = mesh.facet_count();
        if (thin.inward) turn_over(mesh);
        PolygonMesh large = support::divided_cube(6);
        for (const Vec3& p : large.positions) mesh.positions.push_back(10 * p);
        const auto base = static_cast<Index>(mesh.vertex_count() - large.vertex_count());
        for (std::size_t f = 0; f < large.facet_count(); ++f) {
            const auto q = large.facet(f);
            mesh.add_facet(std::array{base + q[0], base + q[1], base + q[2], base + q[3]});
        }
        if (thin.all_turned) turn_over(mesh);
        const std::size_t before = mesh.facet_count();
        drop_splinters(mesh, {.flat = 0.1, .layers = layers});
        CHECK((mesh.facet_count() == before || mesh.facet_count() == before - facets));
        return mesh.facet_count() == before;
    };
    CHECK(stays({.inward = true}, 0)); // no layers
    for (const bool all_turned : {false, true}) {
        CHECK_FALSE(stays({.inward = true, .all_turned = all_turned}, 0.6));
        CHECK(stays({.thickness = 0.9, .inward = true, .all_turned = all_turned}, 0.6));
        CHECK_FALSE(stays({.all_turned = all_turned}, 0.6));
        CHECK(stays({.thickness = 0.9, .all_turned = all_turned}, 0.6));
        // Of more than a thirty-second of the cube's area.
        CHECK(stays({.width = 12, .all_turned = all_turned}, 0.6));
        CHECK_FALSE(stays({.width = 12, .inward = true, .all_turned = all_turned}, 0.6));
        // Beside the cube, not in it.
        CHECK(stays({.inward = true, .at = Vec3(25, 0, 0), .all_turned = all_turned}, 0.6));
    }
}

TEST_CASE("cavities go that a completion closed off: closed, small, and in the largest component", "[mesh]") {
    struct Inner {
        double width = 3; // in a cube of 20 by 20 by 20, or beside it
        bool inward = true;
        Vec3 at{0, 0, 0};
        bool is_open = false, is_cube_open = false, all_turned = false;
        double shear = 0; // of the cube, whose box is larger then
    };
    const auto stays = [](const Inner& inner) {
        PolygonMesh mesh;
        const auto add = [&](const PolygonMesh& part, double size, const Vec3& at, bool is_open) {
            const auto base = static_cast<Index>(mesh.vertex_count());
            for (const Vec3& p : part.positions) mesh.positions.push_back(at + p * size);
            for (std::size_t f = is_open; f < part.facet_count(); ++f) {
                std::vector<Index> facet;
                for (const Index v : part.facet(f)) facet.push_back(base + v);
                mesh.add_facet(facet);
            }
        };
        PolygonMesh part = support::divided_cube(4); // more facets than a splinter has
        if (inner.inward) turn_over(part);
        add(part, inner.width / 2, inner.at, inner.is_open);
        const std::size_t facets = mesh.facet_count();
        PolygonMesh cube = support::divided_cube(6);
        for (Vec3& p : cube.positions) p[0] += inner.shear * p[2];
        add(cube, 10, Vec3(0, 0, 0), inner.is_cube_open);
        if (inner.all_turned) turn_over(mesh);
        const std::size_t before = mesh.facet_count();
        CHECK(has_cavity(mesh) == (inner.inward && !inner.is_open));
        FeatureHints hints;
        for (std::size_t side = 0; side < mesh.corners.size(); ++side) // those of the cube are smooth
            hints.sides.push_back(side < mesh.first[facets] ? EdgeHint::sharp : EdgeHint::smooth);
        const std::size_t dropped = drop_cavities(mesh, hints).count;
        CHECK((dropped == 0 || dropped == facets));
        CHECK(mesh.facet_count() == before - dropped);
        CHECK(hints.sides.size() == mesh.corners.size());
        CHECK((std::ranges::count(hints.sides, EdgeHint::sharp) == 0) == (dropped > 0));
        return dropped == 0;
    };
    for (const bool all_turned : {false, true}) {
        CHECK_FALSE(stays({.all_turned = all_turned}));
        CHECK_FALSE(stays({.at = Vec3(7, 7, -7), .all_turned = all_turned}));
        CHECK(stays({.inward = false, .all_turned = all_turned}));
        CHECK(stays({.width = 5, .all_turned = all_turned})); // a sixteenth of the cube's area
        CHECK(stays({.at = Vec3(25, 0, 0), .all_turned = all_turned}));
        CHECK(stays({.is_open = true, .all_turned = all_turned}));
        CHECK(stays({.is_cube_open = true, .all_turned = all_turned}));
        CHECK_FALSE(stays({.at = Vec3(-12, 0, -7), .all_turned = all_turned, .shear = 1.5}));
        CHECK(stays({.at = Vec3(12, 0, -7), .all_turned = all_turned, .shear = 1.5}));
    }
}
