#include "features/meshes.hh"
#include "hsdm/errors.hh"
#include "hsdm/features/AnisotropicSmootherT.hh"
#include "hsdm/features/FeatureClassifierT.hh"
#include "hsdm/features/features.hh"
#include "hsdm/mesh/to_mesh.hh"
#include "hsdm/quality/topology.hh"
#include "hsdm/spatial/self_intersections.hh"

#include <catch2/catch.hpp>
#include <tbb/global_control.h>

using namespace hsdm;
using namespace hsdm::test;
using OpenMesh::VertexHandle;

namespace {

template <class Mesh>
VertexSmoothingResult smooth_places(Mesh& mesh, const VertexSmoothingOptions& options = {.rounds = 3}) {
    AnisotropicSmootherT<Mesh> smoother(mesh);
    smoother.initialize(options);
    return smoother.smooth();
}

/// Marks the edges of a noisy mesh that fold the exact one by more than 30 degrees, and the classes that
/// follow.
template <class Mesh>
void mark_as_exact(Mesh& mesh, const PolygonMesh& exact) {
    Mesh clean = build<Mesh>(exact);
    FeatureClassifierT<Mesh> classifier(clean);
    classifier.initialize();
    classifier.classify();
    auto classes = kept_vertex_property<std::uint8_t>(mesh, vertex_class_property);
    const auto exact_classes =
        OpenMesh::getProperty<VertexHandle, std::uint8_t>(clean, vertex_class_property);
    for (const auto e : mesh.edges()) mesh.status(e).set_feature(clean.status(e).feature());
    for (const auto v : mesh.vertices()) {
        mesh.status(v).set_feature(clean.status(v).feature());
        classes[v] = exact_classes[v];
    }
}

/// How far a mesh is from a surface: its vertices on average, and the normals of its facets.
struct Distances {
    double place = 0, normal = 0;
};

/// `surface(p)`: the distance of p and the normal there.
template <class Mesh, class Surface>
Distances distances(const Mesh& mesh, const Surface& surface) {
    Distances mean;
    for (const auto v : mesh.vertices()) mean.place += surface(to_vec3(mesh.point(v))).first;
    const std::vector<Vec3> areas = facet_area_vectors(mesh);
    for (const auto f : mesh.faces())
        mean.normal += angle_between(areas[index_of(f)], surface(to_vec3(mesh.calc_face_centroid(f))).second);
    mean.place /= static_cast<double>(mesh.n_vertices());
    mean.normal /= static_cast<double>(mesh.n_faces());
    return mean;
}

std::pair<double, Vec3> to_sphere(const Vec3& p) {
    return {std::abs(p.norm() - 1), p};
}

std::pair<double, Vec3> to_cube(const Vec3& p) {
    std::size_t side = 0;
    for (std::size_t i = 1; i < 3; ++i)
        if (std::abs(p[i]) > std::abs(p[side])) side = i;
    Vec3 normal(0, 0, 0);
    normal[side] = p[side] > 0 ? 1 : -1;
    return {std::abs(std::abs(p[side]) - 1), normal};
}

std::pair<double, Vec3> to_cylinder(const Vec3& p) {
    const double radius = std::hypot(p[0], p[1]);
    if (1 - std::abs(p[2]) < 1 - radius) return {std::abs(1 - std::abs(p[2])), Vec3(0, 0, p[2])};
    return {std::abs(1 - radius), Vec3(p[0], p[1], 0)};
}

/// Whatever it does, the mesh's links, drift and volume are as promised.
template <class Mesh>
void check_promises(const Mesh& mesh, const VertexSmoothingResult& result, double volume_bound) {
    CHECK(long(mesh.n_vertices()) - long(mesh.n_edges()) + long(mesh.n_faces()) == 2);
    CHECK(result.drift_max <= result.drift_bound * (1 + 1e-12));
    CHECK(result.drift_mean <= result.drift_max);
    CHECK(result.drift_mean > 0);
    CHECK(std::abs(result.volume_after - result.volume_before) <= volume_bound * result.volume_before);
}

} // namespace

#define EVERY_KIND_OF_MESH PolyMeshF, PolyMeshD, TriMeshF, TriMeshD

TEMPLATE_TEST_CASE("a noisy sphere comes nearer to the sphere, its facets' normals too", "[smoothing]",
                   EVERY_KIND_OF_MESH) {
    TestType mesh = build<TestType>(noisy(sphere(20), 0.012));
    const Distances before = distances(mesh, to_sphere);
    const VertexSmoothingResult result = smooth_places(mesh);
    const Distances after = distances(mesh, to_sphere);
    check_promises(mesh, result, 0.01);
    INFO(before.place << " " << after.place << " normals " << before.normal << " " << after.normal);
    CHECK(after.place < 0.6 * before.place);
    CHECK(after.normal < 0.5 * before.normal);
}

