#include "features/meshes.hh"
#include "hsdm/errors.hh"
#include "hsdm/features/FeatureClassifierT.hh"
#include "hsdm/features/features.hh"
#include "hsdm/mesh/to_mesh.hh"

#include <OpenMesh/Core/IO/MeshIO.hh>
#include <catch2/catch.hpp>
#include <tbb/global_control.h>

#include <sstream>

using namespace hsdm;
using namespace hsdm::test;
using OpenMesh::VertexHandle;

namespace {

template <class Mesh>
FeatureCounts classify(Mesh& mesh, const FeatureOptions& options = {}) {
    FeatureClassifierT<Mesh> classifier(mesh);
    classifier.initialize(options);
    return classifier.classify();
}

template <class Mesh>
auto class_of(Mesh& mesh) {
    return OpenMesh::getProperty<VertexHandle, std::uint8_t>(mesh, "hsdm_vertex_class");
}
template <class Mesh>
auto count_of(Mesh& mesh) {
    return OpenMesh::getProperty<VertexHandle, std::uint8_t>(mesh, "hsdm_normal_count");
}
template <class Mesh>
auto normals_of(Mesh& mesh) {
    return OpenMesh::getProperty<VertexHandle, VertexNormalsT<Mesh>>(mesh, "hsdm_normals");
}

} // namespace

#define EVERY_KIND_OF_MESH PolyMeshF, PolyMeshD, TriMeshF, TriMeshD

TEMPLATE_TEST_CASE("a cube has twelve sharp edges, eight corners and flat sides", "", EVERY_KIND_OF_MESH) {
    constexpr Index n = 4;
    TestType mesh = build<TestType>(support::divided_cube(n));
    const FeatureCounts counts = classify(mesh);
    CHECK(counts.sharp_edges == 12 * n);
    CHECK(counts.corner_vertices == 8);
    CHECK(counts.edge_vertices == 12 * (n - 1));
    CHECK(counts.smooth_vertices == 6 * (n - 1) * (n - 1));
    auto classes = class_of(mesh);
    auto number = count_of(mesh);
    auto normals = normals_of(mesh);
    for (const auto v : mesh.vertices()) {
        const auto p = mesh.point(v);
        int sides = 0;
        for (std::size_t i = 0; i < 3; ++i) sides += std::abs(p[i]) == 1;
        REQUIRE(sides == number[v]);
        CHECK(classes[v] == sides - 1);
        CHECK(mesh.status(v).feature() == (sides > 1));
        for (int k = 0; k < sides; ++k) { // each normal is that of a side the vertex lies on
            const auto normal = normals[v][static_cast<std::size_t>(k)];
            CHECK(normal.norm() == Approx(1));
            CHECK(normal.max_abs() == Approx(1));
            CHECK((normal | p) == Approx(1));
        }
        for (std::size_t k = static_cast<std::size_t>(sides); k < 3; ++k) CHECK(normals[v][k].norm() == 0);
    }
    for (const auto e : mesh.edges()) {
        const auto middle = mesh.calc_edge_midpoint(e);
        int sides = 0;
        for (std::size_t i = 0; i < 3; ++i) sides += std::abs(middle[i]) == 1;
        CHECK(mesh.status(e).feature() == (sides == 2));
    }
}

TEMPLATE_TEST_CASE("a cylinder's rims are sharp and without corners", "", EVERY_KIND_OF_MESH) {
    TestType mesh = build<TestType>(capped_cylinder(40, 5));
    const FeatureCounts counts = classify(mesh);
    CHECK(counts.sharp_edges == 80);
    CHECK(counts.edge_vertices == 80);
    CHECK(counts.corner_vertices == 0);
    auto number = count_of(mesh);
    auto normals = normals_of(mesh);
    for (const auto v : mesh.vertices()) {
        const auto p = mesh.point(v);
        const bool is_rim = std::abs(p[2]) == 1 && std::hypot(p[0], p[1]) > 0.5;
        REQUIRE(number[v] == (is_rim ? 2 : 1));
        for (int k = 0; is_rim && k < 2; ++k) {
            const auto normal = normals[v][static_cast<std::size_t>(k)];
            const bool up = std::abs(normal[2]) > 0.5;
            CHECK((up ? normal[2] * p[2] : normal[0] * p[0] + normal[1] * p[1]) == Approx(1).margin(0.01));
        }
    }
}

