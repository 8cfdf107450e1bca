#include "features/meshes.hh"
#include "hsdm/errors.hh"
#include "hsdm/features/FeatureClassifierT.hh"
#include "hsdm/features/FeatureSubdividerT.hh"
#include "hsdm/features/features.hh"
#include "hsdm/mesh/check_links.hh"
#include "hsdm/mesh/to_mesh.hh"
#include "hsdm/quality/topology.hh"
#include "support/check.hh"

#include <OpenMesh/Tools/Utils/MeshCheckerT.hh>
#include <catch2/catch.hpp>
#include <tbb/global_control.h>

#include <numbers>
#include <sstream>

using namespace hsdm;
using namespace hsdm::test;
using OpenMesh::EdgeHandle;
using OpenMesh::FaceHandle;
using OpenMesh::VertexHandle;

namespace {

template <class Mesh>
SubdivisionCounts divide(Mesh& mesh, const SubdivisionOptions& options = {}) {
    FeatureSubdividerT<Mesh> subdivider(mesh);
    subdivider.initialize(options);
    const SubdivisionCounts counts = subdivider.divide();
    std::ostringstream faults;
    CHECK(OpenMesh::Utils::MeshCheckerT<Mesh>(mesh).check(OpenMesh::Utils::MeshCheckerT<Mesh>::CHECK_ALL,
                                                          faults));
    INFO(faults.str());
    CHECK(counts.facets_after == mesh.n_faces());
    CHECK(counts.vertices == mesh.n_vertices());
    return counts;
}

template <class Mesh>
void mark_features(Mesh& mesh) {
    FeatureClassifierT<Mesh> classifier(mesh);
    classifier.initialize();
    classifier.classify();
}

template <class Mesh>
PolygonMesh polygons_of(const Mesh& mesh) {
    PolygonMesh polygons;
    for (const auto v : mesh.vertices()) polygons.positions.push_back(to_vec3(mesh.point(v)));
    std::vector<Index> corners;
    for (const auto f : mesh.faces()) {
        corners.clear();
        for (const auto v : f.vertices()) corners.push_back(static_cast<Index>(v.idx()));
        polygons.add_facet(corners);
    }
    return polygons;
}

template <class Mesh>
double marked_length_of(const Mesh& mesh) {
    double length = 0;
    for (const auto e : mesh.edges())
        if (mesh.status(e).feature()) length += static_cast<double>(mesh.calc_edge_length(e));
    return length;
}

double radius_of(const Vec3& p) {
    return std::hypot(p[0], p[1]);
}

void mark_edge(PolyMeshD& mesh, int a, int b) {
    const auto h = mesh.find_halfedge(VertexHandle(a), VertexHandle(b));
    REQUIRE(h.is_valid());
    mesh.status(h.edge()).set_feature(true);
}

} // namespace

#define EVERY_KIND_OF_MESH PolyMeshF, PolyMeshD, TriMeshF, TriMeshD

TEMPLATE_TEST_CASE("a cube with its edges marked stays the cube to the last bit", "[subdivision]",
                   EVERY_KIND_OF_MESH) {
    auto mesh = build<TestType>(support::divided_cube(2));
    mark_features(mesh);
    const auto before = mesh;
    const SubdivisionCounts counts = divide(mesh, {.rounds = 3});
    CHECK(counts.corners == 8);
    CHECK(counts.facets_after == before.n_faces() * 64);
    CHECK(counts.sharp_edges == 24 * 8);
    CHECK(counts.scheme
          == (TestType::is_trimesh() ? SubdivisionScheme::loop : SubdivisionScheme::catmull_clark));
    for (const auto v : mesh.vertices()) {
        const Vec3 p = to_vec3(mesh.point(v));
        CHECK(std::max({std::abs(p[0]), std::abs(p[1]), std::abs(p[2])}) == 1);
    }
    for (const auto v : before.vertices())
        if (std::abs(before.point(v)[0]) + std::abs(before.point(v)[1]) + std::abs(before.point(v)[2]) == 3)
            CHECK(mesh.point(v) == before.point(v));
    CHECK(marked_length_of(mesh) == 24);
    const PolygonMesh polygons = polygons_of(mesh);
    CHECK(support::faults(polygons) == "");
    const Topology topology = measure_topology(polygons);
    CHECK(topology.euler == 2);
    CHECK(topology.closed());
    CHECK(topology.signed_volume == Approx(8));
    // By the classifier's own judgement nothing else is sharp.
    mark_features(mesh);
    CHECK(marked_length_of(mesh) == 24);
}

