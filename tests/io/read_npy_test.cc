#include "hsdm/io/atomic_file.hh"
#include "hsdm/io/zip_archive.hh"
#include "io/npy_bytes.hh"

#include <catch2/catch.hpp>

#include <cmath>
#include <limits>

using namespace hsdm;
using namespace hsdm::test;

namespace {

/// Two points with normals and colours, as numbers of a type: x y z, nx ny nz, r g b.
constexpr double nine_columns[2][9] = {{1, 2, 3, 0, 0, 1, 10, 20, 30}, {-4, 5, 6, 0, 1, 0, 40, 255, 60}};

template <class T>
std::string npy_of(const std::string& type, std::size_t width, bool fortran) {
    const bool big = type[0] == '>';
    std::string data;
    for (std::size_t i = 0; i < 2 * width; ++i) {
        const std::size_t row = fortran ? i % 2 : i / width, column = fortran ? i / 2 : i % width;
        data += bytes_of(static_cast<T>(nine_columns[row][column]), big);
    }
    return npy_file('\'' + type + '\'', fortran, "(2, " + std::to_string(width) + ")", data);
}

template <class T>
std::string doubles_of(const std::vector<T>& values) {
    std::string bytes;
    for (const T value : values) bytes += bytes_of(value);
    return bytes;
}

using Color = std::array<std::uint8_t, 4>;

} // namespace

TEST_CASE("plain NPY arrays of either order of axes and bytes are points with normals and colours", "[io]") {
    for (const std::size_t width : {3u, 6u, 9u})
        for (const bool fortran : {false, true}) {
            const std::pair<std::string, std::string> files[] = {
                {"<f8", npy_of<double>("<f8", width, fortran)},
                {">f8", npy_of<double>(">f8", width, fortran)},
                {"<f4", npy_of<float>("<f4", width, fortran)},
                {">f4", npy_of<float>(">f4", width, fortran)},
                {"<i2", npy_of<std::int16_t>("<i2", width, fortran)},
                {">i4", npy_of<std::int32_t>(">i4", width, fortran)},
                {"<i8", npy_of<std::int64_t>("<i8", width, fortran)},
            };
            for (const auto& [type, content] : files) {
                CAPTURE(type, width, fortran);
                const PointFile file = read("a.npy", content);
                CHECK(file.format == "npy");
                CHECK(file.cloud.positions == std::vector<Vec3>{Vec3(1, 2, 3), Vec3(-4, 5, 6)});
                CHECK(file.cloud.has_normals() == (width >= 6));
                if (width >= 6) CHECK(file.cloud.normals == std::vector<Vec3>{Vec3(0, 0, 1), Vec3(0, 1, 0)});
                REQUIRE(file.cloud.colors.size() == (width == 9 ? 2 : 0));
                if (width == 9) CHECK(file.cloud.colors[1] == Color{40, 255, 60, 255});
                CHECK(file.columns
                      == (width == 9   ? "x,y,z,nx,ny,nz,r,g,b"
                          : width == 6 ? "x,y,z,nx,ny,nz"
                                       : ""));
            }
        }
}

TEST_CASE("structured NPY arrays are read by their fields' names, padding and nested fields too", "[io]") {
    std::string data;
    for (int i = 0; i < 2; ++i)
        data += bytes_of(float(i)) + "pad." + bytes_of(double(2), true) + bytes_of(std::int16_t(3))
                + bytes_of(0.0f) + bytes_of(0.0f) + bytes_of(1.0f) + "name" + bytes_of(std::uint8_t(9))
                + "\xff\x01\x02" + "\x07";
    const PointFile file =
        read("a.npy", npy_file("[('x', '<f4'), ('', '|V4'), ('y', '>f8'), (('title', 'z'), '<i2'), "
                               "('normal', '<f4', (3,)), ('who', 'S4'), ('label', '|u1'), "
                               "('rgb', '|u1', (3,)), ('more', [('flag', '|b1')])]",
                               false, "(2,)", data));
    CHECK(file.cloud.positions == std::vector<Vec3>{Vec3(0, 2, 3), Vec3(1, 2, 3)});
    CHECK(file.cloud.normals == std::vector<Vec3>{Vec3(0, 0, 1), Vec3(0, 0, 1)});
    CHECK(file.cloud.colors == std::vector<Color>{{255, 1, 2, 255}, {255, 1, 2, 255}});
    REQUIRE(file.cloud.scalars.size() == 2);
    CHECK(file.cloud.scalars[0].is_label);
    CHECK(file.cloud.scalars[1].name == "more_flag");
    CHECK(file.cloud.scalars[1].values == std::vector<double>{7, 7});
}

