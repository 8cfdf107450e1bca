#include "hsdm/errors.hh"
#include "io/temp_file.hh"

#include <catch2/catch.hpp>

#include <cmath>
#include <functional>
#include <sstream>

using namespace hsdm;
using namespace hsdm::test;

namespace {

using Color = std::array<std::uint8_t, 4>;

std::string ply(const std::string& format, const std::string& header, const std::string& body) {
    return "ply\nformat " + format + " 1.0\n" + header + "end_header\n" + body;
}

const char* xyz = "property float x\nproperty float y\nproperty float z\n";

std::string float_point(float x, float y, float z, bool big = false) {
    return bytes_of(x, big) + bytes_of(y, big) + bytes_of(z, big);
}

} // namespace

TEST_CASE("PLY scalars of every type and spelling are read in text and in both byte orders", "[io]") {
    struct Type {
        const char* name;
        std::function<std::string(double, bool)> bytes;
    };
    const auto as = [](auto t) {
        using T = decltype(t);
        return [](double v, bool big) { return bytes_of(static_cast<T>(v), big); };
    };
    const Type types[] = {
        {"char", as(std::int8_t())},     {"int8", as(std::int8_t())},     {"uchar", as(std::uint8_t())},
        {"uint8", as(std::uint8_t())},   {"short", as(std::int16_t())},   {"int16", as(std::int16_t())},
        {"ushort", as(std::uint16_t())}, {"uint16", as(std::uint16_t())}, {"int", as(std::int32_t())},
        {"int32", as(std::int32_t())},   {"uint", as(std::uint32_t())},   {"uint32", as(std::uint32_t())},
        {"float", as(float())},          {"float32", as(float())},        {"double", as(double())},
        {"float64", as(double())},
    };
    for (const Type& type : types) {
        CAPTURE(type.name);
        const std::string header = "element vertex 2\nproperty " + std::string(type.name)
                                   + " x\nproperty double y\nproperty " + type.name
                                   + " z\nproperty uchar flag\n";
        const std::vector<Vec3> expected{Vec3(1, 0.1, 100), Vec3(7, -0.2, 3)};
        CHECK(read("a.ply", ply("ascii", header, "1 0.1 100 0\n7 -0.2 3 1\n")).cloud.positions == expected);
        for (bool big : {false, true}) {
            std::string body;
            for (const Vec3& p : expected)
                body += type.bytes(p[0], big) + bytes_of(p[1], big) + type.bytes(p[2], big)
                        + bytes_of(std::uint8_t(5));
            const auto cloud =
                read("a.ply", ply(big ? "binary_big_endian" : "binary_little_endian", header, body)).cloud;
            CHECK(cloud.positions == expected);
            REQUIRE(cloud.scalars.size() == 1);
            CHECK(cloud.scalars[0].name == "flag");
            CHECK(cloud.scalars[0].values == std::vector<double>{5, 5});
        }
    }
}

TEST_CASE("negative and large PLY integers keep their sign and value", "[io]") {
    const std::string header =
        "element vertex 1\nproperty short x\nproperty int y\nproperty uint z\nproperty char quality\n";
    for (bool big : {false, true}) {
        const std::string body = bytes_of(std::int16_t(-300), big) + bytes_of(std::int32_t(-70000), big)
                                 + bytes_of(std::uint32_t(4000000000u), big) + bytes_of(std::int8_t(-5));
        const auto cloud =
            read("a.ply", ply(big ? "binary_big_endian" : "binary_little_endian", header, body)).cloud;
        CHECK(cloud.positions[0] == Vec3(-300, -70000, 4e9));
        CHECK(cloud.scalars[0].values[0] == -5);
    }
}