TEST_CASE("Catmull and Clark's weights: a cube without marks", "[subdivision]") {
    auto mesh = build<PolyMeshD>(support::divided_cube(1));
    const auto before = mesh;
    divide(mesh);
    REQUIRE(mesh.n_vertices() == 8 + 12 + 6);
    for (int v = 0; v < 8; ++v)
        CHECK((mesh.point(VertexHandle(v)) - before.point(VertexHandle(v)) * (5.0 / 9)).norm() < 1e-15);
    for (int e = 0; e < 12; ++e) // 3/4 off two sides, in the middle of the third direction
        CHECK(mesh.point(VertexHandle(8 + e)).norm() == Approx(0.75 * std::sqrt(2.0)));
    for (int f = 0; f < 6; ++f) CHECK(mesh.point(VertexHandle(20 + f)).norm() == Approx(1));
}

TEMPLATE_TEST_CASE("Loop's weights: a tetrahedron without marks", "[subdivision]", PolyMeshD, TriMeshD) {
    auto mesh = build<TestType>(support::tetrahedron());
    const auto before = mesh;
    CHECK(divide(mesh).scheme == SubdivisionScheme::loop);
    REQUIRE(mesh.n_vertices() == 4 + 6);
    Vec3 all(0, 0, 0);
    for (const auto v : before.vertices()) all += before.point(v);
    for (const auto v : before.vertices()) { // 7/16 of its own, 3/16 of each of the three others
        const Vec3 place = before.point(v) * (7.0 / 16) + (all - before.point(v)) * (3.0 / 16);
        CHECK((mesh.point(v) - place).norm() < 1e-15);
    }
    for (const auto e : before.edges()) {
        const Vec3 ends = before.point(e.v0()) + before.point(e.v1());
        const Vec3 place = ends * (3.0 / 8) + (all - ends) * (1.0 / 8);
        CHECK((mesh.point(VertexHandle(4 + e.idx())) - place).norm() < 1e-15);
    }
}

TEMPLATE_TEST_CASE("a prism with marked rims comes to a cylinder between flat caps", "[subdivision]",
                   EVERY_KIND_OF_MESH) {
    auto mesh = build<TestType>(capped_cylinder(24, 4));
    mark_features(mesh);
    double last = 1;
    for (int round = 0; round < 3; ++round) {
        divide(mesh);
        double least = 10, most = 0, turn = 0;
        for (const auto e : mesh.edges()) {
            if (!mesh.status(e).feature()) continue;
            for (const auto v : {e.v0(), e.v1()}) {
                CHECK(std::abs(mesh.point(v)[2]) == 1);
                least = std::min(least, radius_of(to_vec3(mesh.point(v))));
                most = std::max(most, radius_of(to_vec3(mesh.point(v))));
            }
        }
        for (const auto v : mesh.vertices()) {
            if (std::abs(mesh.point(v)[2]) == 1) CHECK(radius_of(to_vec3(mesh.point(v))) < 1 + 1e-6);
        }
        for (const auto e : mesh.edges())
            if (!mesh.status(e).feature())
                turn = std::max(turn, double(std::abs(mesh.calc_dihedral_angle(e))));
        // The cubic B-spline of the 24 vertices lies within 1 % of the circle, and all facets bend less.
        CHECK(least > 0.985);
        CHECK(turn < 0.7 * last);
        last = turn;
    }
    CHECK(marked_length_of(mesh) == Approx(4 * std::numbers::pi).epsilon(0.02));
    CHECK(support::faults(polygons_of(mesh)) == "");
    CHECK(measure_topology(polygons_of(mesh)).euler == 2);
}