TEMPLATE_TEST_CASE("a noisy cube with marked edges comes nearer to the cube, its edges become straight",
                   "[smoothing]", EVERY_KIND_OF_MESH) {
    const Index n = 12;
    const PolygonMesh exact = support::divided_cube(n);
    PolygonMesh moved = noisy(exact, 0.02);
    const auto sides = [](const Vec3& p) {
        return (std::abs(p[0]) == 1) + (std::abs(p[1]) == 1) + (std::abs(p[2]) == 1);
    };
    for (std::size_t v = 0; v < moved.positions.size(); ++v)
        if (sides(exact.positions[v]) == 3) moved.positions[v] = exact.positions[v];
    TestType mesh = build<TestType>(moved);
    mark_as_exact(mesh, exact);
    const Distances before = distances(mesh, to_cube);
    check_promises(mesh, smooth_places(mesh, {.rounds = 6}), 0.01);
    const Distances after = distances(mesh, to_cube);
    INFO(before.place << " " << after.place << " normals " << before.normal << " " << after.normal);
    CHECK(after.place < 0.5 * before.place);
    CHECK(after.normal < 0.3 * before.normal);
    double off_before = 0, off_after = 0;
    for (std::size_t v = 0; v < exact.positions.size(); ++v) {
        const auto place = mesh.point(VertexHandle(static_cast<int>(v)));
        if (sides(exact.positions[v]) == 3) CHECK(to_vec3(place) == exact.positions[v]); // bit for bit
        if (sides(exact.positions[v]) != 2) continue;
        for (std::size_t i = 0; i < 3; ++i) {
            if (std::abs(exact.positions[v][i]) != 1) continue;
            off_before += std::pow(moved.positions[v][i] - exact.positions[v][i], 2);
            off_after += std::pow(static_cast<double>(place[i]) - exact.positions[v][i], 2);
        }
    }
    INFO(off_before << " " << off_after);
    CHECK(off_after < 0.3 * off_before);
}

TEMPLATE_TEST_CASE("a noisy cylinder's side stays round, its caps become flat", "[smoothing]",
                   EVERY_KIND_OF_MESH) {
    const PolygonMesh exact = capped_cylinder(40, 12);
    TestType mesh = build<TestType>(noisy(exact, 0.012));
    mark_as_exact(mesh, exact);
    const Distances before = distances(mesh, to_cylinder);
    check_promises(mesh, smooth_places(mesh), 0.01);
    const Distances after = distances(mesh, to_cylinder);
    INFO(before.place << " " << after.place << " normals " << before.normal << " " << after.normal);
    CHECK(after.place < 0.7 * before.place);
    CHECK(after.normal < 0.6 * before.normal);
}

TEMPLATE_TEST_CASE("what has no noise stays where it is", "[smoothing]", EVERY_KIND_OF_MESH) {
    const PolygonMesh exact = support::divided_cube(5);
    TestType mesh = build<TestType>(exact);
    mark_as_exact(mesh, exact);
    const VertexSmoothingResult result = smooth_places(mesh);
    CHECK(result.drift_max < 1e-6);
    CHECK(result.refused == 0);
    CHECK(result.volume_after == Approx(8));
}

TEST_CASE("boundary, locked vertices and corners stay to the last bit, all others move", "[smoothing]") {
    auto mesh = build<PolyMeshD>(noisy(sheet(8, [](Index, Index) { return 0.0; }), 0.1));
    auto classes = kept_vertex_property<std::uint8_t>(mesh, vertex_class_property);
    for (const auto v : mesh.vertices()) classes[v] = 0;
    const VertexHandle locked(20), corner(30), tip(40);
    mesh.status(locked).set_locked(true);
    classes[corner] = static_cast<std::uint8_t>(VertexClass::corner);
    mesh.status(tip).set_feature(true);
    const PolyMeshD before = mesh;
    const VertexSmoothingResult result = smooth_places(mesh);
    std::size_t moved = 0;
    for (const auto v : mesh.vertices()) {
        const bool stays = v.is_boundary() || v == locked || v == corner || v == tip;
        CHECK((mesh.point(v) == before.point(v)) == stays);
        moved += !stays;
    }
    CHECK(result.moved == moved);
    CHECK_FALSE(result.volume_bound_met);
}

