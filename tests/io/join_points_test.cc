// Several scans as one cloud.
#include "hsdm/errors.hh"
#include "hsdm/io/join_points.hh"
#include "hsdm/io/points_in_parts.hh"
#include "support/folder.hh"
#include "support/sample.hh"

#include <catch2/catch.hpp>

using namespace hsdm;

namespace {

PointFile scan(std::size_t points, bool normals, std::optional<Vec3> sensor = {}) {
    PointFile file;
    file.format = "pcd";
    file.cloud = support::sample(support::sphere(1), {.points = points, .normals = normals});
    file.cloud.sensor = sensor;
    return file;
}

PointFile joined(std::vector<PointFile> scans) {
    JoinedPoints all;
    for (PointFile& file : scans) all.add(std::move(file));
    return std::move(all).take();
}

/// Files of several kinds, some of which are read by parts.
struct Scans {
    Scans() {
        support::write_ply(folder / "a.ply", support::sample(support::sphere(1), {.points = 3001}));
        folder.write("b.xyz", "1 2 3 0 0 1\n4 5 6 0 1 0\n7 8 9 1 0 0\n");
        support::write_ply(folder / "c.ply", support::sample(support::sphere(1), {.points = 7}));
        folder.write("notes.md", "no points");
        folder.write(".hidden.xyz", "1 2 3\n");
    }
    support::Folder folder;
};

} // namespace

TEST_CASE("joined scans keep what all of them have, and name the rest", "[io]") {
    PointFile first = scan(10, true), second = scan(20, true), third = scan(30, false);
    for (PointFile* file : {&first, &second, &third}) {
        file->cloud.scalars.push_back({"intensity", std::vector<double>(file->cloud.size(), 1.0)});
        check_arrays(file->cloud);
    }
    second.cloud.scalars.push_back({"time", std::vector<double>(second.cloud.size(), 2.0)});
    second.withheld = 3;
    third.nonfinite = 4;
    SECTION("normals of two") {
        const PointFile all = joined({first, second});
        CHECK(all.cloud.size() == 30);
        CHECK(all.cloud.normals[29] == second.cloud.normals[19]);
        REQUIRE(all.cloud.scalars.size() == 1);
        CHECK(all.cloud.scalars[0].values.size() == 30);
        CHECK(all.partial == std::vector<std::string>{"time"});
        CHECK_NOTHROW(check_arrays(all.cloud));
    }
    SECTION("normals of two of three, in any order") {
        for (const auto& all : {joined({first, third, second}), joined({third, second, first})}) {
            CHECK(all.cloud.size() == 60);
            CHECK_FALSE(all.cloud.has_normals());
            CHECK(all.cloud.scalars.size() == 1);
            CHECK(std::ranges::count(all.partial, "normals") == 1);
            CHECK(all.withheld == 3);
            CHECK(all.nonfinite == 4);
            CHECK_NOTHROW(check_arrays(all.cloud));
        }
    }
}

TEST_CASE("joined scans know which scanner saw each point", "[io]") {
    const Vec3 here(0, 0, 9), there(9, 0, 0);
    SECTION("two scanners, and a scan that does not say") {
        const PointCloud cloud =
            joined({scan(10, false), scan(20, false, here), scan(30, false, there), scan(5, false, here)})
                .cloud;
        CHECK_FALSE(cloud.sensor);
        CHECK(cloud.sensors == std::vector<Vec3>{here, there});
        REQUIRE(cloud.sensor_of.size() == 65);
        CHECK(cloud.sensor_of[9] == -1);
        CHECK(cloud.sensor_of[10] == 0);
        CHECK(cloud.sensor_of[30] == 1);
        CHECK(cloud.sensor_of[64] == 0);
        CHECK_NOTHROW(check_arrays(cloud));
    }
    SECTION("one scanner of all is as of one file") {
        const PointCloud cloud = joined({scan(10, false, here), scan(20, false, here)}).cloud;
        CHECK(cloud.sensor == here);
        CHECK(cloud.sensors.empty());
        CHECK(cloud.sensor_of.empty());
    }
    SECTION("one scanner of a part, that is not sure, is none") {
        for (const auto& cloud : {joined({scan(10, false), scan(20, false, here)}).cloud,
                                  joined({scan(20, false, here), scan(10, false)}).cloud}) {
            CHECK_FALSE(cloud.sensor);
            CHECK(cloud.sensors.empty());
            CHECK(cloud.sensor_of.empty());
        }
    }
    SECTION("PTX scans at one place were moved already") {
        std::vector<PointFile> scans{scan(10, false, here), scan(20, false, here)};
        for (PointFile& file : scans) file.format = "ptx";
        const PointCloud cloud = joined(scans).cloud;
        CHECK_FALSE(cloud.sensor);
        CHECK(cloud.sensors.empty());
    }
    SECTION("none") {
        const PointCloud cloud = joined({scan(10, false), scan(20, false)}).cloud;
        CHECK_FALSE(cloud.sensor);
        CHECK(cloud.sensors.empty());
        CHECK(cloud.sensor_of.empty());
    }
}