TEST_CASE("a crease of which nothing else is known is a uniform cubic B-spline", "[subdivision]") {
    const auto bumpy = sheet(6, [](Index x, Index y) { return 0.3 * ((x * y + x) % 3); });
    auto mesh = build<PolyMeshD>(bumpy);
    for (int x = 0; x < 6; ++x) mark_edge(mesh, 21 + x, 22 + x);
    const auto before = mesh;
    divide(mesh);
    for (int v = 22; v < 27; ++v) {
        const auto at = [&](int i) { return before.point(VertexHandle(i)); };
        CHECK((mesh.point(VertexHandle(v)) - (at(v - 1) + at(v) * 6.0 + at(v + 1)) / 8).norm() < 1e-15);
    }
    CHECK(mesh.point(VertexHandle(21)) == before.point(VertexHandle(21))); // it meets the boundary
    for (const auto e : before.edges())
        if (before.status(e).feature())
            CHECK((mesh.point(VertexHandle(static_cast<int>(before.n_vertices()) + e.idx()))
                   - (before.point(e.v0()) + before.point(e.v1())) / 2)
                      .norm()
                  < 1e-15);
}

TEST_CASE("a dart moves as a smooth vertex does, the edge it ends stays sharp", "[subdivision]") {
    const auto bumpy = sheet(6, [](Index x, Index y) { return std::sin(3.7 * x + 5.1 * y * y); });
    for (const auto scheme : {SubdivisionScheme::catmull_clark, SubdivisionScheme::loop}) {
        auto plain = build<PolyMeshD>(scheme == SubdivisionScheme::loop ? support::cut_in_two(bumpy) : bumpy);
        auto marked = plain;
        mark_edge(marked, 23, 24);
        mark_edge(marked, 24, 25);
        const auto before = marked;
        const auto sharp = before.find_halfedge(VertexHandle(24), VertexHandle(25)).edge();
        divide(plain, {.scheme = scheme});
        const SubdivisionCounts counts = divide(marked, {.scheme = scheme});
        CHECK(counts.sharp_edges == 4);
        for (const int dart : {23, 25})
            CHECK(marked.point(VertexHandle(dart)) == plain.point(VertexHandle(dart)));
        CHECK(marked.point(VertexHandle(24)) != plain.point(VertexHandle(24)));
        const VertexHandle middle(static_cast<int>(before.n_vertices()) + sharp.idx());
        CHECK((marked.point(middle) - (before.point(VertexHandle(24)) + before.point(VertexHandle(25))) / 2)
                  .norm()
              < 1e-15);
        CHECK(marked.point(middle) != plain.point(middle));
    }
}

TEMPLATE_TEST_CASE("boundaries depend on the boundary alone, their corners stay", "[subdivision]", PolyMeshD,
                   TriMeshD) {
    const auto curved = [](bool bumps) {
        return sheet(6, [=](Index x, Index y) {
            const bool inside = x > 0 && y > 0 && x < 6 && y < 6;
            return (x % 3) * 0.2 + y * 0.1 + (bumps && inside ? (x * y % 4) * 0.5 : 0.0);
        });
    };
    auto flat = build<TestType>(curved(false)), bumpy = build<TestType>(curved(true));
    divide(flat, {.rounds = 2});
    divide(bumpy, {.rounds = 2});
    std::size_t on_boundary = 0, elsewhere = 0;
    for (const auto v : flat.vertices()) {
        if (v.is_boundary()) {
            CHECK(flat.point(v) == bumpy.point(v));
            ++on_boundary;
        } else
            elsewhere += flat.point(v) != bumpy.point(v);
    }
    CHECK(on_boundary == 4 * 6 * 4);
    CHECK(elsewhere > 100);
    for (const auto& corner : {Vec3(0, 0, 0), Vec3(6, 6, 0.6)})
        CHECK(std::any_of(flat.vertices_begin(), flat.vertices_end(),
                          [&](const auto& v) { return (flat.point(v) - corner).norm() < 1e-12; }));
    auto round = build<TestType>(curved(false));
    divide(round, {.corner_angle = 3});
    CHECK(round.point(VertexHandle(0)) != flat.point(VertexHandle(0)));
}

TEST_CASE("a corner found by its turn stays one in later rounds", "[subdivision]") {
    auto mesh = build<PolyMeshD>(sheet(2, [](Index, Index) { return 0.0; }));
    divide(mesh, {.rounds = 4});
    double area = 0;
    for (const Vec3& twice : facet_area_vectors(mesh)) area += twice.norm() / 2;
    CHECK(area == 4);
}

