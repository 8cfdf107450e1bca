#include "hsdm/contour/odd_facets.hh"

#include "hsdm/core/chunks.hh"
#include "hsdm/mesh/area_vector.hh"
#include "hsdm/quality/topology.hh"

#include "support/random.hh"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <set>

using namespace hsdm;
using support::Random;

namespace {

using Facet = std::vector<Index>;

/// n x n quads over [0, n]^2, vertex (x, y) has the number (n + 1) y + x, but for those whose number is
/// listed; `instead` takes their place.
PolygonMesh grid(int n, const std::set<int>& but, const std::vector<Facet>& instead = {}) {
    PolygonMesh mesh;
    for (int y = 0; y <= n; ++y)
        for (int x = 0; x <= n; ++x) mesh.positions.emplace_back(x, y, 0);
    const auto at = [&](int x, int y) { return static_cast<Index>((n + 1) * y + x); };
    for (int y = 0; y < n; ++y)
        for (int x = 0; x < n; ++x)
            if (!but.contains(n * y + x))
                mesh.add_facet(Facet{at(x, y), at(x + 1, y), at(x + 1, y + 1), at(x, y + 1)});
    for (const Facet& facet : instead) mesh.add_facet(facet);
    mesh.origin = indices_below(mesh.vertex_count());
    return mesh;
}

std::size_t recut(PolygonMesh& mesh, VertexClass all = VertexClass::smooth) {
    return recut_odd_facets(0.1, std::vector<VertexClass>(mesh.vertex_count(), all), mesh);
}

double area(const PolygonMesh& mesh) {
    double sum = 0;
    for (std::size_t f = 0; f < mesh.facet_count(); ++f) sum += area_vector(mesh, mesh.facet(f)).norm() / 2;
    return sum;
}

/// A disc of the whole square, all of it quads.
void check_quads(const PolygonMesh& mesh, std::size_t quads) {
    const Topology t = measure_topology(mesh);
    CHECK(t.quads == quads);
    CHECK(t.faces == quads);
    CHECK(t.manifold());
    CHECK(t.misoriented_edges == 0);
    CHECK(t.boundary_loops == 1);
    CHECK(t.euler == 1);
}

void turn(PolygonMesh& mesh) {
    for (std::size_t f = 0; f < mesh.facet_count(); ++f)
        std::reverse(mesh.corners.begin() + mesh.first[f] + 1, mesh.corners.begin() + mesh.first[f + 1]);
}

// In a grid of 3 x 3 the middle quad.
const std::vector<Facet> cut_in_two{{5, 6, 9}, {6, 10, 9}};

} // namespace

TEST_CASE("two triangles on flat ground become a quad") {
    PolygonMesh mesh = grid(3, {4}, cut_in_two);
    CHECK(recut(mesh) == 2);
    check_quads(mesh, 9);
    CHECK(recut(mesh) == 0);
}

TEST_CASE("two triangles beside one quad become two quads with it") {
    PolygonMesh mesh = grid(4, {5, 6}, {{6, 7, 11}, {7, 8, 12, 11}, {8, 13, 12}});
    CHECK(recut(mesh) == 3);
    check_quads(mesh, 16);
    CHECK(area(mesh) == Approx(16));
}

TEST_CASE(
    "a triangle and what has five corners become two quads, two of five corners three, one of six two") {
    PolygonMesh mesh = grid(4, {5, 6}, {{6, 7, 8, 13, 11}, {13, 12, 11}});
    mesh.positions[12] += Vec3(0, 0.1, 0); // else the triangle is flat
    CHECK(recut(mesh) == 2);
    check_quads(mesh, 16);
    PolygonMesh fives = grid(4, {5, 6, 7}, {{6, 7, 8, 12, 11}, {8, 9, 14, 13, 12}});
    CHECK(recut(fives) == 2);
    check_quads(fives, 16);
    PolygonMesh six = grid(3, {4, 5}, {{5, 6, 7, 11, 10, 9}});
    CHECK(recut(six) == 1);
    check_quads(six, 9);
}

