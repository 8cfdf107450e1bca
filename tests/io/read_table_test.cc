#include "hsdm/errors.hh"
#include "io/temp_file.hh"

#include <catch2/catch.hpp>
#include <tbb/global_control.h>

#include <bit>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <random>

using namespace hsdm;
using namespace hsdm::test;

namespace {

const std::vector<Vec3> two_points{Vec3(1, 2, 3), Vec3(-4.5, 5e-3, 6)};

std::string number(double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%.17g", value);
    return text;
}

using Color = std::array<std::uint8_t, 4>;

std::string lower_case(std::string text) {
    for (char& c : text) c = static_cast<char>(std::tolower(c));
    return text;
}

} // namespace

TEST_CASE("blanks, tabs, commas and semicolons separate columns, whatever ends a line", "[io]") {
    for (const char* separator : {" ", "\t", ",", ";", ", ", " ; ", "   "})
        for (const char* line_end : {"\n", "\r\n", "\r", "\n\n"})
            for (const char* last : {"", line_end}) {
                std::string text;
                for (const char* field : {"1", "2", "3", "", "-4.5", "5e-3", "+6"}) {
                    const bool row_starts = text.empty() || text.ends_with(line_end);
                    text += *field == '\0' ? line_end : (row_starts ? "" : separator) + std::string(field);
                }
                CHECK(read("a.xyz", text + last).cloud.positions == two_points);
            }
}

TEST_CASE("a byte-order mark, comments and empty lines are no points", "[io]") {
    const auto file =
        read("a.xyz", "\xef\xbb\xbf# a scan\n\n// by hand\n1 2 3 # first\n  \n#4 5 6\n-4.5 0.005 6 //\n\n");
    CHECK(file.cloud.positions == two_points);
    CHECK(file.format == "xyz");
    CHECK_FALSE(file.cloud.has_normals());
}

TEST_CASE("exponents may have Fortran's letter, from the first line on", "[io]") {
    CHECK(read("a.xyz", "1d0 2D+0 .3d1\n-4.5D0 5d-3 6d00\n").cloud.positions == two_points);
    CHECK(read("a.csv", "x,y,z\n+10d-1,2,3\n-45.d-1,5e-3,6\n").cloud.positions == two_points);
    CHECK(read("a.off", "OFF\n2 0 0\n1d0 2 3\n-4.5 5D-3 6\n").cloud.positions == two_points);
    CHECK(read("a.obj", "v 1d0 2 3\nv -4.5 5d-3 6\n").cloud.positions == two_points);
    for (const char* wrong :
         {"1 2 3\n1d 2 3\n", "1 2 3\n1e2d3 2 3\n", "1 2 3\nnand1 2 3\n", "1 2 3\n1d+ 2 3\n"})
        CHECK(error_of("a.xyz", wrong).starts_with("a.xyz:2: "));
    CHECK(std::isinf(read("a.xyz", "1 2 1d999\n").cloud.positions[0][2]));
}

TEST_CASE("what columns were taken for is kept where their values alone told it", "[io]") {
    CHECK(read("a.xyz", "1 2 3 0 0 1\n").columns == "x,y,z,nx,ny,nz");
    CHECK(read("a.xyz", "1 2 3 0 0 1.4\n").columns == "x,y,z,column_4,column_5,column_6");
    CHECK(read("a.xyz", "1 2 3 0 20 255 0.5\n").columns == "x,y,z,r,g,b,column_7");
    CHECK(read("a.xyz", "1 2 3\n").columns.empty());
    CHECK(read("a.xyz", "x y z nx ny nz\n1 2 3 0 0 1.4\n").columns.empty());
    CHECK(read("a.xyz", "1 2 3 0 0 1\n", {"", "x,y,z,nx,ny,nz"}).columns.empty());
}

TEST_CASE("every double is read to its last bit", "[io]") {
    std::mt19937_64 random(1);
    std::vector<Vec3> points;
    std::string text;
    while (points.size() < 2000) {
        Vec3 p;
        for (unsigned k = 0; k < 3; ++k) p[k] = std::bit_cast<double>(random());
        if (!std::isfinite(p.sqrnorm())
            && !(std::isfinite(p[0]) && std::isfinite(p[1]) && std::isfinite(p[2])))
            continue;
        points.push_back(p);
        text += number(p[0]) + ' ' + number(p[1]) + ' ' + number(p[2]) + '\n';
    }
    CHECK(read("a.xyz", text).cloud.positions == points);
}

