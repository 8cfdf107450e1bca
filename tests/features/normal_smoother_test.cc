#include "features/meshes.hh"
#include "hsdm/errors.hh"
#include "hsdm/features/AnisotropicNormalSmootherT.hh"
#include "hsdm/features/FeatureClassifierT.hh"
#include "hsdm/features/features.hh"
#include "hsdm/mesh/to_mesh.hh"

#include <catch2/catch.hpp>

using namespace hsdm;
using namespace hsdm::test;
using OpenMesh::VertexHandle;

namespace {

template <class Mesh>
std::size_t smooth(Mesh& mesh, int rounds, const NormalSmoothingOptions& options = {}) {
    AnisotropicNormalSmootherT<Mesh> smoother(mesh);
    smoother.initialize(options);
    return smoother.smooth(rounds);
}

template <class Mesh>
void mark_creases(Mesh& mesh, const FeatureOptions& options = {}) {
    FeatureClassifierT<Mesh> classifier(mesh);
    classifier.initialize(options);
    classifier.classify();
}

/// Mean angle between the vertices' standard normals and the radius, in radians.
template <class Mesh>
double mean_error_on_sphere(const Mesh& mesh) {
    double sum = 0;
    for (const auto v : mesh.vertices())
        sum += angle_between(to_vec3(mesh.normal(v)), to_vec3(mesh.point(v)));
    return sum / static_cast<double>(mesh.n_vertices());
}

/// Marks the true edges of the cube by hand.
template <class Mesh>
void mark_cube_edges(Mesh& mesh, const PolygonMesh& exact) {
    for (const auto e : mesh.edges()) {
        const Vec3 a = exact.positions[index_of(e.v0())], b = exact.positions[index_of(e.v1())];
        int sides = 0;
        for (std::size_t i = 0; i < 3; ++i) sides += std::abs(a[i]) == 1 && a[i] == b[i];
        mesh.status(e).set_feature(sides == 2);
    }
}

/// The largest angle between any of the vertices' normals and the sides of the cube they belong to.
template <class Mesh>
double worst_error_on_cube(Mesh& mesh) {
    auto number = OpenMesh::getProperty<VertexHandle, std::uint8_t>(mesh, "hsdm_normal_count");
    auto normals = OpenMesh::getProperty<VertexHandle, VertexNormalsT<Mesh>>(mesh, "hsdm_normals");
    double worst = 0;
    for (const auto v : mesh.vertices())
        for (std::size_t k = 0; k < number[v]; ++k) {
            const Vec3 normal = to_vec3(normals[v][k]);
            double nearest = 10;
            for (std::size_t i = 0; i < 3; ++i)
                for (const double sign : {-1.0, 1.0}) {
                    Vec3 side(0, 0, 0);
                    side[i] = sign;
                    nearest = std::min(nearest, angle_between(normal, side));
                }
            worst = std::max(worst, nearest);
        }
    return worst;
}

} // namespace

#define EVERY_KIND_OF_MESH PolyMeshF, PolyMeshD, TriMeshF, TriMeshD

TEMPLATE_TEST_CASE("a cube keeps its normals and is settled at once", "", EVERY_KIND_OF_MESH) {
    TestType mesh = build<TestType>(support::divided_cube(4));
    mark_creases(mesh);
    CHECK(smooth(mesh, 10) == 0);
    CHECK(worst_error_on_cube(mesh) < 1e-6);
    auto number = OpenMesh::getProperty<VertexHandle, std::uint8_t>(mesh, "hsdm_normal_count");
    for (const auto v : mesh.vertices()) {
        // The standard normal is the mean of the vertex's sides: along its position, unit where it is a
        // corner.
        CHECK(mesh.normal(v).norm() == Approx(1));
        if (number[v] == 3) CHECK(angle_between(to_vec3(mesh.normal(v)), to_vec3(mesh.point(v))) < 1e-6);
    }
}

TEMPLATE_TEST_CASE("a cylinder's caps do not bleed into its side", "", EVERY_KIND_OF_MESH) {
    TestType mesh = build<TestType>(capped_cylinder(60, 10));
    mark_creases(mesh);
    smooth(mesh, 20);
    auto number = OpenMesh::getProperty<VertexHandle, std::uint8_t>(mesh, "hsdm_normal_count");
    auto normals = OpenMesh::getProperty<VertexHandle, VertexNormalsT<TestType>>(mesh, "hsdm_normals");
    for (const auto v : mesh.vertices())
        for (std::size_t k = 0; k < number[v]; ++k) {
            const double up = std::abs(normals[v][k][2]);
            CHECK(std::min(up, 1 - up) < 1e-3);
        }
}

