#include "hsdm/completion/slits.hh"
#include "hsdm/mesh/remove_facets.hh"
#include "hsdm/mesh/to_mesh.hh"
#include "hsdm/mesh/weld.hh"
#include "hsdm/reconstruct.hh"
#include "hsdm/spatial/self_intersections.hh"
#include "support/check.hh"
#include "support/meshes.hh"
#include "support/sample.hh"

#include <catch2/catch.hpp>

#include <cmath>
#include <utility>

using namespace hsdm;
using namespace hsdm::support;

namespace {

/// A flat sheet of columns x rows squares of edge 1, without those at which `gone(column, row)`.
template <class Gone>
PolygonMesh sheet_without(Index columns, Index rows, const Gone& gone) {
    PolygonMesh mesh = quad_sheet(columns, rows, [](Index c, Index r) { return Vec3(c, r, 0); });
    remove_facets(mesh, [&](std::size_t f) {
        return gone(static_cast<Index>(f % columns), static_cast<Index>(f / columns));
    });
    return mesh;
}

/// With one vertex at each place, and no facet that has it twice in a row.
PolygonMesh welded(const PolygonMesh& mesh) {
    const std::vector<Index> first = weld(mesh.positions);
    PolygonMesh result;
    result.positions = mesh.positions;
    for (std::size_t f = 0; f < mesh.facet_count(); ++f) {
        std::vector<Index> corners;
        for (Index v : mesh.facet(f))
            if (corners.empty() || (first[v] != corners.back() && first[v] != corners.front()))
                corners.push_back(first[v]);
        result.add_facet(corners);
    }
    return result;
}

BoundaryLoops slits_of(const PolygonMesh& mesh, double width) {
    return find_slits(mesh, boundary_loops(mesh), width).loops;
}

} // namespace

TEST_CASE("long and narrow loops are slits, windows and outlines are borders", "[completion]") {
    // Slits of one and of three squares, 24 long, a window of 8 by 8, a nick of 2 by 4.
    const auto inside = [](Index c, Index r, std::array<Index, 4> box) {
        return c >= box[0] && c < box[1] && r >= box[2] && r < box[3];
    };
    const PolygonMesh mesh = sheet_without(40, 40, [&](Index c, Index r) {
        return inside(c, r, {8, 32, 5, 6}) || inside(c, r, {8, 32, 12, 15}) || inside(c, r, {10, 18, 22, 30})
               || inside(c, r, {25, 27, 22, 26});
    });
    REQUIRE(boundary_loops(mesh).size() == 5);
    const BoundaryLoops slits = slits_of(mesh, 4);
    REQUIRE(slits.size() == 1);
    CHECK(slits[0].size() == 50);
    for (Index v : slits[0]) CHECK((mesh.positions[v][1] == 5 || mesh.positions[v][1] == 6));
    CHECK(slits_of(mesh, 6).size() == 2);
    CHECK(slits_of(mesh, 1.5).size() == 0);
}

TEST_CASE("the outline of a ribbon is no slit", "[completion]") {
    CHECK(slits_of(sheet_without(40, 1, [](Index, Index) { return false; }), 8).size() == 0);
}

TEST_CASE("the end of a narrow pipe is no slit, the open edge of a blade is one", "[completion]") {
    CHECK(slits_of(round_tube(24, 12, 1, 0.5), 8).size() == 0);
    // Two sides of 30 by 4, a unit apart at their open end and joined at the other three, as a bag is.
    PolygonMesh bag = quad_tube(60, 4, [](Index c, Index r) {
        const double side = c < 30 ? 0.5 : -0.5;
        const double along = c < 30 ? c : 59 - c;
        return Vec3(along, side * (r + 1) / 5, r);
    });
    std::vector<Index> bottom(60);
    for (Index c = 0; c < 60; ++c) bottom[c] = 59 - c;
    bag.add_facet(bottom);
    const BoundaryLoops slits = slits_of(bag, 4);
    REQUIRE(slits.size() == 1);
    for (Index v : slits[0]) CHECK(bag.positions[v][2] == 4);
}