TEMPLATE_TEST_CASE("a sphere has no features", "", EVERY_KIND_OF_MESH) {
    TestType mesh = build<TestType>(sphere(12));
    const FeatureCounts counts = classify(mesh);
    CHECK(counts.sharp_edges == 0);
    CHECK(counts.smooth_vertices == mesh.n_vertices());
}

TEST_CASE("the crease angle is the limit: edges just below are smooth, just above sharp") {
    constexpr double angle = 0.5;
    PolyMeshD mesh =
        build<PolyMeshD>(sheet(4, [](Index x, Index) { return x > 2 ? (x - 2) * std::tan(angle) : 0.0; }));
    CHECK(classify(mesh, {.crease_angle = angle + 1e-6}).sharp_edges == 0);
    CHECK(classify(mesh, {.crease_angle = angle - 1e-6}).sharp_edges == 4);
    // And back: a second run takes back what the first one marked.
    CHECK(classify(mesh, {.crease_angle = angle + 1e-6}).edge_vertices == 0);
    for (const auto v : mesh.vertices()) CHECK_FALSE(mesh.status(v).feature());
}

TEST_CASE("a scan's noise is not taken for creases unless the plain dihedral test is asked for") {
    constexpr Index n = 24;
    constexpr double edge = 2.0 / n;
    const PolygonMesh rough = noisy(support::divided_cube(n), 0.15 * edge);
    PolyMesh confirmed = to_mesh(rough).mesh, plain = confirmed;
    const std::size_t found = classify_features(confirmed).sharp_edges;
    CHECK(found >= 12 * n);
    CHECK(found <= 12 * n + 6);
    CHECK(classify_features(plain, {.confirmation_rounds = 0}).sharp_edges > 18 * n);
}

TEST_CASE("a crease just above the limit is confirmed") {
    for (const double degrees : {35.5, 40.0, 50.0, 80.0}) {
        const double slope = std::tan(degrees * M_PI / 180);
        PolyMesh mesh =
            to_mesh(sheet(16, [&](Index x, Index) { return x > 8 ? slope * (x - 8.0) : 0.0; })).mesh;
        CHECK(classify_features(mesh).sharp_edges == 16);
    }
}

TEST_CASE("narrow facets along the rim of a huge side keep their crease") {
    PolygonMesh fold = sheet(6, [](Index x, Index) { return x > 3 ? 1e4 * (x - 3.0) : 0.0; });
    for (Vec3& p : fold.positions) p[0] = std::min(p[0], 3.0);
    PolyMesh mesh = to_mesh(fold).mesh;
    CHECK(classify_features(mesh).sharp_edges == 6);
}

TEST_CASE("boundary edges are not sharp; a crease that runs into the boundary ends in an edge vertex") {
    PolyMeshD mesh = build<PolyMeshD>(sheet(4, [](Index x, Index) { return x > 2 ? x - 2.0 : 0.0; }));
    const FeatureCounts counts = classify(mesh);
    CHECK(counts.sharp_edges == 4);
    CHECK(counts.edge_vertices == 5);
    CHECK(counts.corner_vertices == 0);
    for (const auto e : mesh.edges())
        if (mesh.is_boundary(e)) CHECK_FALSE(mesh.status(e).feature());
    auto number = count_of(mesh);
    for (const auto v : mesh.vertices()) CHECK(number[v] == (mesh.point(v)[0] == 2 ? 2 : 1));
}

TEST_CASE("a crease that fades out ends in an edge vertex with one normal") {
    // A fold along x = 3 that grows flatter with y.
    PolyMeshD mesh = build<PolyMeshD>(
        sheet(6, [](Index x, Index y) { return x > 3 ? (x - 3.0) * std::max(0.0, 2.0 - 0.6 * y) : 0.0; }));
    const FeatureCounts counts = classify(mesh);
    REQUIRE(counts.sharp_edges > 0);
    auto classes = class_of(mesh);
    auto number = count_of(mesh);
    int ends = 0;
    for (const auto v : mesh.vertices()) {
        int sharp = 0;
        for (const auto e : mesh.ve_range(v)) sharp += mesh.status(e).feature();
        if (sharp != 1 || mesh.is_boundary(v)) continue;
        ++ends;
        CHECK(classes[v] == 1);
        CHECK(number[v] == 1);
    }
    CHECK(ends == 1);
}

