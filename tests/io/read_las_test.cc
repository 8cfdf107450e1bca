#include "io/las_bytes.hh"

#include <catch2/catch.hpp>

#include <cmath>

using namespace hsdm;
using namespace hsdm::test;

namespace {

const std::vector<LasPoint> las_points{{{1000, -2000, 3000}, 11, 2, false, 5, {65535, 257, 0}},
                                       {{4, 5, 6}, 12, 6, false, 6, {0, 65535, 257 * 128}},
                                       {{-7, 8, 2147483647}, 13, 2, false, 5, {257, 257, 257}}};

const Scalar* las_scalar(const PointCloud& cloud, const std::string& name) {
    for (const Scalar& scalar : cloud.scalars)
        if (scalar.name == name) return &scalar;
    return nullptr;
}

std::string with_bytes(std::string file, std::size_t at, const std::string& bytes) {
    return file.replace(at, bytes.size(), bytes);
}

} // namespace

TEST_CASE("LAS files of every version and point format give positions, colours and classes", "[io]") {
    for (const int minor : {0, 1, 2, 3, 4})
        for (int format = 0; format <= (minor == 4 ? 10 : 5); ++format) {
            CAPTURE(minor, format);
            LasLayout layout;
            layout.minor = minor;
            layout.format = format;
            layout.scale = {0.001, 0.01, 0.5};
            layout.offset = {2600000, -1.5, 1e-3};
            layout.records = {"", "some words", std::string(5000, 'x')};
            layout.between = "padding";
            layout.extra = format % 2 ? "four" : "";
            const PointFile file = read("a.las", las_file(layout, las_points));
            CHECK(file.format == "las");
            const PointCloud& cloud = file.cloud;
            REQUIRE(cloud.size() == 3);
            for (std::size_t i = 0; i < 3; ++i)
                for (unsigned k = 0; k < 3; ++k)
                    CHECK(cloud.positions[i][k] == las_points[i].at[k] * layout.scale[k] + layout.offset[k]);
            const bool colored =
                format == 2 || format == 3 || format == 5 || format == 7 || format == 8 || format == 10;
            REQUIRE(cloud.colors.empty() == !colored);
            if (colored) {
                CHECK(cloud.colors[0] == std::array<std::uint8_t, 4>{255, 1, 0, 255});
                CHECK(cloud.colors[1] == std::array<std::uint8_t, 4>{0, 255, 128, 255});
            }
            REQUIRE(las_scalar(cloud, "intensity"));
            CHECK(las_scalar(cloud, "intensity")->values == std::vector<double>{11, 12, 13});
            REQUIRE(las_scalar(cloud, "classification"));
            CHECK(las_scalar(cloud, "classification")->values == std::vector<double>{2, 6, 2});
            CHECK(las_scalar(cloud, "classification")->is_label);
            REQUIRE(las_scalar(cloud, "point_source_id"));
            CHECK(las_scalar(cloud, "point_source_id")->values == std::vector<double>{5, 6, 5});
        }
}

TEST_CASE(
    "colours that a LAS file stores in eight bits are not black, and what is zero throughout was never set",
    "[io]") {
    LasLayout layout;
    layout.format = 2;
    const std::vector<LasPoint> dark{{{1, 2, 3}, 0, 0, false, 0, {255, 128, 1}},
                                     {{4, 5, 6}, 0, 0, false, 0, {}}};
    const PointCloud cloud = read("a.las", las_file(layout, dark)).cloud;
    CHECK(cloud.colors[0] == std::array<std::uint8_t, 4>{255, 128, 1, 255});
    CHECK(cloud.scalars.empty());
    const std::vector<LasPoint> bare{{{1, 2, 3}, 0, 0, false, 0, {}}, {{4, 5, 6}, 0, 0, false, 0, {}}};
    CHECK(read("a.las", las_file(layout, bare)).cloud.colors.empty());
}

TEST_CASE("flags that share a byte with a LAS file's classes make no classes", "[io]") {
    constexpr std::uint8_t synthetic = 0x20, key = 0x40;
    const std::vector<LasPoint> flagged{{{1, 2, 3}, 0, synthetic, false, 0, {}},
                                        {{4, 5, 6}, 0, key, false, 0, {}}};
    CHECK(read("a.las", las_file({}, flagged)).cloud.scalars.empty());
    std::vector<LasPoint> classed = flagged;
    classed[1].classification |= 6;
    const PointCloud cloud = read("a.las", las_file({}, classed)).cloud;
    REQUIRE(las_scalar(cloud, "classification"));
    CHECK(las_scalar(cloud, "classification")->values == std::vector<double>{0, 6});
}

TEST_CASE("records of a LAS file are followed beyond what is read at once", "[io]") {
    LasLayout layout;
    for (std::size_t i = 0; i < 5000; ++i) layout.records.emplace_back(i * 7919 % 97, 'r');
    layout.records.emplace_back(65535, 'r');
    layout.records.emplace_back("the last");
    const std::string file = las_file(layout, las_points);
    CHECK(read("a.las", file).cloud.size() == 3);
    CHECK(error_of("a.las", with_bytes(file, 100, bytes_of(std::uint32_t(5003))))
              .find("record 5002 of 5003 does not fit")
          != std::string::npos);
    const std::size_t last = file.size() - 3 * 20 - 8 - 54;
    CHECK(error_of("a.las", with_bytes(file, last + 20, bytes_of(std::uint16_t(9))))
              .find("record 5001 of 5002 is longer")
          != std::string::npos);
}