TEST_CASE("a short gap in a lip is a slit, the end of a flat pipe as long is none", "[completion]") {
    // A bag, whose sides meet at the top but for eight units, where they are two apart; and a pipe of 8 by 2.
    const auto along = [](Index c) { return c < 30 ? c : 59 - c; };
    const auto is_open = [&](Index c) { return along(c) > 10 && along(c) < 20; };
    PolygonMesh bag = quad_tube(60, 4, [&](Index c, Index r) {
        const double side = r < 4 || is_open(c) ? 1 : 0;
        return Vec3(along(c), c < 30 ? side : -side, r);
    });
    bag = welded(bag);
    std::vector<Index> bottom(60);
    for (Index c = 0; c < 60; ++c) bottom[c] = 59 - c;
    bag.add_facet(bottom);
    const BoundaryLoops gaps = slits_of(bag, 7);
    REQUIRE(gaps.size() == 1);
    CHECK(gaps[0].size() == 20);
    const PolygonMesh pipe = quad_tube(20, 8, [](Index c, Index r) {
        const double x = c < 9 ? c : c < 11 ? 8 : c < 19 ? 18 - c : 0;
        const double across = c < 8 ? 0 : c < 10 ? c - 8 : c < 18 ? 2 : 20 - c;
        return Vec3(x, across, r);
    });
    REQUIRE(boundary_loops(pipe).size() == 2);
    CHECK(slits_of(pipe, 7).size() == 0);
}

TEST_CASE("a long slit along a round sheet is closed along its curve", "[completion]") {
    // Two thirds of the way round a tube of radius 20, 60 squares long and two wide: more than is solved
    // exactly.
    PolygonMesh tube = round_tube(90, 12, 20, 1.4);
    remove_facets(tube, [](std::size_t f) { return f / 90 >= 5 && f / 90 < 7 && f % 90 < 62; });
    const Slits slits = find_slits(tube, boundary_loops(tube), 7);
    REQUIRE(slits.loops.size() == 1);
    CHECK(slits.loops[0].size() == 128);
    PolygonMesh longer = round_tube(180, 12, 40, 1.4);
    remove_facets(longer, [](std::size_t f) { return f / 180 >= 5 && f / 180 < 7 && f % 180 < 120; });
    const Slits long_slits = find_slits(longer, boundary_loops(longer), 7);
    REQUIRE(long_slits.loops.size() == 1);
    for (const auto& [found, radius] : {std::pair{&slits, 20.0}, std::pair{&long_slits, 40.0}}) {
        const CompletedPoints points = points_across(*found, 1.4);
        for (std::size_t i = 0; i < points.positions.size(); ++i) {
            const Vec3 out(points.positions[i][0], points.positions[i][1], 0);
            CHECK(std::abs(out.norm() - radius) < 0.2);
            CHECK((points.normals[i] | out) > 0.95 * out.norm());
        }
    }
}

TEST_CASE("points across a slit lie in it, face as it does and fill it", "[completion]") {
    const PolygonMesh mesh = sheet_without(30, 9, [](Index c, Index r) { return r == 4 && c > 2 && c < 27; });
    const double voxel = 0.75;
    const CompletedPoints points = points_across(find_slits(mesh, boundary_loops(mesh), 4), voxel);
    REQUIRE(points.positions.size() == points.normals.size());
    std::vector<int> in_square(24 * 2);
    for (std::size_t i = 0; i < points.positions.size(); ++i) {
        const Vec3& p = points.positions[i];
        CHECK(p[2] == 0);
        CHECK(points.normals[i][2] == 1);
        REQUIRE((p[0] > 3 && p[0] < 27 && p[1] > 4 && p[1] < 5));
        ++in_square[2 * static_cast<std::size_t>(p[0] - 3) + (p[1] > 4.5 ? 1 : 0)];
    }
    // Nine to a voxel and more: eight to half a square.
    for (int count : in_square) CHECK(count >= 6);
    CHECK(points.positions.size() < 2 * 24 * 16);
}

namespace {

const VertexProperty* property(const PolygonMesh& mesh, const char* name) {
    const auto found = std::ranges::find(mesh.properties, name, &VertexProperty::name);
    return found == mesh.properties.end() ? nullptr : &*found;
}

/// A scan of a box with a slit of 1 by 0.14 in its top, and beside it, if asked for, a window of 0.32 by
/// 0.32.
struct BoxWithSlit {
    PointCloud cloud;
    Vec3 middle, up, x, y; ///< of the top; x along the slit, y across
};

BoxWithSlit box_with_slit(bool window) {
    const Solid part = in_general_pose(box({2, 1.6, 1.2}));
    const PointCloud all = sample(part, {.points = 60000});
    const Vec3 up = all.normals[0];
    Vec3 middle(0, 0, 0);
    double count = 0;
    for (std::size_t i = 0; i < all.positions.size(); ++i)
        if ((all.normals[i] | up) > 0.99) middle += all.positions[i], ++count;
    middle /= count;
    Vec3 x = up % Vec3(0, 0, 1);
    if (x.norm() < 0.1) x = up % Vec3(0, 1, 0);
    x.normalize();
    const Vec3 y = up % x;
    PointCloud cloud;
    for (std::size_t i = 0; i < all.positions.size(); ++i) {
        const Vec3 d = all.positions[i] - middle;
        const double u = d | x, v = d | y;
        const bool slit = std::abs(u) < 0.5 && std::abs(v - 0.2) < 0.07;
        const bool in_window = window && std::abs(u) < 0.16 && std::abs(v + 0.12) < 0.16;
        if ((all.normals[i] | up) > 0.99 && (slit || in_window)) continue;
        cloud.positions.push_back(all.positions[i]);
        cloud.normals.push_back(all.normals[i]);
    }
    return {std::move(cloud), middle, up, x, y};
}

} // namespace