TEST_CASE("a folder stands for its files of points, by their names", "[io]") {
    const Scans scans;
    CHECK(
        point_files_in(scans.folder.path())
        == std::vector<std::string>{scans.folder / "a.ply", scans.folder / "b.xyz", scans.folder / "c.ply"});
    const support::Folder empty;
    CHECK_THROWS_AS(point_files_in(empty.path()), Error);
    CHECK_THROWS_AS(point_files_in(empty / "none"), Error);
}

TEST_CASE("shares of several files are all points, each once and in order", "[io]") {
    const Scans scans;
    const std::vector<std::string> files = point_files_in(scans.folder.path());
    const PointCloud whole = read_joined(files).cloud;
    const PointsInParts points(files, {});
    CHECK(points.size() == whole.size());
    CHECK_FALSE(points.in_memory());
    const int shares = GENERATE(1, 2, 3, 7, 50);
    std::vector<Vec3> positions;
    std::size_t most = 0;
    for (int share = 0; share < shares; ++share) {
        const std::size_t before = positions.size();
        points.visit_share(share, shares, [&](const PointCloud& part) {
            CHECK(part.normals.size() == part.size());
            positions.insert(positions.end(), part.positions.begin(), part.positions.end());
        });
        most = std::max(most, positions.size() - before);
    }
    CHECK(positions == whole.positions);
    CHECK(most <= whole.size() / static_cast<std::size_t>(shares) + 10);
}

TEST_CASE("a share of one file in memory is some of its points", "[io]") {
    const Scans scans;
    const PointsInParts points(scans.folder / "b.xyz", {});
    CHECK(points.in_memory());
    std::vector<std::size_t> sizes;
    for (int share = 0; share < 2; ++share)
        points.visit_share(share, 2, [&](const PointCloud& part) { sizes.push_back(part.size()); });
    CHECK(sizes == std::vector<std::size_t>{1, 2});
}

TEST_CASE("points in parts tell of the scanners that all at once tell of", "[io]") {
    const support::Folder folder;
    const auto sensors_in = [](const PointsInParts& points, int shares) {
        std::vector<std::optional<Vec3>> sensors;
        for (int share = 0; share < shares; ++share)
            points.visit_share(share, shares,
                               [&](const PointCloud& part) { sensors.push_back(part.sensor); });
        return sensors;
    };
    SECTION("the camera of a PLY file") {
        PointCloud cloud = support::sample(support::sphere(1), {.points = 20});
        support::write_ply(folder / "scan.ply", cloud);
        std::string text = support::read_file(folder / "scan.ply");
        const std::size_t end = text.find("end_header");
        text.insert(end, "element camera 1\nproperty double view_px\nproperty double view_py\n"
                         "property double view_pz\n");
        const double place[3] = {1, 2, 3};
        text.append(reinterpret_cast<const char*>(place), sizeof place);
        folder.write("scan.ply", text);
        REQUIRE(read_points(folder / "scan.ply").cloud.sensor == Vec3(1, 2, 3));
        CHECK(sensors_in({folder / "scan.ply", {}}, 2) == std::vector<std::optional<Vec3>>(2, Vec3(1, 2, 3)));
    }
    SECTION("those that are asked for, by a column") {
        folder.write("scan.xyz", "x y z nr\n1 2 3 0\n4 5 6 1\n7 8 9 2\n7 8 7 1\n");
        PointCloud cloud = read_points(folder / "scan.xyz").cloud;
        const ReadOptions options{.sensors = {Vec3(0, 0, 9), Vec3(0, 9, 0)}, .sensor_column = "nr"};
        std::vector<std::int32_t> numbers;
        const PointsInParts points(folder / "scan.xyz", options);
        for (int share = 0; share < 2; ++share)
            points.visit_share(share, 2, [&](const PointCloud& part) {
                CHECK(part.sensors == options.sensors);
                numbers.insert(numbers.end(), part.sensor_of.begin(), part.sensor_of.end());
            });
        CHECK(numbers == std::vector<std::int32_t>{0, 1, -1, 1});
    }
    SECTION("none of several PTX files at one place, which were moved already") {
        const auto scan = [](const char* place) {
            return "1\n2\n" + std::string(place) + "\n1 0 0\n0 1 0\n0 0 1\n1 0 0 0\n0 1 0 0\n0 0 1 0\n"
                   + place + " 1\n1 1 1 0.5\n2 2 2 0.5\n";
        };
        folder.write("a.ptx", scan("5 0 0"));
        folder.write("b.ptx", scan("5 0 0"));
        folder.write("c.ptx", scan("6 0 0"));
        const auto of = [&](const char* one, const char* other) {
            return sensors_in({{folder / one, folder / other}, {}}, 1);
        };
        CHECK(of("a.ptx", "b.ptx") == std::vector<std::optional<Vec3>>(2));
        CHECK(of("a.ptx", "c.ptx") == std::vector<std::optional<Vec3>>{Vec3(5, 0, 0), Vec3(6, 0, 0)});
    }
}