TEST_CASE("new elements inherit what their parents have", "[subdivision]") {
    PolyMesh mesh = to_mesh(support::divided_cube(2)).mesh;
    classify_features(mesh);
    mesh.request_vertex_colors();
    auto heat = kept_vertex_property<float>(mesh, "heat");
    auto label = kept_vertex_property<std::int32_t>(mesh, "label");
    auto red = kept_vertex_property<std::uint8_t>(mesh, "red");
    auto level = kept_vertex_property<std::uint8_t>(mesh, level_property);
    OpenMesh::FProp<int> patch(mesh, "patch");
    OpenMesh::EProp<int> seam(mesh, "seam");
    OpenMesh::HProp<int> turn(mesh, "turn");
    for (const auto v : mesh.vertices()) {
        heat[v] = static_cast<float>(v.idx());
        label[v] = v.idx();
        red[v] = static_cast<std::uint8_t>(10 * v.idx());
        level[v] = 5;
        mesh.set_color(v, PolyMesh::Color(static_cast<float>(v.idx()), 0, 1, 1));
    }
    for (const auto f : mesh.faces()) patch[f] = f.idx();
    for (const auto e : mesh.edges()) seam[e] = 100 + e.idx();
    for (const auto h : mesh.halfedges()) turn[h] = 1000 + h.idx();
    mesh.status(FaceHandle(3)).set_selected(true);
    mesh.status(VertexHandle(0)).set_locked(true);
    const PolyMesh before = mesh;
    divide(mesh);

    CHECK(fault_of(mesh) == "");
    auto classes = OpenMesh::getProperty<VertexHandle, std::uint8_t>(mesh, vertex_class_property);
    PolyMesh kept = before; // properties of a mesh that cannot change cannot be had
    const auto old_classes = OpenMesh::getProperty<VertexHandle, std::uint8_t>(kept, vertex_class_property);
    const int v0 = static_cast<int>(before.n_vertices()), e0 = static_cast<int>(before.n_edges());
    for (const auto v : before.vertices()) {
        CHECK(classes[v] == old_classes[v]);
        CHECK(double(heat[v]) == v.idx());
        CHECK(mesh.status(v).bits() == before.status(v).bits());
    }
    for (const auto e : before.edges()) {
        const VertexHandle middle(v0 + e.idx());
        const bool sharp = before.status(e).feature();
        CHECK(classes[middle] == (sharp ? 1 : 0));
        CHECK(mesh.status(middle).feature() == sharp);
        CHECK_FALSE(mesh.status(middle).locked());
        const auto a = before.from_vertex_handle(before.halfedge_handle(e, 0));
        const auto b = before.to_vertex_handle(before.halfedge_handle(e, 0));
        const double mean = (a.idx() + b.idx()) / 2.0;
        CHECK(double(heat[middle]) == mean);
        CHECK(label[middle] == a.idx());
        CHECK(red[middle] == int(10 * mean + 0.5));
        CHECK(level[middle] == 5);
        CHECK(double(mesh.color(middle)[0]) == mean);
        CHECK(mesh.color(middle)[2] == 1);
        for (const EdgeHandle part : {EdgeHandle(e), EdgeHandle(e0 + e.idx())}) {
            CHECK(mesh.status(part).feature() == sharp);
            CHECK(seam[part] == 100 + e.idx());
            for (const unsigned side : {0u, 1u})
                CHECK(turn[mesh.halfedge_handle(part, side)] == 1000 + before.halfedge_handle(e, side).idx());
        }
    }
    std::vector<int> parts(before.n_faces(), 0);
    for (const auto f : mesh.faces()) {
        ++parts[static_cast<std::size_t>(patch[f])];
        CHECK(mesh.status(f).selected() == (patch[f] == 3));
        CHECK((mesh.normal(f) - before.normal(FaceHandle(patch[f]))).norm() < 1e-12);
    }
    CHECK(std::all_of(parts.begin(), parts.end(), [](int n) { return n == 4; }));
    auto counts = OpenMesh::getProperty<VertexHandle, std::uint8_t>(mesh, normal_count_property);
    for (const auto v : mesh.vertices()) CHECK(counts[v] == classes[v] + 1);
}