TEST_CASE("points that a LAS file marks as withheld are left out and counted", "[io]") {
    for (const int format : {0, 2, 6, 7}) {
        CAPTURE(format);
        LasLayout layout;
        layout.minor = 4;
        layout.format = format;
        std::vector<LasPoint> points = las_points;
        points[1].withheld = true;
        const PointFile file = read("a.las", las_file(layout, points));
        CHECK(file.cloud.size() == 2);
        CHECK(file.withheld == 1);
        CHECK(file.first_withheld == Vec3(0.004, 0.005, 0.006));
        CHECK(las_scalar(file.cloud, "classification")->values == std::vector<double>{2, 2});
        CHECK(file.cloud.colors.size() == (format == 2 || format == 7 ? 2 : 0));
        for (LasPoint& p : points) p.withheld = true;
        CHECK(error_of("a.las", las_file(layout, points))
              == "a.las: holds no points: all are marked as withheld");
    }
}

TEST_CASE(
    "extended records behind the points of a LAS file are ignored, and read from standard input is the same",
    "[io]") {
    LasLayout layout;
    layout.minor = 4;
    layout.format = 7;
    layout.behind = std::string(500, 'e');
    const PointFile file = read("wrong-name.xyz", las_file(layout, las_points));
    CHECK(file.format == "las");
    CHECK(file.cloud.size() == 3);
}

TEST_CASE("LAZ is refused with the command that unpacks it", "[io]") {
    const std::string file = las_file({}, las_points);
    for (const char mark : {'\x80', '\x82', '\x40'})
        CHECK(error_of("a.laz", with_bytes(file, 104, {mark}))
              == "a.laz: is LAZ, which is compressed and not read; unpack it first: `laszip -i scan.laz -o "
                 "scan.las`, "
                 "or `pdal translate scan.laz scan.las`");
}

TEST_CASE("a LAS file that is cut off anywhere is refused", "[io]") {
    for (const int minor : {2, 3, 4}) {
        LasLayout layout;
        layout.minor = minor;
        layout.format = 3;
        layout.records = {"words"};
        const std::string file = las_file(layout, las_points);
        for (std::size_t size = 0; size < file.size(); ++size) {
            CAPTURE(minor, size);
            const std::string message = error_of("a.las", file.substr(0, size));
            REQUIRE(!message.empty());
            if (size >= 4) {
                REQUIRE(message.find("byte " + std::to_string(size)) != std::string::npos);
                REQUIRE(message.find("cut off") != std::string::npos);
            }
        }
    }
}

TEST_CASE("LAS headers that lie are refused with the place of the lie", "[io]") {
    LasLayout layout;
    layout.records = {"words"};
    const std::string file = las_file(layout, las_points);
    const auto lie = [&](std::size_t at, const std::string& bytes) {
        return error_of("a.las", with_bytes(file, at, bytes));
    };
    using Catch::Contains;
    CHECK_THAT(lie(24, {'\2'}), Contains("LAS version 2.2 is not known") && Contains("(at byte 24)"));
    CHECK_THAT(lie(25, {'\5'}), Contains("LAS version 1.5 is not known"));
    CHECK_THAT(lie(94, bytes_of(std::uint16_t(100))),
               Contains("header of 100 bytes") && Contains("(at byte 94)"));
    CHECK_THAT(lie(96, bytes_of(std::uint32_t(5))),
               Contains("within the header") && Contains("(at byte 96)"));
    CHECK_THAT(lie(100, bytes_of(std::uint32_t(2))), Contains("record 1 of 2") && Contains("(at byte 286)"));
    CHECK_THAT(lie(100, bytes_of(std::uint32_t(-1))), Contains("record 1 of 4294967295"));
    CHECK_THAT(lie(227 + 20, bytes_of(std::uint16_t(6))), Contains("record 0 of 1 is longer"));
    CHECK_THAT(lie(104, {'\x0b'}), Contains("point format 11 is not known") && Contains("(at byte 104)"));
    CHECK_THAT(lie(105, bytes_of(std::uint16_t(19))), Contains("points of 19 bytes, format 0 has 20"));
    CHECK_THAT(lie(107, bytes_of(std::uint32_t(4))), Contains("the file ends after 3 of 4 points"));
    CHECK_THAT(lie(107, bytes_of(std::uint32_t(2))), Contains("room for 3 points, but the header says 2"));
    CHECK_THAT(lie(107, bytes_of(std::uint32_t(0))), Contains("holds no points"));
    CHECK_THAT(lie(131, bytes_of(0.0)),
               Contains("a scale that is zero or no number") && Contains("(at byte 131)"));
    CHECK_THAT(lie(163, bytes_of(std::nan(""))),
               Contains("an offset that is no number") && Contains("(at byte 163)"));
    layout.minor = 4;
    const std::string newest = las_file(layout, las_points);
    CHECK_THAT(error_of("a.las", with_bytes(newest, 247, bytes_of(std::uint64_t(1) << 60))),
               Contains("the file ends after 3 of 1152921504606846976 points"));
}