TEST_CASE("columns say what those of a plain NPY array are", "[io]") {
    const std::string content = npy_of<double>("<f8", 6, false);
    const PointFile file = read("a.npy", content, {.columns = "_,_,_,z,y,x"});
    CHECK(file.cloud.positions == std::vector<Vec3>{Vec3(1, 0, 0), Vec3(0, 1, 0)});
    CHECK(file.columns.empty());
    CHECK(error_of("a.npy", content, {.columns = "x,y,z,_,_,_,_"}).find("has 6 columns, but 7 are named")
          != std::string::npos);
}

TEST_CASE("NPY arrays that are no points say so, and what to save instead", "[io]") {
    using Catch::Contains;
    const auto complaint = [](const std::string& type, const std::string& shape, std::size_t bytes) {
        return error_of("a.npy", npy_file(type, false, shape, std::string(bytes, '\0')));
    };
    CHECK_THAT(complaint("'<f8'", "(6,)", 48),
               Contains("shape (6,)") && Contains("rows of three or more numbers"));
    CHECK_THAT(complaint("'<f8'", "(2, 2)", 32), Contains("points have three numbers or more"));
    CHECK_THAT(complaint("'<f8'", "(3, 100)", 2400), Contains("save its transpose (array.T)"));
    CHECK_THAT(complaint("'<f8'", "(0, 3)", 0), Contains("holds no points"));
    CHECK_THAT(complaint("'|O'", "(2, 3)", 48), Contains("Python objects") && Contains("astype(float)"));
    CHECK_THAT(complaint("'<f2'", "(2, 3)", 12), Contains("\"<f2\", which is not read"));
    CHECK_THAT(complaint("'<c16'", "(2, 3)", 96), Contains("\"<c16\", which is not read"));
    CHECK_THAT(complaint("'<U2'", "(2, 3)", 48), Contains("array of texts"));
    CHECK_THAT(complaint("[('a', '<f4')]", "(2,)", 8), Contains("no fields x, y and z, only \"a\""));
    CHECK_THAT(complaint("'<f8'", "(2, 3)", 49), Contains("1 bytes behind the array (2, 3) (at byte"));
    CHECK_THAT(complaint("'<f8'", "(1152921504606846976, 3)", 48),
               Contains("more elements than can be counted"));
    CHECK_THAT(complaint("'<f8'", "(100000000000, 3)", 48), Contains("ends after 48 of 2400000000000 bytes"));
    CHECK_THAT(error_of("a.npy", "\x93NUMPY\x09" + std::string(20, '\0')),
               Contains("version 9 is not known (at byte 6)"));
    CHECK_THAT(complaint(std::string(100, '['), "(2, 3)", 48), Contains("lists within lists"));
    CHECK_THAT(error_of("a.npy", "\x93NUMPY" + std::string("\2\0\xff\xff\xff\x7f", 6) + "{'descr': "),
               Contains("an NPY header of 2147483647 bytes (at byte 8)"));
}

TEST_CASE("an NPY file that is cut off anywhere is refused", "[io]") {
    for (const std::string& file :
         {npy_of<float>("<f4", 9, true),
          npy_file("[('x', '<f4'), ('y', '<f4'), ('z', '<f4')]", false, "(2,)", std::string(24, '\0'))})
        for (std::size_t size = 0; size < file.size(); ++size) {
            CAPTURE(size);
            const std::string message = error_of("a.npy", file.substr(0, size));
            REQUIRE(!message.empty());
            if (size >= 6) REQUIRE(message.find("byte " + std::to_string(size)) != std::string::npos);
        }
}

TEST_CASE("NPZ archives give points, normals, colours and scalars by their arrays' names", "[io]") {
    const std::string points = npy_file("'<f8'", false, "(2, 3)", doubles_of<double>({1, 2, 3, 4, 5, 6}));
    const std::string normals = npy_file("'<f4'", true, "(2, 3)", doubles_of<float>({0, 0, 0, 1, 1, 0}));
    const std::string colors = npy_file("'<f4'", false, "(2, 3)", doubles_of<float>({0, 1, 0.5f, 1, 0, 0}));
    const std::string label = npy_file("'<i8'", false, "(2,)", doubles_of<std::int64_t>({7, 8}));
    const std::string column = npy_file("'<f4'", false, "(2, 1)", doubles_of<float>({0.5f, 0.25f}));
    const std::string other = npy_file("'<f8'", false, "(3,)", doubles_of<double>({0, 0, 0}));
    for (const bool deflated : {false, true})
        for (const char* name : {"points", "Positions", "xyz", "pcd", "arr_0"}) {
            CAPTURE(deflated, name);
            const PointFile file =
                read("a.npz", zip_file({{std::string(name) + ".npy", points},
                                        {"normals.npy", normals},
                                        {"colors.npy", colors},
                                        {"label.npy", label},
                                        {"weight.npy", column},
                                        {"other.npy", other},
                                        {"who.npy", npy_file("'<U1'", false, "(2,)", "12345678")},
                                        {"objects.npy", npy_file("'|O'", false, "(2,)", "?")},
                                        {"notes.txt", "words"}},
                                       deflated));
            CHECK(file.format == "npz");
            CHECK(file.cloud.positions == std::vector<Vec3>{Vec3(1, 2, 3), Vec3(4, 5, 6)});
            CHECK(file.cloud.normals == std::vector<Vec3>{Vec3(0, 0, 1), Vec3(0, 1, 0)});
            CHECK(file.cloud.colors == std::vector<Color>{{0, 255, 128, 255}, {255, 0, 0, 255}});
            REQUIRE(file.cloud.scalars.size() == 2);
            CHECK(file.cloud.scalars[0].name == "label");
            CHECK(file.cloud.scalars[0].is_label);
            CHECK(file.cloud.scalars[1].values == std::vector<double>{0.5, 0.25});
        }
}