TEST_CASE("six columns are normals if they are unit vectors, colours if they are bytes, else scalars",
          "[io]") {
    const auto normals = read("a.txt", "0 0 0 0 0 1\n1 0 0 0.6 0 0.8\n2 0 0 0 0 0\n3 0 0 nan nan nan\n");
    REQUIRE(normals.cloud.normals.size() == 4);
    CHECK(normals.cloud.normals[1] == Vec3(0.6, 0, 0.8));
    CHECK(normals.cloud.colors.empty());

    // The first row alone would pass for a normal.
    const auto colors = read("a.txt", "0 0 0 1 0 0\n1 0 0 200 100 50\n2 0 0 9 8 255\n");
    CHECK_FALSE(colors.cloud.has_normals());
    REQUIRE(colors.cloud.colors.size() == 3);
    CHECK(colors.cloud.colors[1] == Color{200, 100, 50, 255});

    const auto scalars = read("a.txt", "0 0 0 10.5 3 -2\n1 0 0 12 7 256\n");
    CHECK_FALSE(scalars.cloud.has_normals());
    CHECK(scalars.cloud.colors.empty());
    REQUIRE(scalars.cloud.scalars.size() == 3);
    CHECK(scalars.cloud.scalars[2].values == std::vector<double>{-2, 256});
    CHECK(scalars.cloud.scalars[2].name == "column_6");
}

TEST_CASE("normals and colours are found in either order, and what is beside them is kept", "[io]") {
    const auto a = read("a.asc", "1 2 3 0 0.6 0.8 10 20 30\n4 5 6 1 0 0 40 50 60\n").cloud;
    const auto b = read("b.asc", "1 2 3 10 20 30 0 0.6 0.8\n4 5 6 40 50 60 1 0 0\n").cloud;
    CHECK(a.normals == b.normals);
    CHECK(a.colors == b.colors);
    CHECK(a.normals == std::vector<Vec3>{Vec3(0, 0.6, 0.8), Vec3(1, 0, 0)});
    CHECK(a.colors[1] == Color{40, 50, 60, 255});
    CHECK(a.scalars.empty());

    const auto c = read("c.asc", "1 2 3 0.25 0 0.6 0.8\n4 5 6 7.5 1 0 0\n").cloud;
    CHECK(c.normals == a.normals);
    REQUIRE(c.scalars.size() == 1);
    CHECK(c.scalars[0].values == std::vector<double>{0.25, 7.5});

    const auto rgba = read("d.asc", "1 2 3 10 20 30 255\n4 5 6 40 50 60 255\n").cloud;
    REQUIRE(rgba.colors.size() == 2);
    CHECK(rgba.colors[0] == Color{10, 20, 30, 255});
    CHECK(rgba.scalars.empty());

    const auto classes = read("e.asc", "1 2 3 10 20 30 2\n4 5 6 40 50 60 7\n").cloud;
    REQUIRE(classes.colors.size() == 2);
    CHECK(classes.colors[0] == Color{10, 20, 30, 255});
    REQUIRE(classes.scalars.size() == 1);
    CHECK(classes.scalars[0].values == std::vector<double>{2, 7});
}

TEST_CASE("a fourth column is an intensity, a fifth one more scalar", "[io]") {
    const auto four = read("a.xyz", "1 2 3 0.5\n4 5 6 0.75\n").cloud;
    REQUIRE(four.scalars.size() == 1);
    CHECK(four.scalars[0].name == "intensity");
    CHECK(four.scalars[0].values == std::vector<double>{0.5, 0.75});
    CHECK_FALSE(four.scalars[0].is_label);
    CHECK(read("a.xyz", "1 2 3 0.5 1\n4 5 6 0.75 1\n").cloud.scalars.size() == 2);
}