TEST_CASE("PLY normals and colours are known by all their names", "[io]") {
    for (const char* normal : {"nx ny nz", "normal_x normal_y normal_z", "n_x n_y n_z"})
        for (const char* color : {"red green blue", "r g b", "diffuse_red diffuse_green diffuse_blue"}) {
            std::string header = "element vertex 1\n";
            header += xyz;
            std::istringstream normals(normal), colors(color);
            for (std::string name; normals >> name;) header += "property float " + name + "\n";
            for (std::string name; colors >> name;) header += "property uchar " + name + "\n";
            const auto cloud = read("a.ply", ply("ascii", header, "1 2 3 0 0.5 1 10 20 30\n")).cloud;
            CHECK(cloud.normals == std::vector<Vec3>{Vec3(0, 0.5, 1)});
            CHECK(cloud.colors == std::vector<Color>{{10, 20, 30, 255}});
            CHECK(cloud.scalars.empty());
        }
}

TEST_CASE("PLY colours of other types are scaled by their range", "[io]") {
    const auto colors = [](const std::string& type, const std::string& values) {
        std::string header = "element vertex 2\n";
        header += xyz;
        for (const char* name : {"red", "green", "blue", "alpha"})
            header += "property " + type + " " + name + "\n";
        return read("a.ply", ply("ascii", header, "0 0 0 " + values + "\n0 0 0 0 0 0 0\n"))
            .cloud.colors.at(0);
    };
    CHECK(colors("uchar", "1 2 255 7") == Color{1, 2, 255, 7});
    CHECK(colors("ushort", "65535 257 0 514") == Color{255, 1, 0, 2});
    CHECK(colors("float", "1 0.5 0 0.2") == Color{255, 128, 0, 51});
    CHECK(colors("float", "1 0 0 1") == Color{255, 0, 0, 255});
    CHECK(colors("float", "200 100 0 255") == Color{200, 100, 0, 255});
    CHECK(colors("int", "1 0 1 1") == Color{1, 0, 1, 1});

    std::string header = "element vertex 3000\n";
    header += xyz;
    for (const char* name : {"red", "green", "blue"}) header += std::string("property float ") + name + "\n";
    std::string body;
    for (int i = 0; i < 3000; ++i) body += float_point(1, 2, 3) + float_point(i == 2500 ? 1.f : 0.f, 0.5f, 0);
    const auto cloud = read("a.ply", ply("binary_little_endian", header, body)).cloud;
    CHECK(cloud.colors[2500] == Color{255, 128, 0, 255});
    CHECK(cloud.colors[0] == Color{0, 128, 0, 255});
}

TEST_CASE("integer PLY properties with a label's name are labels", "[io]") {
    const std::string header =
        "element vertex 2\n" + std::string(xyz)
        + "property int label\nproperty uchar scalar_Classification\nproperty float segment\nproperty "
          "int hits\nproperty float confidence\n";
    const auto scalars =
        read("a.ply", ply("ascii", header, "0 0 0 1 2 3.5 4 5\n0 0 0 -1 2 3 4 5\n")).cloud.scalars;
    REQUIRE(scalars.size() == 5);
    CHECK(scalars[0].is_label);
    CHECK(scalars[1].is_label);
    CHECK(scalars[1].name == "scalar_Classification");
    CHECK_FALSE(scalars[2].is_label); // not all of its values are integers
    CHECK_FALSE(scalars[3].is_label);
    CHECK_FALSE(scalars[4].is_label);
}

