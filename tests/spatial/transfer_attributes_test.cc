#include "hsdm/errors.hh"
#include "hsdm/mesh/to_mesh.hh"
#include "hsdm/mesh/vertex_normals.hh"
#include "hsdm/spatial/transfer_attributes.hh"
#include "support/meshes.hh"
#include "support/sample.hh"

#include <catch2/catch.hpp>
#include <tbb/global_control.h>

#include <cmath>
#include <limits>

using namespace hsdm;

namespace {

constexpr double no_number = std::numeric_limits<double>::quiet_NaN();

const VertexProperty& named(const PolygonMesh& mesh, const std::string& name) {
    for (const VertexProperty& property : mesh.properties)
        if (property.name == name) return property;
    throw std::runtime_error(name + " is missing");
}

/// n x n points of the plane z = 0 over [0, 1]^2 with a value of their place.
template <class Value>
PointCloud plane(int n, const Value& value) {
    PointCloud cloud;
    cloud.scalars = {{"value", {}, false}};
    for (int x = 0; x < n; ++x)
        for (int y = 0; y < n; ++y) {
            cloud.positions.emplace_back(x / (n - 1.0), y / (n - 1.0), 0);
            cloud.scalars[0].values.push_back(value(cloud.positions.back()));
        }
    return cloud;
}

/// Isolated vertices: what they get is the same with facets.
PolygonMesh vertices_at(std::vector<Vec3> places) {
    PolygonMesh mesh;
    mesh.positions = std::move(places);
    return mesh;
}

} // namespace

TEST_CASE("vertices get the values of the points about them", "[transfer]") {
    const auto wave = [](const Vec3& p) { return std::sin(3 * p[0]) + p[1] * p[1]; };
    const PointCloud cloud = plane(60, wave);
    support::Random random(2);
    std::vector<Vec3> places;
    for (int i = 0; i < 500; ++i)
        places.emplace_back(random.uniform(0.1, 0.9), random.uniform(0.1, 0.9), random.uniform(-0.01, 0.01));
    for (const int neighbors : {4, 8, 20}) {
        PolygonMesh mesh = vertices_at(places);
        const TransferCounts counts = transfer_attributes(cloud, mesh, {.neighbors = neighbors});
        CHECK(counts.vertices == 500);
        CHECK(counts.too_far == 0);
        CHECK(counts.properties == 1);
        double worst = 0;
        for (std::size_t v = 0; v < places.size(); ++v)
            worst = std::max(worst, std::abs(named(mesh, "value").values[v] - wave(places[v])));
        CHECK(worst < 0.05);
    }
    PolygonMesh mesh = vertices_at(cloud.positions); // with one neighbour, each has its own point's
    transfer_attributes(cloud, mesh, {.neighbors = 1});
    CHECK(named(mesh, "value").values == cloud.scalars[0].values);
}

TEST_CASE("transferred values change without steps from place to place", "[transfer]") {
    support::Random random(5);
    PointCloud cloud;
    cloud.scalars = {{"value", {}, false}};
    for (int i = 0; i < 200; ++i) {
        cloud.positions.emplace_back(random.uniform(), random.uniform(), random.uniform());
        cloud.scalars[0].values.push_back(random.uniform());
    }
    std::vector<Vec3> line;
    constexpr int steps = 20000;
    for (int i = 0; i <= steps; ++i) line.emplace_back(static_cast<double>(i) / steps, 0.5, 0.5);
    PolygonMesh mesh = vertices_at(line);
    transfer_attributes(cloud, mesh, {.neighbors = 6});
    const std::vector<double>& values = named(mesh, "value").values;
    double largest = 0, range = 0;
    for (std::size_t i = 1; i < values.size(); ++i) {
        largest = std::max(largest, std::abs(values[i] - values[i - 1]));
        range = std::max(range, std::abs(values[i] - values[0]));
    }
    CHECK(range > 0.1);
    CHECK(largest < 0.01 * range);
}

