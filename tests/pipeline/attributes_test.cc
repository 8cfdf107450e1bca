#include "hsdm/pipeline/attributes.hh"

#include <catch2/catch.hpp>

using namespace hsdm;

namespace {

/// Two voxels at depth 1, three points in the first and one in the second.
PointCloud two_voxels() {
    PointCloud cloud;
    cloud.positions = {Vec3(0, 0, 0), Vec3(0.1, 0, 0), Vec3(0.2, 0, 0), Vec3(1, 1, 1)};
    return cloud;
}

const VertexProperty& named(const std::vector<VertexProperty>& properties, const std::string& name) {
    for (const VertexProperty& property : properties)
        if (property.name == name) return property;
    throw std::runtime_error(name + " is missing");
}

std::vector<VertexProperty> attributes_of(const PointCloud& cloud) {
    const Octree octree = build_octree(cloud);
    const OctreeLevel level = extract_level(octree, 1);
    REQUIRE(level.size() == 2);
    const std::vector<Index> voxel = {1, 0}; // vertices need not come in the order of their voxels
    return average_attributes(view_of(cloud), octree, level, voxel);
}

} // namespace

TEST_CASE("colours and scalars are averaged over a vertex's points", "[attributes]") {
    PointCloud cloud = two_voxels();
    cloud.colors = {{10, 0, 0, 255}, {20, 0, 0, 255}, {33, 0, 255, 255}, {7, 8, 9, 128}};
    cloud.scalars = {{"intensity", {1, 2, 6, 5}, false}};
    const auto properties = attributes_of(cloud);
    CHECK(named(properties, "red").values == std::vector<double>{7, 21});
    CHECK(named(properties, "red").type == VertexProperty::Type::uint8);
    CHECK(named(properties, "alpha").values == std::vector<double>{128, 255});
    CHECK(named(properties, "intensity").values == std::vector<double>{5, 3});
    CHECK(named(properties, "hsdm_level").values == std::vector<double>{1, 1});
}

TEST_CASE("labels are decided by majority, ties by the lesser", "[attributes]") {
    PointCloud cloud = two_voxels();
    cloud.scalars = {{"part", {4, 9, 9, 2}, true}, {"room", {5, 3, 4, 1}, true}};
    const auto properties = attributes_of(cloud);
    CHECK(named(properties, "part").values == std::vector<double>{2, 9});
    CHECK(named(properties, "part").type == VertexProperty::Type::int32);
    CHECK(named(properties, "room").values == std::vector<double>{1, 3});
}

TEST_CASE("values that are not numbers do not spoil an average", "[attributes]") {
    PointCloud cloud = two_voxels();
    const double nan = std::numeric_limits<double>::quiet_NaN();
    cloud.scalars = {{"intensity", {1, nan, 3, nan}, false}};
    const auto properties = attributes_of(cloud);
    CHECK(named(properties, "intensity").values[1] == 2);
    CHECK(std::isnan(named(properties, "intensity").values[0]));
}

TEST_CASE("a cloud without attributes gives the level alone", "[attributes]") {
    CHECK(attributes_of(two_voxels()).size() == 1);
}

TEST_CASE("merged attributes: means, rounded for colours, the majority of labels", "[attributes]") {
    using Type = VertexProperty::Type;
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const std::vector<VertexProperty> fine = {{"red", Type::uint8, {10, 11, 200, 30}},
                                              {"part", Type::int32, {7, 9, 5, 9}},
                                              {"intensity", Type::float64, {1, nan, 4, 5}}};
    const std::vector<Index> into = {1, 1, 0, 1};
    const auto merged = merge_attributes(fine, into, 2);
    CHECK(named(merged, "red").values == std::vector<double>{200, 17});
    CHECK(named(merged, "red").type == Type::uint8);
    CHECK(named(merged, "part").values == std::vector<double>{5, 9});
    CHECK(named(merged, "intensity").values == std::vector<double>{4, 3});
}