TEST_CASE("a slit that the sampling left is closed and marked, a window stays open", "[completion][slow]") {
    const BoxWithSlit scan = box_with_slit(true);
    const Vec3 &middle = scan.middle, &up = scan.up, &x = scan.x, &y = scan.y;
    PointCloud cloud = scan.cloud;
    ReconstructOptions options;
    options.voxel_size = 0.05;
    const auto loops = [&](Holes holes) {
        options.holes = holes;
        const Reconstruction result = reconstruct(cloud, options);
        const PolygonMesh mesh = to_polygons(result.mesh);
        CHECK(faults(mesh).empty());
        CHECK(find_self_intersections(mesh).facet_pairs.empty());
        return result.report;
    };
    CHECK(loops(Holes::keep).mesh.boundary_loops == 2);
    const std::size_t sets = loops(Holes::keep).grid.sets;
    CHECK(sets > 0);
    CHECK(loops(Holes::complete).grid.sets == sets); // those of the points that were measured
    const Report report = loops(Holes::automatic);
    CHECK(report.grid.sets == sets);
    CHECK(report.mesh.boundary_loops == 1);
    CHECK(report.mesh.euler == 1);
    REQUIRE(report.loops.size() == 2);
    CHECK(report.loops[0].completed);
    CHECK_FALSE(report.loops[1].completed);
    CHECK(report.loops[1].length < 1.6);

    cloud.colors.assign(cloud.positions.size(), {40, 80, 120, 255});
    options.holes = Holes::automatic;
    options.confidence = true;
    const Reconstruction closed = reconstruct(cloud, options);
    const PolygonMesh mesh = to_polygons(closed.mesh);
    const VertexProperty *marks = property(mesh, "hsdm_completed"),
                         *confidence = property(mesh, "hsdm_confidence"), *red = property(mesh, "red");
    REQUIRE((marks && confidence && red));
    std::size_t marked = 0;
    for (std::size_t v = 0; v < mesh.vertex_count(); ++v) {
        const Vec3 d = mesh.positions[v] - middle;
        CHECK(red->values[v] == Approx(red->values[0]));
        if (marks->values[v] == 0) continue;
        ++marked;
        CHECK(std::abs(d | up) < 0.03);
        CHECK((std::abs(d | x) < 0.55 && std::abs((d | y) - 0.2) < 0.1));
        CHECK(confidence->values[v] < 0.7);
    }
    CHECK(marked >= 10);
    // What lies away from the slit is as it was without closing it.
    options.confidence = false;
    options.holes = Holes::keep;
    const PolygonMesh open = to_polygons(reconstruct(cloud, options).mesh);
    const auto far = [&](const Vec3& p) { return ((p - middle) | up) < -0.3; };
    std::vector<std::array<double, 3>> before, after;
    for (const Vec3& p : open.positions)
        if (far(p)) before.push_back({p[0], p[1], p[2]});
    for (const Vec3& p : mesh.positions)
        if (far(p)) after.push_back({p[0], p[1], p[2]});
    std::ranges::sort(before);
    std::ranges::sort(after);
    REQUIRE(before.size() == after.size());
    for (std::size_t i = 0; i < before.size(); ++i)
        for (unsigned k = 0; k < 3; ++k) CHECK(before[i][k] == Approx(after[i][k]).margin(1e-9));

    options.holes = Holes::automatic;
    options.voxel_size.reset();
    options.max_error = MaxError{.value = 0.01};
    const Report coarse = reconstruct(cloud, options).report;
    CHECK(coarse.mesh.boundary_loops == 1);
    CHECK(coarse.mesh.euler == 1);
    CHECK(coarse.mesh.faces < report.mesh.faces / 4);
}

TEST_CASE("where nothing but slits is open all is completed as slits are", "[completion]") {
    ReconstructOptions options;
    options.voxel_size = 0.05;
    const auto completed = [&](Holes holes) {
        options.holes = holes;
        Reconstruction result = reconstruct(box_with_slit(false).cloud, options);
        CHECK(result.report.mesh.closed);
        REQUIRE(result.report.loops.size() == 1);
        CHECK(result.report.loops[0].completed);
        return to_polygons(result.mesh);
    };
    const PolygonMesh slits = completed(Holes::automatic), all = completed(Holes::complete);
    CHECK(slits.positions == all.positions);
    CHECK(slits.corners == all.corners);
}