TEST_CASE("a header line names the columns, in any order and case, also as a comment", "[io]") {
    const char* rows = "0.5,3,2,1,255,0,128,4,0,0,1\n0.25,6,5,4,0,0,0,2,1,0,0\n";
    const std::string quoted_names =
        "\"intensity\", \"z\", \"y\", \"x\", \"red\", \"green\", \"blue\", \"class\", "
        "\"normal_x\", \"normal_y\", \"normal_z\"\r\n";
    const std::string headers[] = {"Intensity,Z,Y,X,R,G,B,Classification,Nx,Ny,Nz\n", quoted_names,
                                   "//intensity Z Y X R G B label NX NY NZ\n2\n",
                                   "# intensity;z;y;x;r;g;b;segment;n_x;n_y;n_z\n"};
    for (const std::string& header : headers) {
        const auto cloud = read("a.csv", header + rows).cloud;
        CHECK(cloud.positions == std::vector<Vec3>{Vec3(1, 2, 3), Vec3(4, 5, 6)});
        CHECK(cloud.normals == std::vector<Vec3>{Vec3(0, 0, 1), Vec3(1, 0, 0)});
        CHECK(cloud.colors == std::vector<Color>{{255, 0, 128, 255}, {0, 0, 0, 255}});
        REQUIRE(cloud.scalars.size() == 2);
        CHECK(lower_case(cloud.scalars[0].name) == "intensity");
        CHECK_FALSE(cloud.scalars[0].is_label);
        CHECK(cloud.scalars[1].is_label);
        CHECK(cloud.scalars[1].values == std::vector<double>{4, 2});
    }
}

TEST_CASE("a header of other words only names the scalars", "[io]") {
    const auto cloud = read("a.csv", "Easting,Northing,Height,Scan angle\n1,2,3,40.5\n4,5,6,50\n").cloud;
    CHECK(cloud.size() == 2);
    REQUIRE(cloud.scalars.size() == 1);
    CHECK(cloud.scalars[0].name == "Scan angle");
    CHECK(read("a.txt", "Scan of the second day\n1 2 3\n4 5 6\n").cloud.size() == 2);
}

TEST_CASE("an unnamed index column and empty fields do not shift the others", "[io]") {
    const auto cloud = read("a.csv", ",x,y,z,quality,\n0,1,2,3,0.5,\n1,4,,6,,\n").cloud;
    REQUIRE(cloud.size() == 2);
    CHECK(cloud.positions[0] == Vec3(1, 2, 3));
    CHECK(cloud.positions[1][0] == 4);
    CHECK(std::isnan(cloud.positions[1][1]));
    REQUIRE(cloud.scalars.size() == 1);
    CHECK(cloud.scalars[0].values[0] == 0.5);
    CHECK(std::isnan(cloud.scalars[0].values[1]));
}

TEST_CASE("an unnamed index column may stand before a tab", "[io]") {
    const auto cloud = read("a.txt", "\tx\ty\tz\t\t\r\n7\t1\t2\t3\r\n8\t4\t5\t6\r\n").cloud;
    CHECK(cloud.positions == std::vector<Vec3>{{1, 2, 3}, {4, 5, 6}});
    CHECK(cloud.scalars.empty());
    CHECK(read("a.txt", "\tx\ty\tz\n\t1\t2\t3\n").cloud.positions
          == std::vector<Vec3>{{1, 2, 3}}); // indented
}

TEST_CASE("fields may stand in quotation marks, numbers and what is skipped", "[io]") {
    const auto rows = read("a.csv", "\"\",\"x\",\"y\",\"z\"\n\"1\",1,2,3\n\"2\",4,5,6\n").cloud; // row names
    CHECK(rows.positions == std::vector<Vec3>{{1, 2, 3}, {4, 5, 6}});
    CHECK(rows.scalars.empty());
    const auto all = read("a.csv", "\"x\",\"y\",\"z\",\"q\"\n\"1\",\"2e0\",\"-3\",\"7\"\n").cloud;
    CHECK(all.positions == std::vector<Vec3>{{1, 2, -3}});
    CHECK(all.scalars.at(0).values == std::vector<double>{7});
    const std::string notes = "\"a; #1, \"\"so\"\"\",1,2,3\n\"b\",4,5,6\n";
    CHECK(read("a.csv", notes, {.columns = "_,x,y,z"}).cloud.positions
          == std::vector<Vec3>{{1, 2, 3}, {4, 5, 6}});
    for (const char* bad :
         {"\"1,2,3\n", "1,2,\"3\n", "1,2,\"3\"4\n", "1,2,3\n1,2,\"x\"\n", "1,2,3\n1,2,\"\n"}) {
        INFO(bad);
        CHECK_THROWS_AS(read("a.csv", bad), Error);
    }
}

TEST_CASE("colours in fractions and in 16 bits are scaled to bytes", "[io]") {
    CHECK(read("a.csv", "x,y,z,r,g,b\n1,2,3,0.5,0,1\n4,5,6,0,0,0\n").cloud.colors
          == std::vector<Color>{{128, 0, 255, 255}, {0, 0, 0, 255}});
    CHECK(read("a.csv", "x,y,z,r,g,b,a\n1,2,3,65535,0,257,514\n").cloud.colors
          == std::vector<Color>{{255, 0, 1, 2}});
}

