// Clouds of any size, in any order, with anything in them.
#include "hsdm/errors.hh"
#include "hsdm/mesh/to_mesh.hh"
#include "hsdm/reconstruct.hh"
#include "support/check.hh"
#include "support/sample.hh"

#include <catch2/catch.hpp>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

using namespace hsdm;

namespace {

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

PointCloud step_cloud(std::size_t points) {
    return support::sample(support::hollow_step(0.4, 0.5), {.points = points});
}

PointCloud scaled(PointCloud cloud, double factor) {
    for (Vec3& p : cloud.positions) p *= factor;
    return cloud;
}

template <class T>
void reorder(std::vector<T>& values, const std::vector<std::size_t>& order) {
    std::vector<T> result;
    for (std::size_t i : order)
        if (i < values.size()) result.push_back(values[i]);
    values = result;
}

PointCloud shuffled(PointCloud cloud, std::uint64_t seed) {
    std::vector<std::size_t> order(cloud.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    support::Random random(seed);
    for (std::size_t i = order.size(); i-- > 1;)
        std::swap(order[i],
                  order[static_cast<std::size_t>(random.uniform(0, 1) * static_cast<double>(i + 1))]);
    reorder(cloud.positions, order);
    reorder(cloud.normals, order);
    reorder(cloud.colors, order);
    for (Scalar& scalar : cloud.scalars) reorder(scalar.values, order);
    return cloud;
}

/// Corners and bits of the coordinates and properties.
bool same_bits(const PolygonMesh& a, const PolygonMesh& b) {
    const auto same = [](const std::vector<double>& x, const std::vector<double>& y) {
        return x.size() == y.size() && std::equal(x.begin(), x.end(), y.begin(), [](double p, double q) {
                   return (p == q && std::signbit(p) == std::signbit(q)) || (std::isnan(p) && std::isnan(q));
               });
    };
    if (a.corners != b.corners || a.first != b.first || a.positions != b.positions
        || a.properties.size() != b.properties.size())
        return false;
    for (std::size_t k = 0; k < a.properties.size(); ++k)
        if (!same(a.properties[k].values, b.properties[k].values)) return false;
    return true;
}

void check_scaled(int exponent, const std::string& way) {
    const PointCloud cloud = step_cloud(3000);
    const double factor = std::ldexp(1.0, exponent);
    CAPTURE(exponent, way);
    ReconstructOptions options, times;
    if (way == "depth") options.depth = 4;
    if (way == "voxel") options.voxel_size = 0.2;
    if (way == "bound") options.max_error = MaxError{0.02, false};
    if (way == "estimated") options.normals = NormalSource::estimate;
    if (way == "basic") options.method = Method::basic;
    PointCloud one = cloud;
    if (way == "far")
        for (Vec3& p : one.positions) p += Vec3(1e5, -3e5, 7);
    times = options;
    if (times.voxel_size) *times.voxel_size *= factor;
    if (times.max_error) times.max_error->value *= factor;

    const Reconstruction plain = reconstruct(one, options);
    const Reconstruction extreme = reconstruct(scaled(one, factor), times);
    PolygonMesh expected = to_polygons(plain.mesh);
    for (Vec3& p : expected.positions) p *= factor;
    CHECK(same_bits(to_polygons(extreme.mesh), expected));
    CHECK(extreme.report.input.spacing == plain.report.input.spacing * factor);
    CHECK(extreme.report.grid.voxel_size == plain.report.grid.voxel_size * factor);
    CHECK(extreme.report.grid.max_error == plain.report.grid.max_error * factor);
    CHECK(extreme.report.error.points_to_mesh_max == plain.report.error.points_to_mesh_max * factor);
    CHECK(extreme.report.error.normalised_max == plain.report.error.normalised_max);
    CHECK(extreme.report.input.bbox.hi == plain.report.input.bbox.hi * factor);
    CHECK(extreme.report.features.sharp_edges == plain.report.features.sharp_edges);
}

} // namespace

TEST_CASE("a cloud times a power of two gives the same bits times that", "[pipeline]") {
    const int exponent = GENERATE(-1000, 31);
    check_scaled(exponent,
                 GENERATE(as<std::string>{}, "depth", "voxel", "bound", "estimated", "basic", "far"));
}

TEST_CASE("a cloud times any power of two gives the same bits times that", "[pipeline][slow]") {
    const int exponent = GENERATE(-510, -130, -40, -31, -30, -3, 29, 64, 130, 510, 1000);
    check_scaled(exponent,
                 GENERATE(as<std::string>{}, "depth", "voxel", "bound", "estimated", "basic", "far"));
}

TEST_CASE("a cloud at the ends of double precision is refused with what to do", "[pipeline]") {
    CHECK_THROWS_AS(reconstruct(scaled(step_cloud(500), std::ldexp(1.0, -1060))), Error);
    CHECK_THROWS_AS(reconstruct(scaled(step_cloud(500), std::ldexp(1.0, 1022))), Error);
}

TEST_CASE("normals that are no numbers and zeros of either sign leave no trace of the order", "[pipeline]") {
    PointCloud cloud = step_cloud(2000);
    const std::size_t count = cloud.size();
    support::Random random(4);
    for (std::size_t i = 0; i < count; i += 3) { // the same places again, with and without a direction
        cloud.positions.push_back(cloud.positions[i]);
        cloud.normals.push_back(i % 2 ? Vec3(not_a_number, random.uniform(-1, 1), 0)
                                      : Vec3(0, -0.0, random.uniform(0, 1) < 0.5 ? not_a_number : 0.0));
        cloud.positions.push_back(cloud.positions[i]);
        cloud.normals.push_back(Vec3(random.uniform(-1, 1), random.uniform(-1, 1), not_a_number));
    }
    for (double zero : {0.0, -0.0}) {
        cloud.positions.emplace_back(zero, -zero, 0.5);
        cloud.normals.emplace_back(zero, zero, 1);
    }
    const PolygonMesh expected = to_polygons(reconstruct(cloud).mesh);
    for (std::uint64_t seed = 1; seed <= 3; ++seed)
        CHECK(same_bits(to_polygons(reconstruct(shuffled(cloud, seed)).mesh), expected));
}

TEST_CASE("of equal points with different colours, labels and values none is preferred", "[pipeline]") {
    PointCloud cloud = step_cloud(2000);
    const std::size_t count = cloud.size();
    for (int copy = 0; copy < 3; ++copy)
        for (std::size_t i = 0; i < count; ++i) {
            cloud.positions.push_back(cloud.positions[i]);
            cloud.normals.push_back(cloud.normals[i]);
        }
    support::Random random(9);
    Scalar value{"value", {}, false}, label{"label", {}, true};
    for (std::size_t i = 0; i < cloud.size(); ++i) {
        const auto channel = [&] { return static_cast<std::uint8_t>(random.uniform(0, 255)); };
        cloud.colors.push_back({channel(), channel(), channel(), 255});
        value.values.push_back(random.uniform(0, 1) < 0.1 ? not_a_number : random.uniform(-1e9, 1e9));
        label.values.push_back(std::floor(random.uniform(0, 5)));
    }
    cloud.scalars = {value, label};
    const Reconstruction first = reconstruct(cloud);
    CHECK(first.report.input.merged_duplicates == 3 * count);
    for (std::uint64_t seed = 1; seed <= 3; ++seed)
        CHECK(same_bits(to_polygons(reconstruct(shuffled(cloud, seed)).mesh), to_polygons(first.mesh)));
}

TEST_CASE("a value of equal points is their mean, a label the majority's", "[pipeline]") {
    PointCloud cloud = step_cloud(2000);
    const std::size_t count = cloud.size();
    Scalar value{"value", std::vector<double>(count, 1), false},
        label{"label", std::vector<double>(count, 7), true};
    for (int copy = 0; copy < 2; ++copy)
        for (std::size_t i = 0; i < count; ++i) {
            cloud.positions.push_back(cloud.positions[i]);
            cloud.normals.push_back(cloud.normals[i]);
            value.values.push_back(4);
            label.values.push_back(3);
        }
    cloud.scalars = {value, label};
    for (const VertexProperty& property : to_polygons(reconstruct(cloud).mesh).properties) {
        const double expected = property.name == "value" ? 3 : property.name == "label" ? 3 : not_a_number;
        if (std::isnan(expected)) continue;
        INFO(property.name);
        CHECK(std::all_of(property.values.begin(), property.values.end(),
                          [&](double x) { return x == expected; }));
    }
}

TEST_CASE("a dense part far away is reconstructed too", "[pipeline]") {
    const double apart = GENERATE(1e4, 1e7);
    PointCloud cloud = step_cloud(20000);
    const PointCloud near = cloud, far = step_cloud(2000);
    for (std::size_t i = 0; i < far.size(); ++i) {
        cloud.positions.push_back(0.4 * far.positions[i] + Vec3(apart, -apart / 2, 3));
        cloud.normals.push_back(far.normals[i]);
    }
    ReconstructOptions options;
    SECTION("by its spacing") {}
    SECTION("by depth") {
        options.depth = 7;
    }
    SECTION("by a voxel") {
        options.voxel_size = 0.05;
    }
    SECTION("by a bound") {
        options.max_error = MaxError{0.01, false};
    }
    const Reconstruction result = reconstruct(cloud, options);
    const PolygonMesh mesh = to_polygons(result.mesh);
    INFO(apart << " apart: " << result.report.options.at("resolution"));
    for (const Report::Dropped& d : result.report.dropped)
        UNSCOPED_INFO(d.count << ' ' << d.what << ' ' << d.where);
    CHECK(support::faults(mesh) == "");
    CHECK(result.report.mesh.closed);
    CHECK(result.report.mesh.components == 2);
    CHECK(result.report.dropped.empty());
    CHECK(result.report.error.points_to_mesh_max < 0.1);
    CHECK(result.report.input.bbox.hi[0] > apart);
    CHECK(std::any_of(mesh.positions.begin(), mesh.positions.end(),
                      [&](const Vec3& p) { return std::abs(p[0] - apart) < 1; }));
}

TEST_CASE("one garbage coordinate of any size costs the others no digit", "[pipeline]") {
    const double garbage = GENERATE(1e7, 3.4e38, -1e200, 1.7e308);
    PointCloud cloud = step_cloud(5000);
    const PolygonMesh expected = to_polygons(reconstruct(cloud).mesh);
    cloud.positions.emplace_back(garbage, 1, -garbage);
    cloud.normals.emplace_back(0, 0, 1);
    const Reconstruction result = reconstruct(cloud);
    CHECK(same_bits(to_polygons(result.mesh), expected));
    REQUIRE(result.report.dropped.size() == 1);
    CHECK(result.report.dropped[0].where[0] == garbage);
}

TEST_CASE("what is dropped is told with its number and a place", "[pipeline]") {
    PointCloud cloud = step_cloud(20000);
    const Vec3 garbage(1e6, 2e6, -3e6);
    for (int i = 0; i < 5; ++i) {
        cloud.positions.push_back(garbage + Vec3(i * 1e5, 0, 0));
        cloud.normals.emplace_back(1, 0, 0);
    }
    const Report report = reconstruct(cloud).report;
    REQUIRE(report.dropped.size() == 1);
    CHECK(report.dropped[0].count == 5);
    CHECK(report.dropped[0].where[1] == garbage[1]);
}

TEST_CASE("points of a part too small for its voxels are told", "[pipeline]") {
    PointCloud cloud = step_cloud(20000);
    const PointCloud part = step_cloud(400);
    const Vec3 place(4, 4, 4);
    for (std::size_t i = 0; i < part.size(); ++i) {
        cloud.positions.push_back(0.01 * part.positions[i] + place);
        cloud.normals.push_back(part.normals[i]);
    }
    const Report report =
        reconstruct(cloud, {.depth = 5, .method = GENERATE(Method::basic, Method::extended)}).report;
    const auto told = std::find_if(report.dropped.begin(), report.dropped.end(), [](const auto& dropped) {
        return dropped.what == "points more than a voxel's diagonal off the mesh";
    });
    REQUIRE(told != report.dropped.end());
    CHECK(told->count == part.size());
    CHECK((told->where - place).norm() < 0.1);
}

TEST_CASE("points of a surface are not told as left out", "[pipeline]") {
    PointCloud cloud = support::sample(support::sphere(1), {.points = 20000, .position_noise = 0.06});
    ReconstructOptions options;
    SECTION("that noise has taken off it") {
        options.normals = NormalSource::estimate;
        options.depth = 6;
    }
    SECTION("within the bound") {
        cloud = support::sample(support::sphere(1), {.points = 20000});
        options.max_error = MaxError{0.05, true};
    }
    SECTION("of a component that was to go") {
        cloud = support::sample(support::sphere(1), {.points = 20000});
        for (std::size_t i = 0; i < 5000; ++i) {
            cloud.positions.push_back(0.3 * cloud.positions[i] + Vec3(3, 0, 0));
            cloud.normals.push_back(cloud.normals[i]);
        }
        options.min_component = MinComponent{1, true};
    }
    const Report report = reconstruct(cloud, options).report;
    CHECK(report.mesh.closed);
    for (const Report::Dropped& dropped : report.dropped) {
        INFO(dropped.count << ' ' << dropped.what);
        CHECK(dropped.what.find("off the mesh") == std::string::npos);
    }
}

TEST_CASE("a cloud whose arrays do not fit together is refused", "[pipeline]") {
    const PointCloud cloud = step_cloud(500);
    const auto refused = [&](auto change) {
        PointCloud changed = cloud;
        change(changed);
        CHECK_THROWS_AS(reconstruct(changed), Error);
        CHECK_THROWS_AS(reconstruct_levels(std::move(changed), 3, 4), Error);
    };
    refused([](PointCloud& c) { c.normals.pop_back(); });
    refused([](PointCloud& c) { c.colors.resize(3); });
    refused([](PointCloud& c) { c.scalars.push_back({"s", std::vector<double>(c.size() + 1), false}); });
    refused([](PointCloud& c) { c.scalars.push_back({"s", {}, true}); });
}

TEST_CASE("more threads than may run are no more than may run", "[pipeline]") {
    const auto allowed = tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism);
    CHECK(reconstruct(step_cloud(500), {.depth = 3, .threads = 100000}).report.threads
          == static_cast<int>(allowed));
}