TEST_CASE("two sharp edges that turn strongly make a corner, a gentle turn makes an edge vertex") {
    PolyMeshD mesh = build<PolyMeshD>(sheet(6, [](Index, Index) { return 0.0; }));
    // Edges marked by hand and locked: an L with its bend in (3, 3).
    const VertexHandle bend(3 * 7 + 3);
    for (const auto e : mesh.edges()) {
        const auto a = mesh.point(e.v0()), b = mesh.point(e.v1());
        const bool upright = a[0] == 3 && b[0] == 3 && std::min(a[1], b[1]) >= 3;
        const bool level = a[1] == 3 && b[1] == 3 && std::min(a[0], b[0]) >= 3;
        if (!upright && !level) continue;
        mesh.status(e).set_feature(true);
        mesh.status(e).set_locked(true);
    }
    const FeatureCounts counts = classify(mesh);
    CHECK(counts.sharp_edges == 6);
    CHECK(counts.corner_vertices == 1);
    CHECK(class_of(mesh)[bend] == 2);
    CHECK(count_of(mesh)[bend] == 2);
    CHECK(classify(mesh, {.corner_angle = 1.6}).corner_vertices == 0);
    CHECK(class_of(mesh)[bend] == 1);
}

TEST_CASE("locked edges and vertices keep their feature bits") {
    PolyMeshD mesh = build<PolyMeshD>(support::divided_cube(2));
    OpenMesh::EdgeHandle sharp;
    for (const auto e : mesh.edges())
        if (mesh.calc_edge_midpoint(e) == Vec3(1, 1, 0.5)) sharp = e;
    REQUIRE(sharp.is_valid());
    mesh.status(sharp).set_locked(true);
    mesh.status(VertexHandle(0)).set_locked(true);
    const FeatureCounts counts = classify(mesh);
    CHECK(counts.sharp_edges == 23);
    CHECK_FALSE(mesh.status(sharp).feature());
    CHECK_FALSE(mesh.status(VertexHandle(0)).feature());
}

TEST_CASE("a vertex with more than three sectors keeps the three widest") {
    // Five creases from a tip, the sectors 100, 95, 90, 45 and 30 degrees wide.
    PolygonMesh star;
    star.positions.emplace_back(0, 0, 2);
    for (const double degrees : {0, 100, 195, 285, 330})
        star.positions.emplace_back(std::cos(degrees * M_PI / 180), std::sin(degrees * M_PI / 180), 0);
    for (Index i = 0; i < 5; ++i) star.add_facet(std::vector<Index>{0, 1 + i, 1 + (i + 1) % 5});
    PolyMeshD mesh = build<PolyMeshD>(star);
    CHECK(classify(mesh, {.crease_angle = 0.1}).corner_vertices == 1);
    CHECK(count_of(mesh)[VertexHandle(0)] == 3);
    const auto normals = normals_of(mesh)[VertexHandle(0)];
    for (int k = 0; k < 3; ++k)
        CHECK((normals[static_cast<std::size_t>(k)] - mesh.calc_face_normal(OpenMesh::FaceHandle(k))).norm()
              < 1e-12);
}

TEST_CASE("facets without area neither are sharp nor lend a normal") {
    PolygonMesh flat = sheet(2, [](Index, Index) { return 0.0; });
    flat.positions[4] = flat.positions[3]; // two quads fold to triangles
    flat.positions[5] = flat.positions[3];
    PolyMeshD mesh = build<PolyMeshD>(flat);
    CHECK(classify(mesh).sharp_edges == 0);
    for (const auto v : mesh.vertices())
        for (const auto& normal : normals_of(mesh)[v]) CHECK(std::isfinite(normal[2]));
}

TEST_CASE("a cube far from the origin keeps its features") {
    PolygonMesh far = support::divided_cube(3);
    for (Vec3& p : far.positions) p = 1e-3 * p + Vec3(1e7, -1e7, 1e7);
    PolyMeshD mesh = build<PolyMeshD>(far);
    CHECK(classify(mesh).sharp_edges == 36);
}

TEST_CASE("a run before initialize throws, and so does an angle out of range") {
    PolyMeshD mesh = build<PolyMeshD>(support::divided_cube(1));
    FeatureClassifierT<PolyMeshD> classifier(mesh);
    CHECK_THROWS_AS(classifier.classify(), std::logic_error);
    CHECK_THROWS_AS(classifier.initialize({.crease_angle = 0}), OptionError);
    CHECK_THROWS_AS(classifier.initialize({.crease_angle = 3.2}), OptionError);
    CHECK_THROWS_AS(classifier.initialize({.corner_angle = std::nan("")}), OptionError);
    CHECK_THROWS_AS(classifier.initialize({.confirmation_rounds = -1}), OptionError);
    CHECK_THROWS_AS(classifier.classify(), std::logic_error);
}