TEMPLATE_TEST_CASE("smoothing brings a noisy sphere's normals nearer to the truth", "", EVERY_KIND_OF_MESH) {
    TestType mesh = build<TestType>(noisy(sphere(24), 0.006));
    smooth(mesh, 0);
    const double before = mean_error_on_sphere(mesh);
    smooth(mesh, 5);
    const double after = mean_error_on_sphere(mesh);
    CHECK(before > 0.02);
    CHECK(after < 0.6 * before);
}

TEMPLATE_TEST_CASE("a noisy box's normals converge to its six sides, none averaged across an edge", "",
                   EVERY_KIND_OF_MESH) {
    const PolygonMesh exact = support::divided_cube(16);
    TestType mesh = build<TestType>(noisy(exact, 0.004));
    mark_cube_edges(mesh, exact);
    smooth(mesh, 0);
    const double before = worst_error_on_cube(mesh);
    CHECK(smooth(mesh, 400) == 0);
    CHECK(before > 0.06);
    CHECK(worst_error_on_cube(mesh) < 0.25 * before);
}

TEST_CASE("without marked edges a blunt fold is smoothed, a similarity angle below it keeps it") {
    const auto fold = sheet(10, [](Index x, Index) { return x > 5 ? 0.4 * (x - 5.0) : 0.0; });
    const auto turned = [&](double similarity_angle) {
        PolyMeshD mesh = build<PolyMeshD>(fold);
        smooth(mesh, 10, {.similarity_angle = similarity_angle});
        return angle_between(mesh.normal(VertexHandle(11 * 5 + 4)), Vec3(0, 0, 1));
    };
    CHECK(turned(1.0) > 0.05);
    CHECK(turned(0.1) < 0.005);
}

TEST_CASE("the result does not depend on the order of facets and vertices") {
    const PolygonMesh there = noisy(support::divided_cube(6), 0.02);
    const auto count = static_cast<Index>(there.vertex_count());
    PolygonMesh back;
    back.positions.assign(there.positions.rbegin(), there.positions.rend());
    for (std::size_t f = there.facet_count(); f-- > 0;) {
        std::vector<Index> facet;
        for (const Index v : there.facet(f)) facet.push_back(count - 1 - v);
        back.add_facet(facet);
    }
    PolyMesh a = to_mesh(there).mesh, b = to_mesh(back).mesh;
    classify_features(a, {.crease_angle = 0.8});
    classify_features(b, {.crease_angle = 0.8});
    smooth_normals(a);
    smooth_normals(b);
    for (Index v = 0; v < count; ++v)
        CHECK((a.normal(VertexHandle(static_cast<int>(v)))
               - b.normal(VertexHandle(static_cast<int>(count - 1 - v))))
                  .norm()
              < 1e-12);
}

TEST_CASE("rounds add up: two and three are five") {
    PolyMesh once = to_mesh(noisy(sphere(8), 0.01)).mesh, twice = once;
    smooth(once, 5);
    AnisotropicNormalSmootherT<PolyMesh> smoother(twice);
    smoother.initialize();
    smoother.smooth(2);
    smoother.smooth(3);
    for (const auto v : once.vertices()) CHECK(once.normal(v) == twice.normal(v));
}

TEST_CASE("locked facets keep their normals and lend them, locked vertices keep theirs") {
    PolyMeshD mesh = build<PolyMeshD>(noisy(sheet(6, [](Index, Index) { return 0.0; }), 0.05));
    const VertexHandle locked(24);
    mesh.set_normal(locked, Vec3(1, 0, 0));
    mesh.status(locked).set_locked(true);
    PolyMeshD still = mesh;
    for (const auto f : still.faces()) still.status(f).set_locked(true);
    PolyMeshD rough = still;
    smooth(mesh, 3);
    CHECK(mesh.normal(locked) == Vec3(1, 0, 0));
    CHECK(smooth(still, 3) == 0);
    smooth(rough, 0);
    for (const auto v : still.vertices()) CHECK(still.normal(v) == rough.normal(v));
}

TEST_CASE("smoothing before initialize throws, and so do options out of range") {
    PolyMeshD mesh = build<PolyMeshD>(support::divided_cube(1));
    AnisotropicNormalSmootherT<PolyMeshD> smoother(mesh);
    CHECK_THROWS_AS(smoother.smooth(1), std::logic_error);
    CHECK_THROWS_AS(smoother.initialize({.similarity_angle = -1}), OptionError);
    CHECK_THROWS_AS(smoother.initialize({.settled_angle = 0}), OptionError);
    CHECK_THROWS_AS(smoother.initialize({.rounds = -1}), OptionError);
    smoother.initialize();
    CHECK_THROWS_AS(smoother.smooth(-1), OptionError);
}

TEST_CASE("an empty mesh is settled") {
    PolyMesh mesh;
    CHECK(classify_features(mesh) == FeatureCounts{});
    CHECK(smooth_normals(mesh) == 0);
}