TEST_CASE("PLY lists, faces, comments and other elements are skipped", "[io]") {
    const std::string header =
        "comment made by hand\nobj_info num_cols 512\nelement sensor 2\nproperty uchar id\nproperty list "
        "uchar short tags\nelement vertex 3\nproperty list int float weights\nproperty float x\nproperty "
        "float y\nproperty list uchar uchar t\nproperty float z\nproperty int label\nelement face "
        "1\nproperty list uchar int vertex_indices\n";
    const std::vector<Vec3> expected{Vec3(1, 2, 3), Vec3(4, 5, 6), Vec3(7, 8, 9)};
    const auto text = read(
        "a.ply", ply("ascii", header,
                     "1 2 -3 -4\n2 0\n0 1 2 1 9 3 5\n2 0.1 0.2 4 5 0 6 6\n1 0 7 8 2 1 1 9 7\n3 0 1 2\n"));
    CHECK(text.cloud.positions == expected);
    CHECK(text.faces == 1);
    CHECK(text.format == "ply");
    REQUIRE(text.cloud.scalars.size() == 1);
    CHECK(text.cloud.scalars[0].values == std::vector<double>{5, 6, 7});

    for (bool big : {false, true}) {
        const auto u8 = [](int v) { return bytes_of(static_cast<std::uint8_t>(v)); };
        const auto i16 = [=](int v) { return bytes_of(static_cast<std::int16_t>(v), big); };
        const auto i32 = [=](int v) { return bytes_of(std::int32_t(v), big); };
        const auto f = [=](float v) { return bytes_of(v, big); };
        const std::string body = u8(1) + u8(2) + i16(-3) + i16(-4) + u8(2) + u8(0)                // sensors
                                 + i32(0) + f(1) + f(2) + u8(1) + u8(9) + f(3) + i32(5)           // vertices
                                 + i32(2) + f(.1f) + f(.2f) + f(4) + f(5) + u8(0) + f(6) + i32(6) //
                                 + i32(1) + f(0) + f(7) + f(8) + u8(2) + u8(1) + u8(1) + f(9) + i32(7) //
                                 + u8(3) + i32(0) + i32(1) + i32(2);
        const auto file =
            read("a.ply", ply(big ? "binary_big_endian" : "binary_little_endian", header, body));
        CHECK(file.cloud.positions == expected);
        CHECK(file.cloud.scalars[0].values == std::vector<double>{5, 6, 7});
        CHECK(file.faces == 1);
    }
}

TEST_CASE("PLY headers with CRLF or a byte-order mark are read, also before binary data", "[io]") {
    std::string header =
        "ply\r\nformat binary_little_endian 1.0\r\nelement vertex 1\r\nproperty float x\r\nproperty float "
        "y\r\nproperty float z\r\nend_header\r\n";
    CHECK(read("a.ply", header + float_point(1, 2, 3)).cloud.positions == std::vector<Vec3>{Vec3(1, 2, 3)});
    std::string text = "\xef\xbb\xbfply\rformat ascii 1.0\relement vertex 1\rproperty float x\rproperty "
                       "float y\rproperty float "
                       "z\rend_header\r1 2 3\r";
    CHECK(read("a.ply", text).cloud.positions == std::vector<Vec3>{Vec3(1, 2, 3)});
}

TEST_CASE("a large binary PLY keeps every point in its place", "[io]") {
    const int count = 50000;
    std::string body;
    for (int i = 0; i < count; ++i) {
        const auto v = static_cast<float>(i);
        body += float_point(v, -v, 0.5f * v) + float_point(0, 0, v);
    }
    const auto cloud = read("a.ply", ply("binary_little_endian",
                                         "element vertex 50000\n" + std::string(xyz)
                                             + "property float nx\nproperty float ny\nproperty float nz\n",
                                         body))
                           .cloud;
    REQUIRE(cloud.size() == std::size_t(count));
    REQUIRE(cloud.normals.size() == std::size_t(count));
    bool same = true;
    for (std::size_t i = 0; i < cloud.size(); ++i) {
        const auto v = static_cast<double>(i);
        same &= cloud.positions[i] == Vec3(v, -v, 0.5 * v) && cloud.normals[i] == Vec3(0, 0, v);
    }
    CHECK(same);
}