TEST_CASE("a bow-tie vertex, where fans meet without an edge, has a normal per fan") {
    PolyMeshD mesh;
    mesh.request_edge_status();
    const auto v = mesh.add_vertex({0, 0, 0});
    mesh.add_face(v, mesh.add_vertex({1, 0, 0}), mesh.add_vertex({1, 1, 0}));
    mesh.add_face(v, mesh.add_vertex({-1, 0, 0}), mesh.add_vertex({-1, 0, 1}));
    classify(mesh);
    CHECK(class_of(mesh)[v] == 0);
    CHECK(count_of(mesh)[v] == 2);
}

TEST_CASE("attributes the mesh does not have are requested and released") {
    PolyMeshD mesh;
    mesh.add_face(mesh.add_vertex({0, 0, 0}), mesh.add_vertex({1, 0, 0}), mesh.add_vertex({0, 1, 0}));
    {
        FeatureClassifierT<PolyMeshD> classifier(mesh);
        classifier.initialize();
        classifier.classify();
        CHECK(mesh.has_edge_status());
    }
    CHECK_FALSE(mesh.has_vertex_status());
    CHECK_FALSE(mesh.has_edge_status());
    CHECK_FALSE(mesh.has_face_status());
    CHECK(OpenMesh::hasProperty<VertexHandle, std::uint8_t>(mesh, "hsdm_vertex_class"));
}

TEST_CASE("deleted elements and isolated vertices are not counted") {
    PolyMeshD mesh = build<PolyMeshD>(support::divided_cube(1));
    mesh.add_vertex({5, 5, 5});
    mesh.delete_face(OpenMesh::FaceHandle(0), false);
    const FeatureCounts counts = classify(mesh);
    CHECK(counts.sharp_edges == 8);
    CHECK(counts.edge_vertices + counts.corner_vertices + counts.smooth_vertices == 8);
}

TEST_CASE("the classes do not depend on the number of threads") {
    PolyMesh one = to_mesh(noisy(support::divided_cube(40), 0.004)).mesh, two = one;
    FeatureCounts first;
    {
        const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, 1);
        first = classify_features(one);
    }
    CHECK(classify_features(two) == first);
    CHECK(feature_lines(one) == feature_lines(two));
}

TEST_CASE("feature lines name every sharp edge and corner and read back to the same bits") {
    PolygonMesh polygons = support::divided_cube(1);
    for (Vec3& p : polygons.positions) p = Vec3(p[0] / 3, p[1] * 0.1, p[2] * 1e-9);
    PolyMesh mesh = to_mesh(polygons).mesh;
    CHECK(feature_lines(mesh).empty());
    classify_features(mesh);
    std::istringstream lines(feature_lines(mesh));
    int segments = 0, corners = 0;
    for (std::string line; std::getline(lines, line);) {
        const bool is_corner = line.front() == 'c';
        std::istringstream numbers(is_corner ? line.substr(1) : line);
        std::vector<double> values;
        for (double x; numbers >> x;) values.push_back(x);
        REQUIRE(values.size() == (is_corner ? 3 : 6));
        for (std::size_t i = 0; i < values.size(); i += 3) {
            const Vec3 p(values[i], values[i + 1], values[i + 2]);
            CHECK(std::find(polygons.positions.begin(), polygons.positions.end(), p)
                  != polygons.positions.end());
        }
        ++(is_corner ? corners : segments);
    }
    CHECK(segments == 12);
    CHECK(corners == 8);
}

TEST_CASE("classes, normals and feature bits are kept in .om files") {
    PolyMesh mesh = to_mesh(support::divided_cube(2)).mesh;
    classify_features(mesh);
    std::stringstream file;
    OpenMesh::IO::Options options = OpenMesh::IO::Options::Binary;
    options += OpenMesh::IO::Options::Status;
    omlog().disable(); // the writer reports its size
    REQUIRE(OpenMesh::IO::write_mesh(mesh, file, ".om", options));
    omlog().enable();
    PolyMesh read;
    kept_vertex_property<VertexNormalsT<PolyMesh>>(read, vertex_normals_property);
    kept_vertex_property<std::uint8_t>(read, vertex_class_property);
    REQUIRE(OpenMesh::IO::read_mesh(read, file, ".om", options));
    for (const auto v : mesh.vertices()) {
        CHECK(normals_of(read)[v] == normals_of(mesh)[v]);
        CHECK(class_of(read)[v] == class_of(mesh)[v]);
        CHECK(read.status(v).feature() == mesh.status(v).feature());
    }
}

