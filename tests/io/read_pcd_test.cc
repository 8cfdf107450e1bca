#include "io/pack_lzf.hh"
#include "io/temp_file.hh"

#include <catch2/catch.hpp>

#include <cmath>
#include <limits>

using namespace hsdm;
using namespace hsdm::test;

namespace {

constexpr float nan_value = std::numeric_limits<float>::quiet_NaN();

std::string pcd(const std::string& fields, const std::string& size, const std::string& points,
                const std::string& data, const std::string& viewpoint = "0 0 0 1 0 0 0") {
    return "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\nFIELDS " + fields + "\n" + size
           + "WIDTH " + points + "\nHEIGHT 1\nVIEWPOINT " + viewpoint + "\nPOINTS " + points + "\nDATA "
           + data + "\n";
}

} // namespace

TEST_CASE("PCD points are read from text and binary, with normals, colour and other fields", "[io]") {
    const std::string fields = "x y z normal_x normal_y normal_z rgb curvature";
    const std::string sizes = "SIZE 4 4 8 4 4 4 4 2\nTYPE F F F F F F F U\nCOUNT 1 1 1 1 1 1 1 1\n";
    const std::uint32_t packed = 0x00c86432; // 200, 100, 50
    const float packed_float = std::bit_cast<float>(packed);
    char number[32];
    std::snprintf(number, sizeof number, "%.9g", static_cast<double>(packed_float));
    const std::string text = pcd(fields, sizes, "2", "ascii") + "1 2 3.25 0 0 1 " + number
                             + " 7\n-1 0.5 4 1 0 0 " + number + " 9\n";
    std::string binary = pcd(fields, sizes, "2", "binary");
    for (int i = 0; i < 2; ++i) {
        binary += bytes_of(i == 0 ? 1.0f : -1.0f) + bytes_of(i == 0 ? 2.0f : 0.5f);
        binary += bytes_of(i == 0 ? 3.25 : 4.0);
        binary += bytes_of(i == 0 ? 0.0f : 1.0f) + bytes_of(0.0f) + bytes_of(i == 0 ? 1.0f : 0.0f);
        binary += bytes_of(packed) + bytes_of(std::uint16_t(i == 0 ? 7 : 9));
    }
    for (const std::string& content : {text, binary}) {
        const PointFile file = read("a.xyz", content); // whatever it is called
        CHECK(file.format == "pcd");
        CHECK(file.cloud.positions == std::vector<Vec3>{Vec3(1, 2, 3.25), Vec3(-1, 0.5, 4)});
        CHECK(file.cloud.normals == std::vector<Vec3>{Vec3(0, 0, 1), Vec3(1, 0, 0)});
        REQUIRE(file.cloud.colors.size() == 2);
        CHECK(file.cloud.colors[1] == std::array<std::uint8_t, 4>{200, 100, 50, 255});
        REQUIRE(file.cloud.scalars.size() == 1);
        CHECK(file.cloud.scalars[0].name == "curvature");
        CHECK(file.cloud.scalars[0].values == std::vector<double>{7, 9});
        CHECK_FALSE(file.cloud.sensor);
    }
}

namespace {

/// The same points as bytes of a binary file and packed field by field.
struct TwoForms {
    std::string binary, packed, values;
};

TwoForms two_forms(int count) {
    const std::string fields = "x y z _ histogram stamp rgb";
    const std::string sizes = "SIZE 4 8 2 1 4 8 4\nTYPE F F I U F U U\nCOUNT 1 1 1 3 2 1 1\n";
    TwoForms forms;
    forms.binary = pcd(fields, sizes, std::to_string(count), "binary", "1 2 3 1 0 0 0");
    std::array<std::string, 7> columns;
    for (int i = 0; i < count; ++i) {
        const std::array<std::string, 7> point{bytes_of(static_cast<float>(i)),
                                               bytes_of(0.5 * i),
                                               bytes_of(static_cast<std::int16_t>(i % 7)),
                                               std::string("abc"),
                                               bytes_of(0.f) + bytes_of(static_cast<float>(i * i)),
                                               bytes_of(std::uint64_t(i)),
                                               bytes_of(std::uint32_t(i))};
        for (std::size_t f = 0; f < point.size(); ++f) {
            forms.binary += point[f];
            columns[f] += point[f];
        }
    }
    for (const std::string& column : columns) forms.values += column;
    forms.packed = pcd(fields, sizes, std::to_string(count), "binary_compressed", "1 2 3 1 0 0 0");
    return forms;
}

std::string with_sizes(const std::string& packed, std::size_t size) {
    return bytes_of(static_cast<std::uint32_t>(packed.size())) + bytes_of(static_cast<std::uint32_t>(size))
           + packed;
}

} // namespace