TEST_CASE("triangles stay where the ground folds, is bent, or where there would be a corner inward") {
    const auto stays = [](PolygonMesh mesh, VertexClass all = VertexClass::smooth) {
        const std::vector<Index> corners = mesh.corners;
        CHECK(recut(mesh, all) == 0);
        CHECK(mesh.corners == corners);
    };
    PolygonMesh fold = grid(3, {4}, cut_in_two);
    fold.positions[10] += Vec3(0, 0, 0.5);
    stays(fold);
    PolygonMesh blunt = grid(3, {4}, cut_in_two); // 16 degrees
    blunt.positions[10] += Vec3(0, 0, 0.2);
    stays(blunt, VertexClass::edge);
    CHECK(recut(blunt) == 2);
    PolygonMesh large = grid(3, {4}, cut_in_two); // as blunt, but off by more than the tolerance
    for (Vec3& p : large.positions) p *= 4;
    large.positions[10] += Vec3(0, 0, 0.8);
    stays(large);
    PolygonMesh inward = grid(3, {4}, cut_in_two);
    inward.positions[10] = Vec3(1.45, 1.45, 0);
    stays(inward);
}

TEST_CASE("no vertex loses its third facet, and no facet has an edge or a diagonal of a new quad") {
    const auto stays = [](PolygonMesh mesh) {
        mesh.origin = indices_below(mesh.vertex_count());
        const std::vector<Index> corners = mesh.corners;
        CHECK(recut(mesh) == 0);
        CHECK(mesh.corners == corners);
    };
    PolygonMesh three = grid(3, {4}, {{5, 6, 16}, {6, 10, 16}, {10, 9, 5, 16}});
    three.positions.emplace_back(1.4, 1.3, 0);
    stays(three);
    for (const Facet& beside : {Facet{5, 16, 10, 17}, Facet{5, 16, 10}, Facet{6, 16, 9, 17}}) {
        PolygonMesh mesh = grid(3, {4}, cut_in_two); // quad 5 6 10 9
        mesh.positions.emplace_back(2, 1, 1);
        mesh.positions.emplace_back(1, 2, 1);
        mesh.add_facet(beside);
        stays(mesh);
    }
}

TEST_CASE("new sides do not bend as creases do") {
    const auto bent = [](double slope) { // along 2 7 12 17
        PolygonMesh mesh = grid(4, {5, 6}, {{6, 7, 8, 13, 12, 11}});
        for (Vec3& p : mesh.positions) p[2] = slope * std::abs(p[0] - 2);
        return mesh;
    };
    const auto recut_at_any_height = [](PolygonMesh mesh) {
        return recut_odd_facets(10, std::vector<VertexClass>(mesh.vertex_count(), VertexClass::smooth), mesh);
    };
    CHECK(recut_at_any_height(bent(0.16)) == 1); // 18 degrees
    CHECK(recut_at_any_height(bent(0.4)) == 0);
}

TEST_CASE("recut ground stays one disc of the same area, whichever way it faces and whatever was cut") {
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
        CAPTURE(seed);
        Random random(seed);
        constexpr int n = 12;
        PolygonMesh mesh = grid(n, {});
        for (Vec3& p : mesh.positions) // the border stays
            if (std::min({p[0], p[1], n - p[0], n - p[1]}) > 0)
                p += Vec3(random.uniform(-0.2, 0.2), random.uniform(-0.2, 0.2), random.uniform(-0.02, 0.02));
        PolygonMesh cut;
        cut.positions = mesh.positions;
        cut.origin = indices_below(cut.vertex_count());
        for (std::size_t f = 0; f < mesh.facet_count(); ++f) {
            const auto q = mesh.facet(f);
            const double dice = random.uniform(0, 1);
            if (dice < 0.4) {
                const std::size_t d = dice < 0.2 ? 0 : 1;
                cut.add_facet(Facet{q[d], q[d + 1], q[d + 2]});
                cut.add_facet(Facet{q[d], q[d + 2], q[(d + 3) % 4]});
            } else {
                cut.add_facet(q);
            }
        }
        for (Index& origin : cut.origin) origin = static_cast<Index>(cut.vertex_count() - 1 - origin);
        PolygonMesh turned = cut;
        turn(turned);
        const double before = area(cut);
        const Topology odd = measure_topology(cut);
        CHECK(recut(cut) > 0);
        const Topology t = measure_topology(cut);
        CHECK(t.manifold());
        CHECK(t.misoriented_edges == 0);
        CHECK(t.euler == 1);
        CHECK(t.vertices == odd.vertices);
        CHECK(t.triangles < odd.triangles / 2);
        CHECK(area(cut) == Approx(before).epsilon(0.01));
        for (std::size_t f = 0; f < cut.facet_count(); ++f) CHECK(area_vector(cut, cut.facet(f))[2] > 0);
        recut(turned);
        turn(turned);
        CHECK(turned.corners == cut.corners);
    }
}