TEST_CASE("a crease's end moves as the surface, a sharp turn of a crease stays", "[smoothing]") {
    auto mesh = build<PolyMeshD>(noisy(sheet(8, [](Index, Index) { return 0.0; }), 0.1));
    const auto mark = [&](int a, int b) {
        const auto h = mesh.find_halfedge(VertexHandle(a), VertexHandle(b));
        REQUIRE(h.is_valid());
        mesh.status(h.edge()).set_feature(true);
    };
    mark(39, 40);
    mark(40, 49); // 40: where it turns by a right angle
    const PolyMeshD before = mesh;
    smooth_places(mesh);
    CHECK(mesh.point(VertexHandle(40)) == before.point(VertexHandle(40)));
    CHECK(mesh.point(VertexHandle(39)) != before.point(VertexHandle(39)));
    mesh = before;
    smooth_places(mesh, {.rounds = 3, .corner_angle = 3});
    CHECK(mesh.point(VertexHandle(40)) != before.point(VertexHandle(40)));
}

TEST_CASE("no vertex drifts farther than asked, as a length or in mean edges", "[smoothing]") {
    const PolyMeshD noise = build<PolyMeshD>(noisy(sphere(12), 0.05));
    double edges = 0;
    for (const auto e : noise.edges()) edges += noise.calc_edge_length(e);
    const double mean = edges / static_cast<double>(noise.n_edges());
    for (const double bound : {0.001, 0.02}) {
        for (const bool as_length : {true, false}) {
            PolyMeshD mesh = noise;
            VertexSmoothingOptions options{.rounds = 3};
            if (as_length)
                options.max_drift = bound;
            else
                options.max_drift_share = bound / mean;
            const VertexSmoothingResult result = smooth_places(mesh, options);
            CHECK(result.drift_bound == Approx(bound));
            double farthest = 0;
            for (const auto v : mesh.vertices())
                farthest = std::max(farthest, (mesh.point(v) - noise.point(v)).norm());
            CHECK(farthest == Approx(result.drift_max));
            CHECK(farthest <= bound * (1 + 1e-12));
            CHECK(farthest > 0.99 * bound); // noise would take some farther
        }
    }
}

TEST_CASE("a volume that must not change ends smoothing early", "[smoothing]") {
    // A cube without marked edges becomes round, and smaller.
    PolyMeshD free = build<PolyMeshD>(support::divided_cube(6)), held = free;
    const VertexSmoothingOptions smooth{.rounds = 20, .similarity_angle = 2, .max_drift_share = 2};
    VertexSmoothingOptions tight = smooth, loose = smooth;
    loose.max_volume_change = 1;
    tight.max_volume_change = 0.001;
    const VertexSmoothingResult far = smooth_places(free, loose), near = smooth_places(held, tight);
    CHECK_FALSE(far.volume_bound_met);
    CHECK(std::abs(far.volume_after - 8) > 0.08);
    CHECK(near.volume_bound_met);
    CHECK(std::abs(near.volume_after - 8) <= 0.008);
    CHECK(std::abs(near.volume_after - 8) > 0.004); // as far as it may
    CHECK(measure_topology(to_polygons(to_mesh(support::divided_cube(6)).mesh)).signed_volume == Approx(8));
}

TEST_CASE("facets that would turn over are refused and counted", "[smoothing]") {
    const auto inward = [](const PolyMeshD& mesh) {
        const std::vector<Vec3> areas = facet_area_vectors(mesh);
        return std::count_if(mesh.faces_begin(), mesh.faces_end(), [&](const auto& f) {
            return (areas[index_of(f)] | mesh.calc_face_centroid(f)) <= 0;
        });
    };
    PolyMeshD mesh = build<PolyMeshD>(noisy(sphere(16), 0.03)); // a quarter of an edge
    const auto before = inward(mesh);
    CHECK(smooth_places(mesh, {.rounds = 3, .max_drift_share = 1}).refused > 0);
    CHECK(inward(mesh) <= before);
    PolyMeshD calm = build<PolyMeshD>(noisy(sphere(16), 0.01));
    CHECK(smooth_places(calm, {.rounds = 3, .max_drift_share = 1}).refused == 0);
}

TEST_CASE("deleted elements play no part", "[smoothing]") {
    auto mesh = build<PolyMeshD>(noisy(support::divided_cube(6), 0.02));
    for (const int f : {3, 40, 41, 100}) mesh.delete_face(OpenMesh::FaceHandle(f), true);
    auto compact = mesh;
    compact.garbage_collection();
    const VertexSmoothingResult with = smooth_places(mesh), without = smooth_places(compact);
    mesh.garbage_collection();
    REQUIRE(mesh.n_vertices() == compact.n_vertices());
    CHECK(with.moved == without.moved);
    for (const auto v : mesh.vertices()) CHECK((mesh.point(v) - compact.point(v)).norm() < 1e-12);
}

