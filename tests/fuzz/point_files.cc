#include "fuzz/point_files.hh"

#include "hsdm/errors.hh"
#include "hsdm/io/formats.hh"
#include "io/las_bytes.hh"
#include "io/npy_bytes.hh"
#include "io/pack_lzf.hh"
#include "io/temp_file.hh"

#include <algorithm>
#include <sstream>

namespace hsdm::test {
namespace {

std::string binary_ply(bool big) {
    std::string text =
        "ply\nformat binary_" + std::string(big ? "big" : "little")
        + "_endian 1.0\nelement camera 1\nproperty list uchar int a\nelement vertex 4\nproperty float x\n"
          "property double y\nproperty short z\nproperty ushort red\nproperty ushort green\nproperty ushort "
          "blue\nproperty int label\nelement face 1\nproperty list uchar int v\nend_header\n";
    text += bytes_of(std::uint8_t(1)) + bytes_of(std::int32_t(7), big);
    for (int i = 0; i < 4; ++i) {
        text += bytes_of(static_cast<float>(i), big) + bytes_of(0.5 * i, big)
                + bytes_of(static_cast<std::int16_t>(i), big);
        for (int k = 0; k < 3; ++k) text += bytes_of(static_cast<std::uint16_t>(1000 * i), big);
        text += bytes_of(std::int32_t(i), big);
    }
    return text + bytes_of(std::uint8_t(1)) + bytes_of(std::int32_t(0), big);
}

std::string binary_pcd() {
    std::string text = "VERSION .7\nFIELDS x y z _ stamp rgba\nSIZE 4 8 2 1 8 4\nTYPE F F I U U U\n"
                       "COUNT 1 1 1 3 1 1\nWIDTH 2\nHEIGHT 2\nDATA binary\n";
    for (int i = 0; i < 4; ++i)
        text += bytes_of(static_cast<float>(i)) + bytes_of(0.5 * i) + bytes_of(static_cast<std::int16_t>(i))
                + "abc" + bytes_of(std::uint64_t(i)) + bytes_of(std::uint32_t(i));
    return text;
}

std::string compressed_pcd() {
    std::string values(8 * 4, '\0');
    for (int i = 0; i < 8; ++i) values += bytes_of(static_cast<float>(i));
    const std::string packed = pack_lzf(values);
    return "VERSION .7\nFIELDS x y z rgb\nSIZE 4 4 4 4\nTYPE F F F U\nWIDTH 4\nPOINTS 4\n"
           "DATA binary_compressed\n"
           + bytes_of(static_cast<std::uint32_t>(packed.size()))
           + bytes_of(static_cast<std::uint32_t>(values.size())) + packed;
}

std::string list_ply() {
    std::string text =
        "ply\nformat binary_little_endian 1.0\nelement vertex 3\nproperty float x\nproperty list int short "
        "t\nproperty float y\nproperty float z\nproperty float red\nproperty float green\nproperty float "
        "blue\nend_header\n";
    for (int i = 0; i < 3; ++i) {
        text += bytes_of(1.f) + bytes_of(std::int32_t(i)) + std::string(static_cast<std::size_t>(2 * i), 'a');
        for (int k = 0; k < 5; ++k) text += bytes_of(0.25f * static_cast<float>(k));
    }
    return text;
}

std::string binary_stl() {
    std::string text(80, ' ');
    text += bytes_of(std::uint32_t(2));
    for (int f = 0; f < 2; ++f) {
        for (int i = 0; i < 12; ++i) text += bytes_of(static_cast<float>(i * f));
        text += std::string(2, '\0');
    }
    return text;
}

/// A triangle as OpenMesh 9 writes it, with half-edges, marks and a property.
std::string half_edge_om() {
    const auto chunk = [](int entity, int type, int rest) {
        return bytes_of(static_cast<std::uint16_t>(entity << 2 | type << 5 | rest));
    };
    constexpr int floats = 1 << 10, three = 2 << 11;
    std::string text = "OMP\x42";
    for (const std::uint32_t count : {3u, 1u, 3u}) text += bytes_of(count);
    text += chunk(0, 0, floats | three);
    for (const float x : {0.f, 0.f, 0.f, 1.f, 0.f, 0.f, 0.f, 1.f, 0.f}) text += bytes_of(x);
    text += chunk(6, 7, floats | three); // of each half-edge the next, its end and its face
    text += std::string("\2\1\0\5\0\xff\4\2\0\1\1\xff\0\0\0\3\2\xff", 18);
    text += chunk(0, 7, floats) + std::string("\1\3\5", 3) + chunk(2, 7, floats) + '\0';
    text += chunk(4, 3, 0) + bytes_of(std::uint32_t(16)) + std::string(8, '\0');
    text += chunk(0, 6, 2) + "\5label" + "\7int32_t" + bytes_of(std::uint32_t(12)) + std::string(12, '\1');
    return text + chunk(7, 0, 0);
}

std::string las(int minor, int format) {
    LasLayout layout;
    layout.minor = minor;
    layout.format = format;
    layout.records = {"words"};
    layout.extra = minor == 4 ? "x" : "";
    return las_file(layout, {{{1, 2, 3}, 4, 5, false, 6, {7, 8, 9}},
                             {{-1, -2, -3}, 4, 5, true, 6, {7, 8, 900}},
                             {{0, 0, 0}, 1, 1, false, 1, {1, 1, 1}}});
}

std::string npy(bool fortran) {
    std::string data;
    for (const float value : {1.0f, 2.0f, 3.0f, 0.0f, 0.0f, 1.0f, 4.0f, 5.0f, 6.0f, 0.0f, 1.0f, 0.0f})
        data += bytes_of(value, fortran);
    return npy_file(fortran ? "'>f4'" : "'<f4'", fortran, "(2, 6)", data);
}

std::string structured_npy() {
    const std::string row = bytes_of(1.0) + bytes_of(std::int16_t(2)) + bytes_of(3.0f) + "abcd" + "\1\2\3";
    return npy_file("[('x', '<f8'), ('y', '<i2'), ('z', '<f4'), ('', '|V4'), ('rgb', '|u1', (3,))]", false,
                    "(2,)", row + row);
}

std::string npz(bool deflated) {
    const std::string label =
        npy_file("'<i8'", false, "(2,)", bytes_of(std::int64_t(1)) + bytes_of(std::int64_t(2)));
    return zip_file({{"points.npy", npy(false)}, {"label.npy", label}}, deflated);
}

std::string check(const PointCloud& cloud) {
    const std::size_t n = cloud.size();
    if (n == 0) return "a cloud without points";
    if (!cloud.normals.empty() && cloud.normals.size() != n) return "normals do not fit the points";
    if (!cloud.colors.empty() && cloud.colors.size() != n) return "colours do not fit the points";
    for (const Scalar& scalar : cloud.scalars)
        if (scalar.values.size() != n) return "scalars do not fit the points";
    return "";
}

} // namespace

std::vector<NamedContent> valid_point_files() {
    return {
        {"a.xyz", "1 2 3\n4 5 6\n7 8 9\n"},
        {"a.xyz", "# c\n3\n1 2 3 0 0 1\n4 5 6 0 1 0\r\n7 8 9 1 0 0\n"},
        {"a.csv", "x,y,z,r,g,b,label,nx,ny,nz\n1,2,3,1,2,3,4,0,0,1\n1,2,,1,2,3,4,0,0,1\n"},
        {"a.txt", "1.5;2;3;255;0;17\n\n4;nan;-inf;0;0;0 // c\n"},
        {"a.ptx",
         "2\n1\n5 6 7\n1 0 0\n0 1 0\n0 0 1\n1 0 0 0\n0 1 0 0\n0 0 1 0\n5 6 7 1\n1 2 3 0.5\n4 5 6 0.5\n"},
        {"a.pts", "2\n1 2 3 -7 1 2 3\n4 5 6 8 4 5 6\n1\n7 8 9 1 7 8 9\n"},
        {"a.pwn", "2\n1 2 3\n4 5 6\n0 0 1\n0 1 0\n"},
        {"a.off", "CNOFF\n# c\n2 1 0\n1 2 3 0 0 1 255 0 0 255\n4 5 6 0 0 1 0 0 0 255\n3 0 1 1\n"},
        {"a.obj", "# c\nv 1 2 3 0.5 0.5 1\nvn 0 0 1\nv 4 5 6 0 0 0\nvn 1 0 0\nf 1 2 1\n"},
        {"a.p", "# c\np 1 2 3\nq\np 4 5 6\n"},
        {"a.stl", "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 "
                  "0\nendloop\nendfacet\nendsolid\n"},
        {"b.stl", binary_stl()},
        {"a.om", half_edge_om()},
        {"a.ply", "ply\nformat ascii 1.0\ncomment c\nelement vertex 2\nproperty float x\nproperty float "
                  "y\nproperty float z\n"
                  "property list uchar int t\nproperty uchar red\nproperty uchar green\nproperty uchar "
                  "blue\nelement face 1\n"
                  "property list uchar int v\nend_header\n1 2 3 1 9 1 2 3\n4 5 6 0 4 5 6\n3 0 1 1\n"},
        {"b.ply", binary_ply(false)},
        {"c.ply", binary_ply(true)},
        {"d.ply", list_ply()},
        {"a.pcd", "# .PCD v.7\nVERSION .7\nFIELDS x y z rgb normal_x normal_y normal_z\nSIZE 4 4 4 4 4 4 4\n"
                  "TYPE F F F U F F F\nWIDTH 3\nHEIGHT 1\nVIEWPOINT 1 2 3 1 0 0 0\nPOINTS 3\nDATA ascii\n"
                  "1 2 3 255 0 0 1\nnan 5 6 65280 0 1 0\n4 5 6 7 1 0 0\n"},
        {"b.pcd", binary_pcd()},
        {"c.pcd", compressed_pcd()},
        {"a.las", las(2, 2)},
        {"b.las", las(4, 7)},
        {"a.npy", npy(false)},
        {"b.npy", npy(true)},
        {"c.npy", structured_npy()},
        {"a.npz", npz(false)},
        {"b.npz", npz(true)},
    };
}

std::string damaged(const std::string& content, support::Random& random) {
    static const std::string pieces[] = {
        "4294967295",
        "18446744073709551616",
        "-1",
        "1e400",
        "nan",
        "1.#IND",
        "\n",
        "\r",
        "\r\n",
        ",",
        ";;",
        "#",
        "//",
        "\xef\xbb\xbf",
        std::string(1, '\0'),
        "\xff\xff\xff\xff",
        "OFF",
        "ply\n",
        "solid",
        "element vertex 9\n",
        "property list int int q\n",
        "property double x\n",
        "COUNT 1 1 1 999\n",
        "POINTS 9\n",
        "DATA binary\n",
        "DATA binary_compressed\n",
        "p 1 2 3\n",
        "v 1 2 3\n",
        " ",
        "+",
        "1000000000",
    };
    std::string text = content;
    for (std::size_t changes = 1 + random.below(8); changes > 0; --changes) {
        const std::size_t at = random.below(text.size() + 1),
                          length = random.below(std::min<std::size_t>(text.size() - at, 16) + 1);
        switch (random.below(7)) {
        case 0:
            if (at < text.size()) text[at] = static_cast<char>(text[at] ^ (1 << random.below(8)));
            break;
        case 1:
            if (at < text.size()) text[at] = static_cast<char>(random.below(256));
            break;
        case 2:
            text.erase(at, length);
            break;
        case 3:
            text.insert(at, pieces[random.below(std::size(pieces))]);
            break;
        case 4:
            text.replace(at, length, pieces[random.below(std::size(pieces))]);
            break;
        case 5:
            text.insert(random.below(text.size() + 1), text.substr(at, length));
            break;
        default:
            if (random.below(4) == 0) text.resize(at);
        }
    }
    return text;
}

std::string fuzz_reading(std::uint64_t seed, int rounds) {
    const auto files = valid_point_files();
    support::Random random(seed);
    const std::string columns[] = {"", "", "", "x,y,z", "_,z,y,x,label", "x,y,z,nx,ny,nz,r,g,b"};
    const std::string formats[] = {"",   "",    "",    "ply", "pcd",   "xyz", "off", "obj", "stl",
                                   "om", "pts", "ptx", "pwn", "hoppe", "las", "npy", "npz"};
    for (int round = 0; round < rounds; ++round)
        for (const NamedContent& file : files) {
            std::istringstream stream(damaged(file.content, random));
            const ReadOptions options{formats[random.below(std::size(formats))],
                                      columns[random.below(std::size(columns))]};
            std::string fault;
            try {
                fault = check(io::read_points(io::SourceBytes::read(stream, file.name), options).cloud);
            } catch (const Error&) {       // what damage must end in, if it shows
            } catch (const OptionError&) { // columns of what is no table
            } catch (const std::exception& error) {
                fault = error.what();
            }
            if (!fault.empty())
                return file.name + " in round " + std::to_string(round) + ": " + fault + "\n" + stream.str();
        }
    return "";
}

} // namespace hsdm::test