TEST_CASE("hints overrule the dihedral test, except at locked edges, and leave no locks") {
    const PolygonMesh shape = support::divided_cube(2);
    const auto hinted = [&](EdgeHint hint) { return FeatureHints{{shape.corners.size(), hint}}; };
    PolyMesh mesh = to_mesh(shape).mesh;
    const std::size_t by_angle = classify_features(mesh).sharp_edges;
    CHECK(by_angle == 24);
    CHECK(classify_features(mesh, {}, hinted(EdgeHint::none)).sharp_edges == by_angle);
    CHECK(classify_features(mesh, {}, hinted(EdgeHint::sharp)).sharp_edges == mesh.n_edges());
    CHECK(classify_features(mesh, {}, hinted(EdgeHint::smooth)).sharp_edges == 0);
    for (const auto e : mesh.edges()) CHECK(!mesh.status(e).locked());

    const OpenMesh::EdgeHandle mine(0);
    mesh.status(mine).set_feature(true);
    mesh.status(mine).set_locked(true);
    CHECK(classify_features(mesh, {}, hinted(EdgeHint::smooth)).sharp_edges == 1);
    CHECK(mesh.status(mine).locked());
}

TEST_CASE("a hint is for the side of the facet it is listed at, and hints of another mesh are refused") {
    const PolygonMesh shape = support::divided_cube(3);
    PolyMesh mesh = to_mesh(shape).mesh;
    for (const std::size_t side : {std::size_t{0}, std::size_t{17}, shape.corners.size() - 1}) {
        FeatureHints hints{{shape.corners.size(), EdgeHint::smooth}};
        const std::size_t facet = side / 4;
        const Index a = shape.corners[side], b = shape.facet(facet)[(side + 1) % 4];
        hints.sides[side] = EdgeHint::sharp;
        for (std::size_t c = 0; c < shape.corners.size(); ++c) // the twin says the same
            if (shape.corners[c] == b && shape.facet(c / 4)[(c + 1) % 4] == a)
                hints.sides[c] = EdgeHint::sharp;
        CHECK(classify_features(mesh, {}, hints).sharp_edges == 1);
        const auto h = mesh.find_halfedge(OpenMesh::SmartVertexHandle(static_cast<int>(a), &mesh),
                                          OpenMesh::SmartVertexHandle(static_cast<int>(b), &mesh));
        REQUIRE(h.is_valid());
        CHECK(mesh.status(mesh.edge_handle(h)).feature());
    }
    CHECK_THROWS_AS(classify_features(mesh, {}, FeatureHints{{5, EdgeHint::sharp}}), Error);
}

TEST_CASE("edges are confirmed as if all facets were smoothed, not only those near them") {
    FeatureOptions options;
    std::size_t confirmed = 0, refused = 0;
    for (const double slope : {0.3, 0.45, 0.6, 1.0})
        for (int rounds = 1; rounds <= 4; ++rounds) {
            options.confirmation_rounds = rounds;
            PolyMeshD mesh = build<PolyMeshD>(
                noisy(sheet(14, [&](Index x, Index) { return slope * std::abs(x - 7.0); }), 0.12));
            std::vector<double> weights;
            std::vector<Vec3> normals;
            for (const Vec3& area : facet_area_vectors(mesh)) {
                weights.push_back(area.norm());
                normals.push_back(unit_or_zero(area));
            }
            std::vector<Vec3> smoothed = normals;
            const FacetNeighbours neighbours = facet_neighbours(mesh, StatusBits::ignore);
            for (int round = 0; round < rounds; ++round)
                filter_normals(neighbours, weights, detail::confirming_similarity * options.crease_angle, 0,
                               smoothed);
            FeatureClassifierT<PolyMeshD> classifier(mesh);
            classifier.initialize(options);
            classifier.classify();
            const double candidate = std::cos(options.crease_angle);
            const double sure = std::cos(detail::confirmed_share * options.crease_angle);
            for (const auto e : mesh.edges()) {
                const bool expected =
                    detail::exceeds(mesh, e, normals, candidate) && detail::exceeds(mesh, e, smoothed, sure);
                CHECK(mesh.status(e).feature() == expected);
                confirmed += expected;
                refused += detail::exceeds(mesh, e, normals, candidate) && !expected;
            }
        }
    CHECK(confirmed > 20);
    CHECK(refused > 20);
}