TEST_CASE("a PLY header that is not one says which line and why", "[io]") {
    const auto error = [](const std::string& text) { return error_of("a.ply", text); };
    const std::string start = "ply\nformat ascii 1.0\n";
    CHECK(error(start + "element vertex 1\nproperty quad x\nend_header\n1\n")
          == "a.ply:4: unknown property type \"quad\"; known are char uchar short ushort int uint float "
             "double");
    CHECK(error(start + "element vertex -1\n").starts_with("a.ply:3: \"-1\" is no count of elements"));
    CHECK(error(start + "element vertex 99999999999999999999999\n").starts_with("a.ply:3: "));
    CHECK(error(start + "property float x\n").starts_with("a.ply:3: a property before the first element"));
    CHECK(error("ply\nformat binary 1.0\n").starts_with("a.ply:2: unknown format \"binary\""));
    CHECK(error("ply\nelement vertex 1\nend_header\n").starts_with("a.ply:3: the header has no format line"));
    CHECK(error(start + "elemnt vertex 1\n").starts_with("a.ply:3: \"elemnt\" is no word of a PLY header"));
    CHECK(error(start + "element vertex 1\nproperty list float int a\n")
              .starts_with("a.ply:4: a list's count must be"));
    CHECK(error(start + "element vertex 1\nproperty float x\n")
          == "a.ply:4: the header has no end_header; the file was cut off");
    CHECK(error(start + "element face 1\nproperty list uchar int v\nend_header\n").find("no element vertex")
          != std::string::npos);
    CHECK(error(start + "element vertex 1\nproperty float x\nproperty float y\nend_header\n1 2\n")
          == "a.ply: the vertices have no properties x, y and z, only \"x, y\"; export them as points");
    CHECK(error(start + "element vertex 0\n" + xyz + "end_header\n")
          == "a.ply: holds no points: the header says element vertex 0");
}

TEST_CASE("a PLY file with fewer or more data than its header says is refused", "[io]") {
    const std::string three = "element vertex 3\n" + std::string(xyz);
    CHECK(error_of("a.ply", ply("ascii", three, "1 2 3\n4 5 6\n"))
          == "a.ply:9: the file ends after 2 of 3 vertices; it was cut off, or its header counts wrong");
    CHECK(
        error_of("a.ply", ply("ascii", three, "1 2 3\n4 5 6\n7 8\n"))
        == "a.ply:10: ends after 2 columns, but the header names 3 properties; complete or remove the line");
    CHECK(error_of("a.ply", ply("ascii", three, "1 2 3\n4 5 6\n7 8 9\n1 1 1\n"))
              .starts_with("a.ply:11: a line behind the last of 3"));
    CHECK(error_of("a.ply", ply("ascii", three, "1 2 3\n4 x5 6\n7 8 9\n"))
          == "a.ply:9: \"x5\" in column 2 is not a number; correct the line or the header");

    const std::string two = float_point(1, 2, 3) + float_point(4, 5, 6);
    for (const char* format : {"binary_little_endian", "binary_big_endian"}) {
        const std::string message = error_of("a.ply", ply(format, three, two + "abc"));
        CHECK(message.starts_with("a.ply: the file ends after 2 of 3 elements vertex (at byte "));
        CHECK(error_of("a.ply", ply(format, three, two + two)).find("12 bytes behind the last of 3 vertices")
              != std::string::npos);
        CHECK(error_of("a.ply", ply(format, three, "")).find("after 0 of 3") != std::string::npos);
    }
}

TEST_CASE("a header that announces billions of points allocates nothing for them", "[io]") {
    // If it did, the sanitizers' allocator or the machine would refuse; here it must be the reader that does.
    for (const char* count : {"1000000000", "4294967295", "18446744073709551615"})
        for (const char* format : {"ascii", "binary_little_endian", "binary_big_endian"}) {
            const std::string header = "element vertex " + std::string(count) + "\n" + xyz;
            CHECK(error_of("a.ply", ply(format, header, "1 2 3\n4 5 6\n")).find("of " + std::string(count))
                  != std::string::npos);
            const std::string list = "element other " + std::string(count)
                                     + "\nproperty list uint double v\nelement vertex 1\n" + xyz;
            CHECK(error_of("a.ply", ply(format, list, "1 2 3\n4 5 6\n")).find("of " + std::string(count))
                  != std::string::npos);
        }
    const std::string list = "element vertex 1\n" + std::string(xyz) + "property list uint double v\n";
    CHECK(error_of("a.ply", ply("binary_little_endian", list, float_point(1, 2, 3) + bytes_of(0xffffffffu)))
              .find("ends in element vertex 0 of 1")
          != std::string::npos);
    const std::string negative = "element vertex 1\n" + std::string(xyz) + "property list int uchar v\n";
    CHECK(error_of("a.ply", ply("binary_little_endian", negative, float_point(1, 2, 3) + bytes_of(-1)))
              .find("a list of negative length in element vertex 0")
          != std::string::npos);
}

