#include "hsdm/simplify/remove_flat_vertices.hh"

#include "hsdm/mesh/area_vector.hh"
#include "hsdm/quality/topology.hh"
#include "hsdm/spatial/self_intersections.hh"
#include "support/check.hh"
#include "support/meshes.hh"

#include <catch2/catch.hpp>

#include <cmath>
#include <numbers>

using namespace hsdm;

namespace {

using Outline = std::vector<std::array<double, 2>>;

/// A prism over a polygon, whose top and bottom are fans of triangles: from a vertex amid them or, if `from`
/// is the place of one of the outline's own, from that.
PolygonMesh prism(const Outline& outline, Index from) {
    PolygonMesh mesh;
    const auto n = static_cast<Index>(outline.size());
    for (const double z : {1.0, 0.0})
        for (const auto& [x, y] : outline) mesh.positions.emplace_back(x, y, z);
    const bool amid = from >= n;
    for (const double z : {1.0, 0.0})
        if (amid) mesh.positions.emplace_back(0, 0, z);
    for (Index i = 0; i < n; ++i) {
        const Index next = (i + 1) % n;
        mesh.add_facet(std::array{next, i, n + i, n + next});
        if (!amid && (i == from || next == from)) continue;
        mesh.add_facet(std::array{amid ? 2 * n : from, i, next});
        mesh.add_facet(std::array{n + next, n + i, amid ? 2 * n + 1 : n + from});
    }
    return mesh;
}

/// No point of it sees all of it, but the middle does.
Outline star(int points) {
    Outline outline;
    for (int i = 0; i < 2 * points; ++i) {
        const double angle = std::numbers::pi * i / points, radius = i % 2 == 0 ? 3 : 1;
        outline.push_back({radius * std::cos(angle), radius * std::sin(angle)});
    }
    return outline;
}

/// The second vertex, in the middle of a side `bend` off the straight line, sees all; its neighbours do not.
Outline bottle(double bend) {
    return {{0, 0}, {2, -bend}, {4, 0}, {4, 1}, {2.6, 1}, {3, 3}, {1, 3}, {1.4, 1}, {0, 1}};
}

std::size_t straightened(PolygonMesh& mesh, double reach) {
    CollapsingMesh collapsing(mesh);
    const std::size_t removed =
        remove_flat_vertices(collapsing, std::vector<double>(mesh.vertex_count(), reach));
    CollapsedMesh result = collapsing.write();
    std::size_t gone = 0;
    for (Index v = 0; v < result.stands_for.size(); ++v) gone += result.stands_for[v] != v;
    CHECK(gone == removed);
    mesh = std::move(result.mesh);
    return removed;
}

void check_sound(const PolygonMesh& mesh, double volume) {
    CHECK(measure_topology(mesh).euler == 2);
    CHECK(signed_volume(mesh) == Approx(volume).epsilon(1e-12));
    CHECK(find_self_intersections(mesh).triangle_pairs == 0);
}

} // namespace

TEST_CASE("a vertex amid a star goes, though none of its neighbours sees all others", "[simplify]") {
    for (const int points : {3, 4, 5, 8}) {
        INFO(points << " points");
        PolygonMesh mesh = prism(star(points), no_index);
        const double volume = signed_volume(mesh);
        CHECK(straightened(mesh, 1e-6) == 2); // of top and bottom
        check_sound(mesh, volume);
    }
}

TEST_CASE("a vertex of a straight crease goes, whatever its neighbours see", "[simplify]") {
    PolygonMesh mesh = prism(bottle(0), 1);
    const double volume = signed_volume(mesh);
    CHECK(straightened(mesh, 1e-6) == 2);
    check_sound(mesh, volume);
    for (std::size_t f = 0; f < mesh.facet_count(); ++f)
        for (Index v : mesh.facet(f)) CHECK(v % 9 != 1);
}

TEST_CASE("what bends, has no reach or is a corner stays", "[simplify]") {
    PolygonMesh bent = prism(bottle(0.2), 1);
    CHECK(straightened(bent, 0.01) == 0);
    PolygonMesh slightly = prism(bottle(0.005), 1); // less than what counts as an edge there
    CHECK(straightened(slightly, 0.001) == 0);
    CHECK(straightened(slightly, 0.01) == 2);
    PolygonMesh unreached = prism(bottle(0), 1);
    const PolygonMesh before = unreached;
    CHECK(straightened(unreached, 0) == 0);
    CHECK(unreached.corners == before.corners);
}