TEST_CASE("compressed PCD files give the cloud of the binary ones", "[io]") {
    for (int count : {1, 5, 20000}) {
        const TwoForms forms = two_forms(count);
        const std::string packed = pack_lzf(forms.values);
        if (count > 5) CHECK(packed.size() < forms.values.size());
        const PointCloud binary = read("a.pcd", forms.binary).cloud;
        // What lies behind the packed bytes is padding to whole pages in files of some programs.
        const PointFile file =
            read("a.pcd", forms.packed + with_sizes(packed, forms.values.size()) + std::string(100, '\0'));
        CHECK(file.format == "pcd");
        CHECK(file.cloud.positions == binary.positions);
        CHECK(file.cloud.colors == binary.colors);
        REQUIRE(file.cloud.scalars.size() == binary.scalars.size());
        for (std::size_t s = 0; s < binary.scalars.size(); ++s)
            CHECK(file.cloud.scalars[s].values == binary.scalars[s].values);
        REQUIRE(file.cloud.sensor);
        CHECK(*file.cloud.sensor == Vec3(1, 2, 3));
    }
}

TEST_CASE("compressed PCD files that are damaged are refused, whatever sizes they announce", "[io]") {
    const TwoForms forms = two_forms(100);
    const std::string packed = pack_lzf(forms.values);
    const auto says = [&](const std::string& body, const std::string& part) {
        const std::string message = error_of("a.pcd", forms.packed + body);
        UNSCOPED_INFO(message);
        return message.find(part) != std::string::npos;
    };
    const std::size_t size = forms.values.size();
    CHECK(says("", "ends behind its header; it was cut off"));
    CHECK(says("1234567", "ends behind its header; it was cut off"));
    CHECK(says(with_sizes(packed, size).substr(0, 50), "the file ends after 42 of "));
    CHECK(says(with_sizes(packed, size + 1), "do not fit 100 points of 37"));
    CHECK(says(with_sizes(packed, size - 37), "do not fit 100 points of 37"));
    CHECK(says(with_sizes(packed.substr(0, 10), size), "do not fit 100 points of 37"));
    CHECK(says(with_sizes(packed.substr(0, packed.size() - 1), size), "the compressed data are damaged"));
    CHECK(says(with_sizes(packed + "\1ab", size), "the compressed data are damaged"));
    std::string huge =
        forms.packed; // as many points as the size announces, of which next to nothing is there
    for (std::size_t at; (at = huge.find(" 100\n")) != std::string::npos;)
        huge.replace(at, 5, " 100000000\n");
    const std::string message = error_of("a.pcd", huge + with_sizes(packed, 3700000000));
    CHECK(message.find("do not fit 100000000 points of 37") != std::string::npos);
}

