#include "hsdm/errors.hh"
#include "hsdm/point_cloud.hh"

#include <catch2/catch.hpp>

#include <cmath>

using namespace hsdm;

namespace {

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();
constexpr double infinite = std::numeric_limits<double>::infinity();

} // namespace

TEST_CASE("a cloud that is finite throughout loses nothing", "[point_cloud]") {
    PointCloud cloud;
    cloud.positions = {Vec3(0, 0, 0), Vec3(1e300, -1e300, 5e-324)};
    cloud.normals = {Vec3(0, 0, 1), Vec3(0, 3, 4)};
    const PointCloud before = cloud;
    const Dropped dropped = drop_nonfinite(cloud);
    CHECK(dropped.nonfinite == 0);
    CHECK(dropped.bad_normals == 0);
    CHECK(cloud.positions == before.positions);
    CHECK(cloud.normals == before.normals);
}

TEST_CASE("a cloud without a finite point becomes empty, with all its arrays", "[point_cloud]") {
    PointCloud cloud;
    cloud.positions = {Vec3(not_a_number, 0, 0), Vec3(0, infinite, 0), Vec3(0, 0, -infinite)};
    cloud.normals.assign(3, Vec3(0, 0, 1));
    cloud.colors.assign(3, {1, 2, 3, 4});
    cloud.scalars.push_back({"intensity", {1, 2, 3}, false});
    const Dropped dropped = drop_nonfinite(cloud);
    CHECK(dropped.nonfinite == 3);
    CHECK(dropped.bad_normals == 0);
    CHECK(cloud.size() == 0);
    CHECK(cloud.normals.empty());
    CHECK(cloud.colors.empty());
    CHECK(cloud.scalars[0].values.empty());
    CHECK(drop_nonfinite(cloud).nonfinite == 0);
}

TEST_CASE("what belongs to a dropped point goes with it, and the order stays", "[point_cloud]") {
    PointCloud cloud;
    Scalar scalar{"label", {}, true};
    const std::size_t count = 50000; // several blocks of the parallel pass
    for (std::size_t i = 0; i < count; ++i) {
        const auto value = static_cast<double>(i);
        cloud.positions.emplace_back(value, i % 3 == 1 ? not_a_number : 0, i % 1000 == 0 ? infinite : 0);
        cloud.normals.emplace_back(0, 0, value + 1);
        cloud.colors.push_back({static_cast<std::uint8_t>(i % 251), 0, 0, 255});
        scalar.values.push_back(value);
    }
    cloud.scalars.push_back(scalar);
    std::size_t expected = 0;
    for (std::size_t i = 0; i < count; ++i) expected += i % 3 != 1 && i % 1000 != 0;
    CHECK(drop_nonfinite(cloud).nonfinite == count - expected);
    REQUIRE(cloud.size() == expected);
    REQUIRE(cloud.normals.size() == expected);
    REQUIRE(cloud.colors.size() == expected);
    REQUIRE(cloud.scalars[0].values.size() == expected);
    bool consistent = true;
    for (std::size_t i = 0; i < expected; ++i) {
        const double value = cloud.positions[i][0];
        consistent &= cloud.normals[i][2] == value + 1 && cloud.scalars[0].values[i] == value
                      && cloud.colors[i][0] == static_cast<std::size_t>(value) % 251
                      && (i == 0 || value > cloud.positions[i - 1][0]);
    }
    CHECK(consistent);
}

TEST_CASE("normals that are zero or not finite become none, and their points stay", "[point_cloud]") {
    PointCloud cloud;
    cloud.positions = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(2, 0, 0), Vec3(not_a_number, 0, 0), Vec3(4, 0, 0)};
    cloud.normals = {Vec3(0, 0, 0), Vec3(not_a_number, 0, 1), Vec3(0, infinite, 0), Vec3(not_a_number, 0, 0),
                     Vec3(0, 0, -2)};
    const Dropped dropped = drop_nonfinite(cloud);
    CHECK(dropped.nonfinite == 1);
    CHECK(dropped.bad_normals == 3);
    CHECK(cloud.normals == std::vector<Vec3>{Vec3(0, 0, 0), Vec3(0, 0, 0), Vec3(0, 0, 0), Vec3(0, 0, -2)});
}

TEST_CASE("a cloud whose arrays do not fit together is refused, and left as it was", "[point_cloud]") {
    PointCloud cloud;
    cloud.positions = {Vec3(not_a_number, 0, 0), Vec3(0, 0, 0), Vec3(1, 0, 0)};
    CHECK_NOTHROW(check_arrays(cloud));
    const auto refusal = [](PointCloud wrong) {
        try {
            drop_nonfinite(wrong);
        } catch (const Error& error) {
            CHECK(wrong.size() == 3);
            return std::string(error.what());
        }
        return std::string();
    };
    const std::string rest = " for 3 points; give one for each, or leave them out";
    PointCloud wrong = cloud;
    wrong.normals.assign(2, Vec3(0, 0, 1));
    CHECK(refusal(wrong) == "the cloud holds 2 normals" + rest);
    wrong = cloud;
    wrong.colors.assign(1, {1, 2, 3, 4});
    CHECK(refusal(wrong) == "the cloud holds 1 colours" + rest);
    wrong = cloud;
    wrong.scalars.push_back({"intensity", {1, 2, 3, 4}, false});
    CHECK(refusal(wrong) == "the cloud holds 4 values of intensity" + rest);
}