TEST_CASE("an edge is laid between the vertices opposite if there is none yet", "[simplify]") {
    const PolygonMesh mesh = prism(star(4), no_index);
    CollapsingMesh flipped(mesh);
    std::size_t flips = 0, back = 0;
    for (Index s = 0; s < flipped.side_count(); ++s) {
        const Index a = flipped.start(s), b = flipped.end(s);
        const Index c = flipped.start(previous_side(s)), t = flipped.twin(s);
        const Index d = flipped.start(previous_side(t));
        if (!flipped.flip(s)) continue;
        ++flips;
        const Index laid = previous_side(s); // from c to d
        REQUIRE(flipped.start(laid) == c);
        REQUIRE(flipped.end(laid) == d);
        REQUIRE(flipped.flip(laid));
        std::vector<Index> ring;
        REQUIRE(flipped.ring_of(flipped.sides_out()[a], ring));
        back += std::find(ring.begin(), ring.end(), b) != ring.end();
    }
    CHECK(flips > 20);
    CHECK(back == flips);
    check_sound(flipped.write().mesh, signed_volume(mesh));

    const PolygonMesh tetrahedron = support::tetrahedron();
    CollapsingMesh whole(tetrahedron);
    for (Index s = 0; s < whole.side_count(); ++s) CHECK_FALSE(whole.flip(s));
}

TEST_CASE("where a vertex has passed another the surface is unfolded by edges", "[simplify]") {
    PolygonMesh mesh; // a box, with two vertices amid its top
    for (const double z : {1.0, 0.0})
        for (const auto& [x, y] : Outline{{0, 0}, {4, 0}, {4, 4}, {0, 4}})
            mesh.positions.emplace_back(x, y, z);
    mesh.positions.emplace_back(3.5, 2, 1); // was left of the other
    mesh.positions.emplace_back(3, 2, 1);
    for (const std::array<Index, 3>& facet :
         {std::array<Index, 3>{0, 1, 8}, {1, 9, 8}, {1, 2, 9}, {2, 3, 9}, {3, 8, 9}, {3, 0, 8}})
        mesh.add_facet(facet);
    for (Index i = 0; i < 4; ++i) mesh.add_facet(std::array{(i + 1) % 4, i, 4 + i, 4 + (i + 1) % 4});
    mesh.add_facet(std::array<Index, 4>{7, 6, 5, 4});
    const auto faces_down = [&](const PolygonMesh& m) {
        std::size_t count = 0;
        for (std::size_t f = 0; f < m.facet_count(); ++f) {
            const bool on_top = m.positions[m.facet(f)[0]][2] + m.positions[m.facet(f)[1]][2] == 2;
            count += on_top && area_vector(m, m.facet(f))[2] < 0;
        }
        return count;
    };
    CHECK(faces_down(mesh) == 2);
    CollapsingMesh folded(mesh);
    const std::array<Vec3, 1> up{Vec3(0, 0, 1)};
    std::size_t flips = 0;
    for (Index s = 0; s < folded.side_count(); ++s) flips += folded.unfold(s, up);
    CHECK(flips == 2);
    const PolygonMesh unfolded = folded.write().mesh;
    CHECK(faces_down(unfolded) == 0);
    check_sound(unfolded, 16);
}

TEST_CASE("what cannot go leaves edges as they were, at borders too", "[simplify]") {
    // A sheet whose vertices but one are at the border or may not give way.
    PolygonMesh mesh;
    mesh.positions = {{0, 0, 0}, {4, 0, 0}, {4.5, 2, 0}, {4, 4, 0}, {0, 4, 0}, {-0.5, 2, 0}, {2, 2, 0}};
    for (Index i = 0; i < 6; ++i) mesh.add_facet(std::array<Index, 3>{6, i, (i + 1) % 6});
    for (const bool all : {false, true}) {
        std::vector<double> reach(7, all ? 0.01 : 0.0);
        reach[6] = 0.01;
        CollapsingMesh sheet(mesh);
        CHECK(remove_flat_vertices(sheet, reach) == 0);
        const CollapsedMesh result = sheet.write();
        CHECK(result.mesh.corners == mesh.corners);
        for (Index v = 0; v < 7; ++v) CHECK(result.stands_for[v] == v);
    }
    // Amid a star, with points that nothing may merge into: onto one of the others.
    const PolygonMesh closed = prism(star(4), no_index);
    std::vector<double> reach(closed.vertex_count(), 0.0);
    reach[16] = reach[17] = reach[1] = 0.01;
    CollapsingMesh half(closed);
    remove_flat_vertices(half, reach);
    const CollapsedMesh result = half.write();
    for (Index v = 0; v < closed.vertex_count(); ++v)
        if (result.stands_for[v] != v) CHECK(reach[result.stands_for[v]] > 0);
    check_sound(result.mesh, signed_volume(closed));
}