TEST_CASE("NaN in a binary PLY is kept for drop_nonfinite to count", "[io]") {
    const std::string header = "element vertex 3\n" + std::string(xyz);
    auto cloud = read("a.ply", ply("binary_little_endian", header,
                                   float_point(1, 2, 3) + float_point(std::nanf(""), 0, 0)
                                       + float_point(4, 5, INFINITY)))
                     .cloud;
    CHECK(cloud.size() == 3);
    CHECK(drop_nonfinite(cloud).nonfinite == 2);
}

TEST_CASE("the sensor is where the PLY file's camera stood, before or behind the vertices", "[io]") {
    const std::string camera = "element camera 1\nproperty float view_px\nproperty float view_py\n"
                               "property float view_pz\nproperty uchar flag\n";
    const std::string vertex = "element vertex 2\n" + std::string(xyz);
    const std::string faces = "element face 1\nproperty list uchar int vertex_indices\n";
    const auto sensor = [](const std::string& format, const std::string& header, const std::string& body) {
        return read("a.ply", ply(format, header, body)).cloud.sensor;
    };
    const std::string at = "1.5 -2 30 7\n", points = "0 0 0\n1 1 1\n", face = "3 0 1 0\n";
    CHECK(sensor("ascii", camera + vertex, at + points) == Vec3(1.5, -2, 30));
    CHECK(sensor("ascii", vertex + faces + camera, points + face + at) == Vec3(1.5, -2, 30));
    for (const bool big : {false, true}) {
        const std::string format = big ? "binary_big_endian" : "binary_little_endian";
        const std::string view = float_point(1.5f, -2, 30, big) + "\7";
        const std::string two = float_point(0, 0, 0, big) + float_point(1, 1, 1, big);
        std::string triangle = "\3";
        for (int v : {0, 1, 0}) triangle += bytes_of(v, big);
        CHECK(sensor(format, camera + vertex, view + two) == Vec3(1.5, -2, 30));
        CHECK(sensor(format, vertex + camera + faces, two + view + triangle) == Vec3(1.5, -2, 30));
        // Behind lists it would cost reading every one of them, and a file cut off there would be an error.
        CHECK_FALSE(sensor(format, vertex + faces + camera, two + triangle + view));
        CHECK_FALSE(sensor(format, vertex + faces + camera, two + triangle.substr(0, 5)));
        CHECK(error_of("a.ply", ply(format, vertex + camera, two + view.substr(1))).find("camera")
              != std::string::npos);
    }
    // Zeros stand for an unknown camera; several cameras are no single sensor.
    CHECK_FALSE(sensor("ascii", camera + vertex, "0 0 0 7\n" + points));
    CHECK_FALSE(sensor("ascii", camera + vertex, "nan 0 0 7\n" + points));
    CHECK_FALSE(sensor("ascii", "element camera 2" + camera.substr(16) + vertex, at + at + points));
    CHECK_FALSE(sensor("ascii", "element camera 1\nproperty int view_px\n" + vertex, "1\n" + points));
    const std::string x = "property float view_px\n", y = "property float view_py\n",
                      z = "property float view_pz\n", one = "element camera 1\n";
    CHECK_FALSE(sensor("ascii", one + x + x + y + vertex, "1 2 3\n" + points)); // no z
    CHECK_FALSE(sensor("ascii", one + x + y + z + z + vertex, "1 2 3 4\n" + points));
    CHECK(sensor("ascii", one + z + y + x + vertex, "1 2 3\n" + points) == Vec3(3, 2, 1));
    CHECK_FALSE(sensor("ascii", camera + vertex + camera, at + points + at));
    CHECK_FALSE(sensor("ascii", camera + vertex + one + x, at + points + "1\n"));
    CHECK_FALSE(sensor("ascii", vertex, points));
}