TEST_CASE("colours are rounded means, labels the majority, and what is no number has no part", "[transfer]") {
    PointCloud cloud;
    cloud.positions = {Vec3(-1, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 9)};
    cloud.colors = {{10, 0, 0, 255}, {21, 0, 1, 255}, {30, 4, 1, 255}, {0, 0, 0, 0}};
    cloud.scalars = {{"part", {7, 3, 7, 1}, true},
                     {"intensity", {1, no_number, 4, 100}, false},
                     {"void", {no_number, no_number, no_number, 5}, false},
                     {"hsdm_level", {1, 2, 3, 4}, false}};
    PolygonMesh mesh = vertices_at({Vec3(0, 0, 0)});
    const TransferCounts counts = transfer_attributes(cloud, mesh, {.neighbors = 3});
    CHECK(counts.properties == 7);
    CHECK(named(mesh, "red").values == std::vector<double>{20}); // 61 / 3
    CHECK(named(mesh, "red").type == VertexProperty::Type::uint8);
    CHECK(named(mesh, "blue").values == std::vector<double>{1});
    CHECK(named(mesh, "part").values == std::vector<double>{7});
    CHECK(named(mesh, "part").type == VertexProperty::Type::int32);
    CHECK(named(mesh, "intensity").values[0] == Approx(2.5));
    CHECK(std::isnan(named(mesh, "void").values[0]));
    PolygonMesh only = vertices_at({Vec3(0, 0, 0)});
    const TransferOptions three{.neighbors = 3, .colors = false, .missing_value = -9};
    CHECK(transfer_attributes(cloud, only, three).properties == 3);
    CHECK(named(only, "void").values[0] == -9);
    transfer_attributes(cloud, only);
    CHECK(named(only, "void").values[0] == 5); // of all four points
}

TEST_CASE("vertices farther than the largest distance get what is asked for and are counted", "[transfer]") {
    PointCloud cloud = plane(20, [](const Vec3&) { return 2.0; });
    cloud.colors.assign(cloud.size(), {1, 2, 3, 4});
    cloud.scalars.push_back({"part", std::vector<double>(cloud.size(), 6), true});
    cloud.normals.assign(cloud.size(), Vec3(0, 0, 2));
    PolygonMesh mesh = vertices_at({Vec3(0.5, 0.5, 0.01), Vec3(0.5, 0.5, 0.5), Vec3(0, 0, 0.25)});
    const TransferCounts counts = transfer_attributes(cloud, mesh,
                                                      {.max_distance = 0.25,
                                                       .normals = true,
                                                       .missing_value = -1,
                                                       .missing_label = -5,
                                                       .missing_color = {9, 8, 7, 6}});
    CHECK(counts.vertices == 3);
    CHECK(counts.too_far == 1); // the third is at exactly that distance
    CHECK(counts.normals == 2);
    CHECK(named(mesh, "value").values == std::vector<double>{2, -1, 2});
    CHECK(named(mesh, "part").values == std::vector<double>{6, -5, 6});
    CHECK(named(mesh, "green").values == std::vector<double>{2, 8, 2});
    CHECK(mesh.normals == std::vector<Vec3>{Vec3(0, 0, 1), Vec3(0, 0, 0), Vec3(0, 0, 1)});
    PolygonMesh coincident = vertices_at({cloud.positions[3], Vec3(0.5, 0.5, 0.01)});
    CHECK(transfer_attributes(cloud, coincident, {.max_distance = 0}).too_far == 1);
}

TEST_CASE("transferred normals are those of the surface; others stay", "[transfer]") {
    const PointCloud cloud = support::sample(support::sphere(1), {.points = 20000});
    PolygonMesh mesh = support::divided_cube(6);
    for (Vec3& p : mesh.positions) p.normalize();
    CHECK(transfer_attributes(cloud, mesh).normals == 0);
    CHECK(mesh.normals.empty());
    CHECK(transfer_attributes(cloud, mesh, {.normals = true}).normals == mesh.vertex_count());
    double worst = 1;
    for (std::size_t v = 0; v < mesh.vertex_count(); ++v)
        worst = std::min(worst, mesh.normals[v] | mesh.positions[v]);
    CHECK(worst > 0.999);

    PointCloud opposed;
    opposed.positions = {Vec3(1, 0, 0), Vec3(-1, 0, 0), Vec3(50, 0, 0), Vec3(51, 0, 0)};
    opposed.normals = {Vec3(0, 0, 1), Vec3(0, 0, -1), Vec3(0, 0, 0), Vec3(3e200, 0, 0)};
    PolygonMesh between = vertices_at({Vec3(0, 0, 0), Vec3(50, 0, 0)});
    between.normals = {Vec3(0, 1, 0), Vec3(0, 1, 0)};
    CHECK(transfer_attributes(opposed, between, {.neighbors = 2, .normals = true}).normals == 1);
    CHECK(between.normals == std::vector<Vec3>{Vec3(0, 1, 0), Vec3(1, 0, 0)});
}

