// The points of mesh files: OFF, OBJ, STL; and Hoppe's tagged points.
#include "hsdm/errors.hh"
#include "io/temp_file.hh"

#include <catch2/catch.hpp>

#include <cmath>

using namespace hsdm;
using namespace hsdm::test;

namespace {

using Color = std::array<std::uint8_t, 4>;

const std::vector<Vec3> three_points{Vec3(0, 0, 0), Vec3(1, 0, 0.25), Vec3(0, 1, 0)};

std::string stl_facet(const std::vector<Vec3>& corners) {
    std::string facet;
    for (int i = 0; i < 3; ++i) facet += bytes_of(9.f); // the normal is no point
    for (const Vec3& corner : corners)
        for (double value : corner) facet += bytes_of(static_cast<float>(value));
    return facet + std::string(2, '\0');
}

std::string binary_stl(std::uint32_t count, const std::string& facets, const std::string& title = "binary") {
    std::string header = title;
    header.resize(80, ' ');
    return header + bytes_of(count) + facets;
}

std::string text_stl(const std::vector<std::vector<Vec3>>& facets) {
    std::string text = "solid part one\n";
    for (const auto& facet : facets) {
        text += "  facet normal 0 0 1\n    outer loop\n";
        for (const Vec3& p : facet)
            text += "      VERTEX " + std::to_string(p[0]) + " " + std::to_string(p[1]) + " "
                    + std::to_string(p[2]) + "\n";
        text += "    endloop\n  endfacet\n";
    }
    return text + "endsolid part one\n";
}

} // namespace

TEST_CASE("the vertices of an OFF file are read wherever its counts and comments stand", "[io]") {
    const std::string rows = "0 0 0\n1 0 0.25 # second\n\n# between\n0 1 0\n3 0 1 2\n";
    for (const char* header : {"OFF\n3 1 0\n", "OFF 3 1 0\n", "OFF # why\n# c\n\n3 1 3 # counts\n",
                               "# c\nOFF\r\n3 1 0\r\n", "\xef\xbb\xbfOFF\n3 1\n", "OFF3 1 0\n", "3 1 0\n"}) {
        CAPTURE(header);
        const auto file = read("a.off", header + rows);
        CHECK(file.cloud.positions == three_points);
        CHECK(file.format == "off");
        CHECK(file.faces == 1);
    }
}

TEST_CASE("OFF normals and colours are told by the keyword, or without one by their values", "[io]") {
    const std::vector<Vec3> up(2, Vec3(0, 0, 1));
    const std::vector<Color> colors{{10, 20, 30, 255}, {40, 50, 60, 255}};
    CHECK(read("a.off", "NOFF\n2 0 0\n0 0 0 0 0 1\n1 1 1 0 0 1\n").cloud.normals == up);
    CHECK(read("a.off", "COFF\n2 0 0\n0 0 0 10 20 30\n1 1 1 40 50 60\n").cloud.colors == colors);
    CHECK(read("a.off", "COFF\n1 0 0\n0 0 0 0.5 1 0 0.2\n").cloud.colors
          == std::vector<Color>{{128, 255, 0, 51}});
    const auto both =
        read("a.off", "STCNOFF\n2 0 0\n0 0 0 0 0 1 10 20 30 0.5 0.5\n1 1 1 0 0 1 40 50 60 0 1\n").cloud;
    CHECK(both.normals == up);
    CHECK(both.colors == colors);
    CHECK(both.scalars.empty());
    CHECK(read("a.off", "OFF\n2 0 0\n0 0 0 10 20 30\n1 1 1 40 50 60\n").cloud.colors == colors);
}

TEST_CASE("an OFF file that is not as its header says is refused", "[io]") {
    CHECK(error_of("a.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n")
          == "a.off:4: the file ends after 2 of 3 vertices; it was cut off, or its header counts wrong");
    CHECK(error_of("a.off", "OFF\n1000000000 1 0\n0 0 0\n1 0 0\n")
              .starts_with("a.off:4: the file ends after 2 of 1000000000"));
    CHECK(error_of("a.off", "OFF\nmany 1 0\n0 0 0\n")
              .starts_with("a.off:2: \"many 1 0\" are not the numbers of vertices"));
    CHECK(error_of("a.off", "OFF\n").starts_with("a.off:1: the file ends within its header"));
    CHECK(error_of("a.off", "OFF\n2 1 0\n0 0 0\n1 zero 0\n")
              .starts_with("a.off:4: \"zero\" in column 2 is not a number"));
    CHECK(error_of("a.off", "OFF\n2 1 0\n0 0 0\n1 0\n")
              .starts_with("a.off:4: ends after 2 columns, but the first vertex has 3"));
    // One vertex too many announced: the first face is in its place.
    CHECK(error_of("a.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n3 0 1 2\n")
              .starts_with("a.off:5: more columns than the first vertex has 3"));
    CHECK(error_of("a.off", "NOFF\n1 0 0\n0 0 0\n")
              .starts_with("a.off:3: the vertices have 3 numbers, too few"));
    CHECK(error_of("a.off", "4OFF\n1 0 0\n0 0 0 1\n")
              .starts_with("a.off:1: \"4OFF\" has vertices that are not x y z"));
    CHECK(error_of("a.off", "OFF BINARY\nxyz").starts_with("a.off:1: binary OFF files are not read"));
    CHECK(error_of("a.off", "OFF\n0 0 0\n").starts_with("a.off:2: holds no points"));
}