TEST_CASE("a count line is believed only if it is right", "[io]") {
    CHECK(read("a.xyz", "2\n1 2 3\n-4.5 0.005 6\n").cloud.positions == two_points);
    CHECK(error_of("a.xyz", "3\n1 2 3\n4 5 6\n")
          == "a.xyz:1: the count does not fit: 3 points announced, 2 points found; correct the count, or "
             "read a complete "
             "file");
    CHECK(error_of("a.xyz", "# c\n1\n1 2 3\n4 5 6\n7 8 9\n")
              .starts_with("a.xyz:2: the count does not fit: 1 point announced"));
    CHECK(error_of("a.xyz", "1000000000000\n1 2 3\n4 5 6\n7 8 9\n")
              .starts_with("a.xyz:1: the count does not fit"));
}

TEST_CASE("columns can be named by the caller", "[io]") {
    ReadOptions options;
    options.columns = "_, z,y , x,intensity";
    const auto cloud = read("a.txt", "id height y x i more\np1 3 2 1 0.5 9\np2 6 5 4 0.25\n", options).cloud;
    CHECK(cloud.positions == std::vector<Vec3>{Vec3(1, 2, 3), Vec3(4, 5, 6)});
    REQUIRE(cloud.scalars.size() == 1);
    CHECK(cloud.scalars[0].values == std::vector<double>{0.5, 0.25});

    options.columns = "x,y,z,nx,ny,nz,r,g,b,_";
    const auto all = read("a.txt", "1 2 3 0 0 2 9 8 7 0\n", options).cloud;
    CHECK(all.normals == std::vector<Vec3>{Vec3(0, 0, 2)});
    CHECK(all.colors == std::vector<Color>{{9, 8, 7, 255}});
    CHECK(all.scalars.empty());
}

TEST_CASE("columns that cannot be are refused by name", "[io]") {
    const auto refused = [](const char* columns) {
        const ReadOptions options{.columns = columns};
        const TempFile file("a.xyz", "1 2 3 4\n");
        CHECK_THROWS_AS(read_points(file.path(), options), OptionError);
        return error_of("a.xyz", "1 2 3 4\n", options);
    };
    CHECK(refused("x,y,q").starts_with("columns: \"q\" is no column; known are x y z nx"));
    CHECK(refused("x,y,,z").starts_with("columns: \"\" is no column"));
    CHECK(refused("x,y,z,x").starts_with("columns: \"x\" is there twice"));
    CHECK(refused("x,y,nx,ny,nz").starts_with("columns: x, y and z must all be there"));
    CHECK(refused("x,y,z,nx").starts_with("columns: \"nx\" is not complete"));

    ReadOptions options;
    options.columns = "x,y,z,_,_";
    CHECK(error_of("a.xyz", "1 2 3 4\n", options)
          == "a.xyz:1: 4 columns, but 5 were named; name those the file has");
    CHECK(error_of("a.xyz", "1 2 3 4 5\n6 7 8 9\n", options)
          == "a.xyz:2: ends after 4 columns, but 5 columns were named; complete or remove the line");
    CHECK(error_of("a.obj", "v 1 2 3\nv 1 2 4\n", options).find("is no table of numbers")
          != std::string::npos);
}

TEST_CASE("PTS files hold counts, intensities and colours", "[io]") {
    const auto one = read("a.pts", "2\n1 2 3 -1200 10 20 30\n4 5 6 255 255 255 255\n");
    CHECK(one.format == "pts");
    REQUIRE(one.cloud.scalars.size() == 1);
    CHECK(one.cloud.scalars[0].values == std::vector<double>{-1200, 255});
    CHECK(one.cloud.colors == std::vector<Color>{{10, 20, 30, 255}, {255, 255, 255, 255}});

    const auto bytes = read("a.pts", "2\n1 2 3 7 10 20 255\n4 5 6 8 9 8 255\n").cloud;
    CHECK(bytes.colors == std::vector<Color>{{10, 20, 255, 255}, {9, 8, 255, 255}});

    CHECK(read("a.pts", "2\n1 2 3 7\n4 5 6 8\n1\n7 8 9 9\n").cloud.size() == 3); // two scans
    CHECK(error_of("a.pts", "2\n1 2 3 7\n4 5 6 8\n2\n7 8 9 9\n")
              .starts_with("a.pts:4: the count does not fit"));
    CHECK(read("a.pts", "1 2 3\n4 5 6\n").cloud.size() == 2);
}