TEST_CASE("an OpenMesh mesh gets the same properties, but for its deleted vertices", "[transfer]") {
    PointCloud cloud = support::sample(support::box({2, 2, 2}), {.points = 5000});
    cloud.scalars = {{"height", {}, false}, {"side", {}, true}};
    for (const Vec3& p : cloud.positions) {
        cloud.scalars[0].values.push_back(p[2]);
        cloud.scalars[1].values.push_back(p[0] > 0 ? 3 : -2);
    }
    cloud.colors.assign(cloud.size(), {40, 50, 60, 255});
    PolygonMesh polygons = support::divided_cube(4);
    PolyMesh mesh;
    to_mesh(polygons, mesh);
    OpenMesh::VProp<std::int32_t>(mesh, "height"); // of another type
    const TransferCounts counts = transfer_attributes(cloud, mesh, {.normals = true});
    CHECK(transfer_attributes(cloud, polygons, {.normals = true}).properties == counts.properties);
    const PolygonMesh result = to_polygons(mesh);
    for (const VertexProperty& expected : polygons.properties) {
        CHECK(named(result, expected.name).type == expected.type);
        CHECK(named(result, expected.name).values == expected.values);
    }
    CHECK(result.properties.size() == polygons.properties.size());
    CHECK(result.normals == polygons.normals);
    CHECK(mesh.property(kept_vertex_property<double>(mesh, "height").getRawProperty()).persistent());

    mesh.set_point(OpenMesh::VertexHandle(3), Vec3(no_number, no_number, no_number));
    CHECK_THROWS_AS(transfer_attributes(cloud, mesh), Error);
    mesh.delete_vertex(OpenMesh::VertexHandle(3), false);
    CHECK(transfer_attributes(cloud, mesh).vertices == counts.vertices - 1);
}

TEST_CASE("attributes transferred once are replaced, others stay, on any number of threads", "[transfer]") {
    const PointCloud cloud = plane(40, [](const Vec3& p) { return p[0] * 1e3 + p[1]; });
    PolygonMesh mesh = support::divided_cube(20);
    mesh.properties = {{"value", VertexProperty::Type::uint8, std::vector<double>(mesh.vertex_count(), 1)},
                       {"other", VertexProperty::Type::uint8, std::vector<double>(mesh.vertex_count(), 2)}};
    transfer_attributes(cloud, mesh);
    CHECK(mesh.properties.size() == 2);
    CHECK(named(mesh, "value").type == VertexProperty::Type::float64);
    CHECK(named(mesh, "other").values[0] == 2);
    const std::vector<double> values = named(mesh, "value").values;
    const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
    transfer_attributes(cloud, mesh);
    CHECK(named(mesh, "value").values == values);
}

TEST_CASE("a transfer's options and inputs are checked", "[transfer]") {
    PointCloud cloud = plane(3, [](const Vec3&) { return 1.0; });
    PolygonMesh mesh = support::unit_cube();
    CHECK_THROWS_AS(transfer_attributes(cloud, mesh, {.neighbors = 0}), OptionError);
    CHECK_THROWS_AS(transfer_attributes(cloud, mesh, {.max_distance = -1}), OptionError);
    CHECK_THROWS_AS(transfer_attributes(cloud, mesh, {.max_distance = no_number}), OptionError);
    CHECK_THROWS_AS(transfer_attributes(PointCloud(), mesh), Error);
    cloud.scalars[0].values.pop_back();
    CHECK_THROWS_AS(transfer_attributes(cloud, mesh), Error);
    CHECK(mesh.properties.empty());
    cloud.scalars.clear();
    PolygonMesh empty;
    CHECK(transfer_attributes(cloud, empty).vertices == 0);
    CHECK(transfer_attributes(cloud, mesh, {.neighbors = std::numeric_limits<int>::max()}).properties == 0);
}