TEST_CASE("fields of several values and of eight bytes are read, those for padding passed by in PCD files",
          "[io]") {
    std::string binary = pcd("_ x y z histogram stamp rgba",
                             "SIZE 1 4 4 4 4 8 4\nTYPE U F F F F U U\nCOUNT 3 1 1 1 2 1 1\n", "1", "binary");
    binary += "abc" + bytes_of(1.0f) + bytes_of(2.0f) + bytes_of(3.0f) + bytes_of(0.5f) + bytes_of(0.25f)
              + bytes_of(std::uint64_t(1) << 60) + bytes_of(0x80010203u);
    const PointCloud cloud = read("a.pcd", binary).cloud;
    CHECK(cloud.positions == std::vector<Vec3>{Vec3(1, 2, 3)});
    CHECK(cloud.colors == std::vector<std::array<std::uint8_t, 4>>{{1, 2, 3, 0x80}});
    REQUIRE(cloud.scalars.size() == 3);
    CHECK(cloud.scalars[1].name == "histogram_1");
    CHECK(cloud.scalars[1].values == std::vector<double>{0.25});
    CHECK(cloud.scalars[2].values == std::vector<double>{std::ldexp(1, 60)});
}

TEST_CASE("pixels of a PCD file without a measurement are no points, its viewpoint is the sensor", "[io]") {
    std::string content = "VERSION .7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nWIDTH 2\nHEIGHT 2\n"
                          "VIEWPOINT 1 2 -3 1 0 0 0\nPOINTS 4\nDATA binary\n";
    for (float x : {nan_value, 1.0f, nan_value, nan_value})
        content += bytes_of(x) + bytes_of(0.0f) + bytes_of(2.0f);
    const PointFile file = read("a.pcd", content);
    CHECK(file.nonfinite == 3);
    const PointCloud& cloud = file.cloud;
    CHECK(cloud.positions == std::vector<Vec3>{Vec3(1, 0, 2)});
    REQUIRE(cloud.sensor);
    CHECK(*cloud.sensor == Vec3(1, 2, -3));
}

TEST_CASE("PCD files that are damaged or not read are refused where they go wrong", "[io]") {
    const std::string sizes = "SIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\n";
    const auto says = [](const std::string& content, const std::string& part) {
        const std::string message = error_of("a.pcd", content);
        UNSCOPED_INFO(message);
        return message.find(part) != std::string::npos;
    };
    CHECK(says(pcd("x y z", sizes, "1", "binary_zipped"), "a.pcd:11: unknown data \"binary_zipped\""));
    CHECK(says("VERSION .7\nFIELDS x y z\nWIDTH 9223372036854775809\nHEIGHT 2\nDATA ascii\n1 2 3\n4 5 6\n",
               "WIDTH times HEIGHT is more than can be counted"));
    CHECK(says(pcd("x y z", sizes, "2", "ascii") + "1 2 3\n", "the file ends after 1 of 2"));
    CHECK(says(pcd("x y z", sizes, "2", "binary") + bytes_of(1.0), "cut off"));
    CHECK(says(pcd("x y", sizes, "2", "ascii"), "a.pcd:4: 3 values for 2 FIELDS"));
    CHECK(says(pcd("x y w", sizes, "1", "ascii") + "1 2 3\n", "no fields x, y and z"));
    CHECK(says(pcd("x y z", "SIZE 4 4 3\n", "1", "ascii"), "\"3\" is no size of a field"));
    CHECK(says(pcd("x y z", sizes + "TYPE F F X\n", "1", "ascii"), "unknown type \"X\""));
    CHECK(says(pcd("x y z", sizes + "WIDE 3\n", "1", "ascii"), "\"WIDE\" is no word of a PCD header"));
    CHECK(says("# .PCD v.7\nVERSION .7\nFIELDS x y z\n", "no line DATA"));
    std::string two_rows = pcd("x y z", sizes, "4", "ascii");
    two_rows.replace(two_rows.find("HEIGHT 1"), 8, "HEIGHT 2");
    CHECK(says(two_rows, "POINTS is 4, WIDTH times HEIGHT 8"));
    CHECK(says(pcd("x y z", sizes, "0", "ascii"), "holds no points"));
    CHECK(says(pcd("x y z", sizes, "1", "binary") + bytes_of(nan_value) + bytes_of(0.0f) + bytes_of(0.0f),
               "no coordinates are finite"));
}