TEST_CASE("NPZ archives may hold x, y and z apart, or one structured array", "[io]") {
    const auto axis = [](double value) {
        return npy_file("'<f8'", false, "(2,)", doubles_of<double>({value, value + 1}));
    };
    const PointFile apart = read(
        "a.npz",
        zip_file({{"x.npy", axis(1)}, {"y.npy", axis(2)}, {"z.npy", axis(3)}, {"t.npy", axis(4)}}, true));
    CHECK(apart.cloud.positions == std::vector<Vec3>{Vec3(1, 2, 3), Vec3(2, 3, 4)});
    REQUIRE(apart.cloud.scalars.size() == 1);
    CHECK(apart.cloud.scalars[0].name == "t");
    const std::string table = npy_file("[('x', '<f4'), ('y', '<f4'), ('z', '<f4')]", false, "(2,)",
                                       doubles_of<float>({1, 2, 3, 4, 5, 6}));
    CHECK(read("a.npz", zip_file({{"whatever.npy", table}}, false)).cloud.positions.back() == Vec3(4, 5, 6));
}

TEST_CASE("NPZ archives without points, with arrays that do not fit, or damaged say what is wrong", "[io]") {
    using Catch::Contains;
    const std::string points = npy_file("'<f8'", false, "(2, 3)", doubles_of<double>({1, 2, 3, 4, 5, 6}));
    const std::string four = npy_file("'<f8'", false, "(4, 3)", std::string(96, '\0'));
    CHECK_THAT(error_of("a.npz", zip_file({{"a.npy", points}, {"b.npy", four}}, true)),
               Contains("has no array of points, only \"a (2, 3), b (4, 3)\"")
                   && Contains("call one of shape (n, 3) points"));
    CHECK_THAT(error_of("a.npz", zip_file({{"points.npy", points}, {"normals.npy", four}}, true)),
               Contains("\"normals\" is of shape (4, 3), which does not fit 2 points"));
    std::string broken = zip_file({{"points.npy", points}}, false);
    broken[broken.find("NUMPY") + 140] ^= 1;
    CHECK_THAT(error_of("a.npz", broken), Contains("points.npy") && Contains("damaged"));
    CHECK_THAT(error_of("a.zip", zip_file({{"a.txt", "words"}}, false)),
               Contains("is a ZIP file, which is not read"));
}

TEST_CASE("an NPZ archive whose members share their bytes is refused, since together they are longer than it",
          "[io]") {
    const std::string points = npy_file("'<f8'", false, "(20, 3)", std::string(480, '\1'));
    CHECK(read("a.npz", shared_zip_file({"points.npy"}, points)).cloud.size() == 20);
    CHECK(error_of("a.npz", shared_zip_file({"points.npy", "b.npy", "c.npy"}, points))
          == "a.npz: the ZIP archive has members that lie over each other; it was cut off, or is damaged");
}

TEST_CASE("an array of texts in an NPZ archive is not taken for points, whatever its shape", "[io]") {
    const std::string points = npy_file("'<f8'", false, "(2, 3)", doubles_of<double>({1, 2, 3, 4, 5, 6}));
    const std::string texts = npy_file("'<U1'", false, "(2, 3)", std::string(24, 'u'));
    const PointFile file = read("a.npz", zip_file({{"who.npy", texts}, {"scan.npy", points}}, true));
    CHECK(file.cloud.positions == std::vector<Vec3>{Vec3(1, 2, 3), Vec3(4, 5, 6)});
    CHECK(
        error_of("a.npz", zip_file({{"points.npy", texts}}, true)).find("is an array of texts; save numbers")
        != std::string::npos);
}

TEST_CASE("an NPZ archive that is cut off anywhere is refused", "[io]") {
    const std::string points = npy_file("'<f4'", false, "(2, 3)", doubles_of<float>({1, 2, 3, 4, 5, 6}));
    for (const bool deflated : {false, true}) {
        const std::string file = zip_file({{"points.npy", points}}, deflated);
        for (std::size_t size = 0; size < file.size(); ++size) {
            CAPTURE(deflated, size);
            REQUIRE(!error_of("a.npz", file.substr(0, size)).empty());
        }
    }
}