TEST_CASE("deleted elements are gone before the mesh is divided", "[subdivision]") {
    auto mesh = build<PolyMeshD>(support::divided_cube(4));
    for (const int f : {3, 40, 41}) mesh.delete_face(FaceHandle(f), true);
    auto compact = mesh;
    compact.garbage_collection();
    const SubdivisionCounts counts = divide(mesh);
    CHECK(counts.facets_before == 6 * 16 - 3);
    CHECK(counts == divide(compact));
    for (const auto v : mesh.vertices()) CHECK(mesh.point(v) == compact.point(v));
    CHECK(std::count_if(mesh.edges_begin(), mesh.edges_end(), [](const auto& e) { return e.is_boundary(); })
          == 2 * (4 + 6));
}

TEST_CASE("polygons of any number of corners become quads", "[subdivision]") {
    PolygonMesh prism;
    std::vector<Index> bottom, top;
    for (Index i = 0; i < 5; ++i) {
        const double a = 2 * std::numbers::pi * i / 5;
        prism.positions.emplace_back(std::cos(a), std::sin(a), 0);
        prism.positions.emplace_back(std::cos(a), std::sin(a), 1);
        bottom.insert(bottom.begin(), 2 * i);
        top.push_back(2 * i + 1);
    }
    prism.add_facet(bottom);
    prism.add_facet(top);
    for (Index i = 0; i < 5; ++i) {
        const Index j = (i + 1) % 5;
        prism.add_facet(std::array{2 * i, 2 * j, 2 * j + 1, 2 * i + 1});
    }
    auto mesh = build<PolyMeshD>(prism);
    CHECK(divide(mesh).facets_after == 5 + 5 + 20);
    for (const auto f : mesh.faces()) CHECK(f.valence() == 4);
    CHECK(support::faults(polygons_of(mesh)) == "");
}

TEST_CASE("division gives the same bits on one thread and on many", "[subdivision]") {
    PolyMesh many = to_mesh(noisy(sphere(30), 0.006)).mesh;
    classify_features(many);
    PolyMesh one = many;
    const SubdivisionCounts with_many = subdivide(many, {.rounds = 2});
    {
        const tbb::global_control single(tbb::global_control::max_allowed_parallelism, 1);
        CHECK(subdivide(one, {.rounds = 2}) == with_many);
    }
    for (const auto v : many.vertices()) REQUIRE(many.point(v) == one.point(v));
    for (const auto h : many.halfedges()) REQUIRE(h.next() == one.next_halfedge_handle(h));
}

TEST_CASE("division options out of range, and no initialize(), are told", "[subdivision]") {
    auto mesh = build<PolyMeshD>(support::unit_cube());
    FeatureSubdividerT<PolyMeshD> subdivider(mesh);
    CHECK_THROWS_AS(subdivider.divide(), std::logic_error);
    CHECK_THROWS_AS(subdivider.initialize({.rounds = -1}), OptionError);
    CHECK_THROWS_AS(subdivider.initialize({.rounds = 11}), OptionError);
    CHECK_THROWS_AS(subdivider.initialize({.corner_angle = 0}), OptionError);
    CHECK_THROWS_AS(subdivider.divide(), std::logic_error);
    subdivider.initialize({.scheme = SubdivisionScheme::loop});
    CHECK_THROWS_WITH(subdivider.divide(), Catch::Matchers::Contains("facet 0 is no triangle"));
    subdivider.initialize({.rounds = 0});
    CHECK(subdivider.divide().facets_after == 6);

    auto triangles = build<TriMeshD>(support::unit_cube());
    FeatureSubdividerT<TriMeshD> loop(triangles);
    CHECK_THROWS_AS(loop.initialize({.scheme = SubdivisionScheme::catmull_clark}), OptionError);

    auto large = build<PolyMeshD>(support::divided_cube(12));
    FeatureSubdividerT<PolyMeshD> many(large);
    many.initialize({.rounds = 10});
    CHECK_THROWS_WITH(many.divide(), Catch::Matchers::Contains("half-edges"));
    CHECK(large.n_faces() == 6 * 144);
}

TEST_CASE("an empty mesh, and vertices without facets, are divided to themselves", "[subdivision]") {
    PolyMesh mesh;
    CHECK(subdivide(mesh).facets_after == 0);
    mesh.add_vertex(Vec3(1, 2, 3));
    CHECK(subdivide(mesh).vertices == 1);
    CHECK(mesh.point(VertexHandle(0)) == Vec3(1, 2, 3));
}