TEST_CASE("PWN files hold positions and then normals, whatever they are called", "[io]") {
    const char* text = "2\n1 2 3\n4 5 6\n0 0 1\n0 -1 0\n";
    for (const char* name : {"a.pwn", "a.xyz"}) {
        const auto file = read(name, text);
        CHECK(file.format == "pwn");
        CHECK(file.cloud.positions == std::vector<Vec3>{Vec3(1, 2, 3), Vec3(4, 5, 6)});
        CHECK(file.cloud.normals == std::vector<Vec3>{Vec3(0, 0, 1), Vec3(0, -1, 0)});
    }
    CHECK(read("a.pwn", "1 2 3 0 0 1\n4 5 6 0 -1 0\n").cloud.normals.size() == 2);
    CHECK(error_of("a.pwn", "2\n1 2 3\n4 5 6\n0 0 1\n")
              .starts_with("a.pwn:1: 2 points announced, but the file has 3 lines"));
}

TEST_CASE("numbers that are not finite are read as such, in every spelling", "[io]") {
    const auto cloud =
        read("a.xyz",
             "1 2 3\nnan 0 0\n0 -inf 0\n0 0 1.#QNAN\n-1.#IND 0 0\n0 1.#INF00 0\n0 NaN 0\n0 0 Infinity\n"
             "-nan(ind) 0 0\n4 5 6\n")
            .cloud;
    REQUIRE(cloud.size() == 10);
    PointCloud finite = cloud;
    CHECK(drop_nonfinite(finite).nonfinite == 8);
    CHECK(finite.positions == std::vector<Vec3>{Vec3(1, 2, 3), Vec3(4, 5, 6)});
}

TEST_CASE("a large text reads the same with one thread and with all", "[io]") {
    std::mt19937_64 random(7);
    std::uniform_real_distribution<double> coordinate(-100, 100);
    std::string text;
    std::vector<Vec3> points;
    for (int i = 0; i < 60000; ++i) {
        points.emplace_back(coordinate(random), coordinate(random), coordinate(random));
        text += number(points.back()[0]) + ' ' + number(points.back()[1]) + ' ' + number(points.back()[2]);
        text += i % 97 == 0 ? " # note\r\n\n" : "\n";
    }
    const TempFile file("a.xyz", text); // several pieces
    CHECK(read_points(file.path()).cloud.positions == points);
    const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
    CHECK(read_points(file.path()).cloud.positions == points);
}

TEST_CASE("the first bad line is reported, however many there are", "[io]") {
    std::string text;
    for (int i = 1; i <= 100000; ++i) text += i >= 70001 && i % 7 == 0 ? "1.5 2.5 bad\n" : "1.25 2.25 3.25\n";
    for (int round = 0; round < 3; ++round)
        CHECK(error_of("a.xyz", text)
              == "a.xyz:70007: \"bad\" in column 3 is not a number; correct the line, or name the columns "
                 "and give this one "
                 "as _");
}

TEST_CASE("scanners can be named by the caller, and which of them saw a point by a column", "[io]") {
    const std::string text = "x,y,z,scan\n0,0,0,1\n1,0,0,0\n2,0,0,2\n3,0,0,-1\n";
    ReadOptions options{.sensors = {Vec3(0, 0, 9), Vec3(0, 0, 8)}, .sensor_column = "scan"};
    const PointCloud cloud = read("a.csv", text, options).cloud;
    CHECK(cloud.sensors == options.sensors);
    CHECK(cloud.sensor_of == std::vector<std::int32_t>{1, 0, -1, -1});
    CHECK(cloud.scalars.at(0).is_label);
    options.sensor_column = "who";
    CHECK_THROWS_WITH(read("a.csv", text, options), Catch::Contains("who"));
    options.sensor_column = "";
    CHECK_THROWS_AS(read("a.csv", text, options), OptionError); // two, and nothing says which
    options.sensors.pop_back();
    const PointCloud one = read("a.csv", text, options).cloud;
    CHECK(one.sensors.size() == 1);
    CHECK(one.sensor_of.empty());
    CHECK_THROWS_AS(read("a.csv", text, {.sensor_column = "scan"}), OptionError);
    CHECK_THROWS_AS(read("a.csv", text, {.sensors = {Vec3(0, 0, std::nan(""))}}), OptionError);
}