TEST_CASE("smoothing gives the same bits on one thread and on many, and renews all normals", "[smoothing]") {
    PolyMesh many = to_mesh(noisy(sphere(40), 0.006)).mesh;
    classify_features(many);
    smooth_normals(many);
    PolyMesh one = many;
    const Vec3 old = many.normal(VertexHandle(100));
    const VertexSmoothingResult with_many = smooth_vertices(many);
    {
        const tbb::global_control single(tbb::global_control::max_allowed_parallelism, 1);
        CHECK(smooth_vertices(one) == with_many);
    }
    for (const auto v : many.vertices()) {
        REQUIRE(many.point(v) == one.point(v));
        REQUIRE(many.normal(v) == one.normal(v));
    }
    CHECK(many.normal(VertexHandle(100)) != old);
    for (const auto f : many.faces()) REQUIRE((many.normal(f) - many.calc_face_normal(f)).norm() < 1e-9);
    const auto normals = OpenMesh::getProperty<VertexHandle, VertexNormalsT<PolyMesh>>(many, "hsdm_normals");
    const auto counts = OpenMesh::getProperty<VertexHandle, std::uint8_t>(many, "hsdm_normal_count");
    std::size_t smooth = 0;
    for (const auto v : many.vertices()) {
        if (counts[v] != 1) continue;
        REQUIRE((normals[v][0] - many.normal(v)).norm() < 1e-9);
        ++smooth;
    }
    CHECK(smooth > many.n_vertices() / 2);
}

TEST_CASE("smoothing options out of range, and no initialize(), are told", "[smoothing]") {
    auto mesh = build<PolyMeshD>(support::unit_cube());
    AnisotropicSmootherT<PolyMeshD> smoother(mesh);
    CHECK_THROWS_AS(smoother.smooth(), std::logic_error);
    CHECK_THROWS_AS(smoother.initialize({.rounds = -1}), OptionError);
    CHECK_THROWS_AS(smoother.initialize({.normal_rounds = -1}), OptionError);
    CHECK_THROWS_AS(smoother.initialize({.position_rounds = -1}), OptionError);
    CHECK_THROWS_AS(smoother.initialize({.similarity_angle = 0}), OptionError);
    CHECK_THROWS_AS(smoother.initialize({.corner_angle = 4}), OptionError);
    CHECK_THROWS_AS(smoother.initialize({.max_drift = 0}), OptionError);
    CHECK_THROWS_AS(smoother.initialize({.max_drift = std::nan("")}), OptionError);
    CHECK_THROWS_AS(smoother.initialize({.max_drift_share = 0}), OptionError);
    CHECK_THROWS_AS(smoother.initialize({.max_volume_change = -1}), OptionError);
    CHECK_THROWS_AS(smoother.smooth(), std::logic_error);
    smoother.initialize({.rounds = 0});
    CHECK(smoother.smooth().moved == 0);
}

TEST_CASE("a mesh without facets is smoothed to itself", "[smoothing]") {
    PolyMesh mesh;
    CHECK(smooth_vertices(mesh).moved == 0);
    mesh.add_vertex(Vec3(1, 2, 3));
    CHECK(smooth_vertices(mesh).moved == 0);
    CHECK(mesh.point(VertexHandle(0)) == Vec3(1, 2, 3));
}

TEST_CASE("a mesh that does not pass through itself does not after smoothing either") {
    constexpr Index n = 20;
    support::Random random(5);
    std::vector<double> rough;
    for (Index i = 0; i < (n + 1) * (n + 1); ++i) rough.push_back(random.uniform(-0.2, 0.2));
    // Two rough sheets of which a quarter nearly touches; the lower one is locked, so there the upper one
    // sinks into its peaks.
    PolygonMesh both =
        support::cut_in_two(sheet(n, [&](Index x, Index y) { return rough[y * (n + 1) + x]; }));
    const PolygonMesh lower = both;
    const auto count = static_cast<Index>(lower.vertex_count());
    for (const Vec3& p : lower.positions) both.positions.push_back(p + Vec3(0, 0, p[0] < 5.5 ? 0.01 : 2));
    for (std::size_t f = 0; f < lower.facet_count(); ++f) {
        const auto ring = lower.facet(f);
        both.add_facet(std::array{ring[0] + count, ring[1] + count, ring[2] + count});
    }
    REQUIRE(find_self_intersections(both).facet_pairs.empty());
    const auto smoothed = [&](bool keep_apart) {
        PolyMesh mesh = to_mesh(both).mesh;
        for (int v = 0; v < static_cast<int>(count); ++v) mesh.status(VertexHandle(v)).set_locked(true);
        const VertexSmoothingResult result = smooth_vertices(mesh, {.rounds = 2, .keep_apart = keep_apart});
        CHECK(result.moved > 20);
        CHECK((result.taken_back > 0) == keep_apart);
        return find_self_intersections(to_polygons(mesh)).facet_pairs.size();
    };
    CHECK(smoothed(false) > 3);
    CHECK(smoothed(true) == 0);
}