TEST_CASE("the vertices of an OBJ file are read, normals and colours where there is one per vertex", "[io]") {
    const auto file = read(
        "a.obj",
        "# made by hand\nmtllib a.mtl\no part\nv 0 0 0\nv 1 0 0.25 1.0\nvn 0 0 1\nvt 0 0\nv 0 1 0\nvn 1 0 "
        "0\nvn 0 1 0 # last\nf 1//1 2//2 3//3\nf 1 2 3\nl 1 2\n");
    CHECK(file.cloud.positions == three_points);
    CHECK(file.cloud.normals == std::vector<Vec3>{Vec3(0, 0, 1), Vec3(1, 0, 0), Vec3(0, 1, 0)});
    CHECK(file.faces == 2);
    CHECK(file.format == "obj");
    CHECK(file.cloud.colors.empty());
    CHECK_FALSE(read("a.obj", "v 0 0 0\nv 1 0 0\nvn 0 0 1\n").cloud.has_normals());
    CHECK(read("a.obj", "v 0 0 0 1 0.5 0\nv 1 0 0 0 0 0\n").cloud.colors
          == std::vector<Color>{{255, 128, 0, 255}, {0, 0, 0, 255}});
    CHECK(read("a.obj", "v 0 0 0 1 0.5 0\nv 1 0 0\n").cloud.colors.empty());
    CHECK(error_of("a.obj", "v 0 0 0\nv 1 O 0\n") == "a.obj:2: \"O\" is not a number; correct the line");
    CHECK(error_of("a.obj", "v 0 0 0\nv 1 2\n").starts_with("a.obj:2: 2 numbers, but x, y and z are needed"));
}

TEST_CASE("Hoppe's point lines are read and other tagged lines skipped", "[io]") {
    for (const char* name : {"a.pts", "a.xyz", "a.p", "a"}) {
        const auto file = read(name, "# scan\ns 3\np 0 0 0\np 1 0 0.25\nq 1 2 3\np 0 1 0\n");
        CHECK(file.format == "hoppe");
        CHECK(file.cloud.positions == three_points);
    }
    // Point elements of an OBJ file begin with p, too.
    const auto obj = read("a.txt", "p 1 2 3\nv 0 0 0\nv 1 0 0.25\nv 0 1 0\n");
    CHECK(obj.format == "obj");
    CHECK(obj.cloud.positions == three_points);
    CHECK(error_of("a.xyz", "p 0 0 0\np 1 0\n").starts_with("a.xyz:2: 2 numbers, but x, y and z are needed"));
}

TEST_CASE("STL corners at the same position become one point, in order of appearance", "[io]") {
    const std::vector<Vec3> other{Vec3(0, 1, 0), Vec3(1, 0, 0.25), Vec3(-0.0, 2, 0)};
    std::vector<Vec3> expected = three_points;
    expected.emplace_back(0, 2, 0);
    for (const std::string& content :
         {text_stl({three_points, other}), binary_stl(2, stl_facet(three_points) + stl_facet(other)),
          binary_stl(2, stl_facet(three_points) + stl_facet(other), "solid facet, or so it seems")}) {
        const auto file = read("a.stl", content);
        CHECK(file.cloud.positions == expected);
        CHECK(file.faces == 2);
        CHECK(file.format == "stl");
    }
}

TEST_CASE("STL corners that are not finite are kept for drop_nonfinite", "[io]") {
    const std::vector<Vec3> bad{Vec3(NAN, 0, 0), Vec3(NAN, 0, 0), Vec3(0, 1, 0)};
    auto cloud = read("a.stl", binary_stl(1, stl_facet(bad))).cloud;
    CHECK(cloud.size() == 2);
    CHECK(drop_nonfinite(cloud).nonfinite == 1);
}

TEST_CASE("an STL file that is cut off or counts wrong is refused", "[io]") {
    const std::string two = stl_facet(three_points) + stl_facet(three_points);
    CHECK(error_of("a.stl", binary_stl(3, two))
          == "a.stl: the file ends after 2 of 3 triangles (at byte 184); it was cut off, or its header "
             "counts wrong");
    CHECK(error_of("a.stl", binary_stl(4000000000u, two)).find("after 2 of 4000000000 triangles")
          != std::string::npos);
    CHECK(error_of("a.stl", binary_stl(1, two)).find("header's count is wrong") != std::string::npos);
    CHECK(error_of("a.stl", binary_stl(0, "")).find("0 triangles") != std::string::npos);
    CHECK(error_of("a.stl", std::string("\0\1\2", 3)).find("too short for an STL file") != std::string::npos);
    std::string text = text_stl({three_points, three_points});
    CHECK(error_of("a.stl", text.substr(0, text.size() - 40)).find("endsolid; it was cut off")
          != std::string::npos);
    CHECK(error_of("a.stl", text.substr(0, 100)).find("it was cut off") != std::string::npos);
    CHECK(error_of("a.stl", "solid empty\nendsolid empty\n").find("there is no facet") != std::string::npos);
    text.replace(text.find("VERTEX"), 9, "vertex o.");
    CHECK(error_of("a.stl", text).starts_with("a.stl:4: \"o.000000\" is not a number"));
}
