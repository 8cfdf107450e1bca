#include "hsdm/errors.hh"
#include "io/temp_file.hh"

#include <catch2/catch.hpp>

using namespace hsdm;
using namespace hsdm::test;

namespace {

/// Columns, rows, position and axes, then a turn by 90 degrees about z and a shift.
std::string header(int columns, int rows, const std::string& shift = "10 20 30") {
    return std::to_string(columns) + "\n" + std::to_string(rows) + "\n" + shift
           + "\n0 1 0\n-1 0 0\n0 0 1\n0 1 0 0\n-1 0 0 0\n0 0 1 0\n" + shift + " 1\n";
}

const std::string rays = "1 0 0 0.25\n0 0 0 0.5\n0 2 0 0.75\n1 2 3 1\n";

} // namespace

TEST_CASE("the points of a PTX scan are in the world, the rays that hit nothing are none", "[io]") {
    for (const char* name : {"a.ptx", "a.txt", "a"}) {
        const PointFile file = read(name, header(2, 2) + rays);
        CHECK(file.format == "ptx");
        CHECK(file.nonfinite == 1);
        CHECK(file.cloud.positions == std::vector<Vec3>{Vec3(10, 21, 30), Vec3(8, 20, 30), Vec3(8, 21, 33)});
        REQUIRE(file.cloud.scalars.size() == 1);
        CHECK(file.cloud.scalars[0].name == "intensity");
        CHECK(file.cloud.scalars[0].values == std::vector<double>{0.25, 0.75, 1});
        REQUIRE(file.cloud.sensor);
        CHECK(*file.cloud.sensor == Vec3(10, 20, 30));
    }
}

TEST_CASE("a PTX scan has colours if its lines have", "[io]") {
    const auto cloud = read("a.ptx", header(1, 2) + "1 0 0 0.25 10 20 30\n0 0 1 0.5 40 50 255\n").cloud;
    REQUIRE(cloud.colors.size() == 2);
    CHECK(cloud.colors[1] == std::array<std::uint8_t, 4>{40, 50, 255, 255});
    CHECK(cloud.scalars[0].values == std::vector<double>{0.25, 0.5});
}

TEST_CASE("several PTX scans make one cloud, each with its sensor", "[io]") {
    const auto cloud = read("a.ptx", header(2, 2) + rays + header(1, 1, "0 0 5") + "1 1 1 0.5\n\n").cloud;
    REQUIRE(cloud.size() == 4);
    CHECK(cloud.positions[3] == Vec3(-1, 1, 6));
    CHECK(cloud.scalars[0].values.size() == 4);
    CHECK_FALSE(cloud.sensor);
    CHECK(cloud.sensors == std::vector<Vec3>{{10, 20, 30}, {0, 0, 5}});
    CHECK(cloud.sensor_of == std::vector<std::int32_t>{0, 0, 0, 1});
    const auto moved = read("a.ptx", header(2, 2) + rays + header(1, 1) + "1 1 1 0.5\n\n").cloud;
    CHECK_FALSE(moved.sensor); // of scans at one place nobody knows who saw what
    CHECK(moved.sensors.empty());
    CHECK(moved.sensor_of.empty());
}

TEST_CASE("PTX scans that hit nothing leave the sensor of the one that did", "[io]") {
    const std::string nothing = header(1, 2, "7 7 7") + "0 0 0 0\n0 0 0 0\n", none = header(0, 5, "8 8 8");
    for (const std::string& text : {nothing + header(2, 2) + rays, header(2, 2) + rays + nothing,
                                    none + header(2, 2) + rays, header(2, 2) + rays + none}) {
        const PointFile file = read("a.ptx", text);
        const PointCloud& cloud = file.cloud;
        CHECK(cloud.size() == 3);
        CHECK(file.nonfinite == (text.find("7 7 7") == std::string::npos ? 1 : 3));
        REQUIRE(cloud.sensor);
        CHECK(*cloud.sensor == Vec3(10, 20, 30));
    }
}

TEST_CASE("what is wrong with a PTX file is said with its line", "[io]") {
    CHECK(error_of("a.ptx", header(2, 3) + rays).find("ends after 4 of 6 rays") != std::string::npos);
    CHECK(error_of("a.ptx", header(1, 2) + rays)
              .starts_with("a.ptx:13: line 1 of a scan's header must hold 1"));
    CHECK(error_of("a.ptx", header(2, 2) + "1 0 0 0.25\n1 1\n1 1 1 1\n2 2 2 2\n").starts_with("a.ptx:12: "));
    CHECK(error_of("a.ptx", header(2, 1) + "1 0\n1 1\n").find("2 columns") != std::string::npos);
    CHECK(error_of("a.ptx", header(2, 1) + "0 0 0 0\n0 0 0 0\n").find("no ray") != std::string::npos);
    CHECK_FALSE(error_of("a.ptx", "-1\n" + header(2, 1).substr(2) + rays).empty());
    CHECK_THROWS_AS(read("a.xyz", "1 2 3\n4 5 6\n", {.format = "ptx", .columns = {}}), Error);
}
