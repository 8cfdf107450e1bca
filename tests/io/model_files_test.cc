// GLB and 3MF, held to their specifications; other programs read them in tests/interop.
#include "hsdm/errors.hh"
#include "hsdm/io/write_mesh.hh"
#include "hsdm/io/zip_archive.hh"
#include "support/folder.hh"

#include <nlohmann/json.hpp>

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <cstring>

using namespace hsdm;
using support::Folder;

namespace {

/// A square roof of four triangles and a square, with normals and colours; `size` across.
PolygonMesh pyramid(double size) {
    PolygonMesh mesh;
    mesh.positions = {{0, 0, 0}, {size, 0, 0}, {size, size, 0}, {0, size, 0}, {size / 2, size / 2, size}};
    mesh.add_facet(std::array<Index, 4>{3, 2, 1, 0});
    for (Index k = 0; k < 4; ++k) mesh.add_facet(std::array<Index, 3>{k, (k + 1) % 4, 4});
    mesh.normals.assign(5, Vec3(0, 0, 1));
    for (const char* name : {"red", "green", "blue"})
        mesh.properties.push_back({name, VertexProperty::Type::uint8, {0, 64, 128, 192, 255}});
    return mesh;
}

template <class T>
T number_at(const std::string& bytes, std::size_t at) {
    T value;
    REQUIRE(at + sizeof value <= bytes.size());
    std::memcpy(&value, bytes.data() + at, sizeof value);
    return value;
}

/// A GLB file by sections 4.4 and 3.6 of glTF 2.0: its chunks, and arrays that lie within them.
struct GlbParts {
    nlohmann::json json;
    std::string numbers;

    explicit GlbParts(const std::string& file) {
        CHECK(file.starts_with("glTF"));
        CHECK(number_at<std::uint32_t>(file, 4) == 2);
        CHECK(number_at<std::uint32_t>(file, 8) == file.size());
        const std::size_t length = number_at<std::uint32_t>(file, 12);
        CHECK(length % 4 == 0);
        CHECK(file.substr(16, 4) == "JSON");
        json = nlohmann::json::parse(file.substr(20, length));
        const std::size_t binary = number_at<std::uint32_t>(file, 20 + length);
        CHECK(file.substr(24 + length, 4) == std::string("BIN\0", 4));
        numbers = file.substr(28 + length);
        CHECK(binary % 4 == 0);
        CHECK(numbers.size() == binary);
        CHECK(json["buffers"][0]["byteLength"] == binary);
        CHECK(file.find("null") >= 20 + length);
    }

    const nlohmann::json& attributes() const { return primitive()["attributes"]; }
    const nlohmann::json& primitive() const { return json["meshes"][0]["primitives"][0]; }
    const nlohmann::json& accessor(std::size_t index) const { return json["accessors"][index]; }

    template <class T>
    std::vector<T> array(std::size_t index, std::size_t width) const {
        const auto& view = json["bufferViews"][accessor(index)["bufferView"].get<std::size_t>()];
        const std::size_t count = accessor(index)["count"], at = view["byteOffset"];
        CHECK(view["byteLength"] == count * width * sizeof(T));
        std::vector<T> values;
        for (std::size_t i = 0; i < count * width; ++i)
            values.push_back(number_at<T>(numbers, at + i * sizeof(T)));
        return values;
    }
};

std::string glb_of(const PolygonMesh& mesh, LengthUnit unit = LengthUnit::none) {
    const Folder folder;
    write_mesh(folder / "m.glb", mesh, MeshFormat::glb, {.unit = unit});
    return support::read_file(folder / "m.glb");
}

std::size_t times_in(const std::string& text, const std::string& part) {
    std::size_t count = 0;
    for (std::size_t at = 0; (at = text.find(part, at)) != std::string::npos; ++at) ++count;
    return count;
}

} // namespace

TEST_CASE("GLB holds all triangles, bounds of its own floats, and metres", "[mesh_io]") {
    const GlbParts glb(glb_of(pyramid(40), LengthUnit::millimetre));
    const std::size_t place = glb.attributes()["POSITION"];
    const auto positions = glb.array<float>(place, 3);
    const auto indices = glb.array<std::uint32_t>(glb.primitive()["indices"], 1);
    const std::size_t count = positions.size() / 3;
    CHECK(indices.size() == 3 * 6);
    CHECK(std::all_of(indices.begin(), indices.end(), [&](std::uint32_t v) { return v < count; }));
    CHECK(glb.array<float>(glb.attributes()["NORMAL"], 3).size() == positions.size());
    CHECK(glb.array<std::uint16_t>(glb.attributes()["COLOR_0"], 4).size() == 4 * count);
    CHECK(glb.accessor(place)["min"] == nlohmann::json{0.0, 0.0, 0.0});
    const double most = double{0.04f};
    CHECK(glb.accessor(place)["max"] == nlohmann::json{most, most, most});
}

TEST_CASE("GLB far from the origin is relative to the translation of its node", "[mesh_io]") {
    const Vec3 shift(2600000.1, 1200000.2, 400.3);
    PolygonMesh mesh = pyramid(1);
    for (Vec3& p : mesh.positions) p += shift;
    const GlbParts glb(glb_of(mesh));
    const auto& node = glb.json["nodes"][1];
    const auto positions = glb.array<float>(glb.attributes()["POSITION"], 3);
    for (std::size_t i = 0; i < positions.size(); ++i) {
        const double back = double{positions[i]} + node["translation"][i % 3].get<double>() - shift[i % 3];
        CHECK((std::abs(back) < 1e-6 || std::abs(back - 0.5) < 1e-6 || std::abs(back - 1) < 1e-6));
    }
}

TEST_CASE("GLB refuses lengths that floats cannot hold, in metres, and takes those that they can",
          "[mesh_io]") {
    const auto beyond = Catch::EndsWith("m.glb: cannot write: lengths beyond a float; write PLY");
    for (const double size : {1e39, 1e300, 1e-39, 1e-300}) {
        CAPTURE(size);
        CHECK_THROWS_WITH(glb_of(pyramid(size)), beyond);
    }
    CHECK_THROWS_WITH(glb_of(pyramid(1e-36), LengthUnit::millimetre), beyond);
    for (const double size : {1e38, 1e-36}) {
        CAPTURE(size);
        const GlbParts glb(glb_of(pyramid(size)));
        CHECK(glb.accessor(0)["max"][0] == double{static_cast<float>(size)});
    }
    CHECK(GlbParts(glb_of(pyramid(1e40), LengthUnit::millimetre)).accessor(0)["max"][0].is_number());
}

TEST_CASE("a mesh without facets is refused where the format has none, and leaves no file", "[mesh_io]") {
    const Folder folder;
    PolygonMesh points = pyramid(1);
    points.corners.clear();
    points.first = {0};
    PolygonMesh needle = points;
    needle.add_facet(std::array<Index, 2>{0, 1});
    for (const PolygonMesh& mesh : {PolygonMesh{}, points, needle}) {
        CHECK_THROWS_WITH(write_mesh(folder / "m.glb", mesh, MeshFormat::glb),
                          Catch::EndsWith("m.glb: cannot write: no facets, which GLB wants; write PLY"));
        CHECK_THROWS_WITH(write_mesh(folder / "m.3mf", mesh, MeshFormat::mf3),
                          Catch::EndsWith("m.3mf: cannot write: no facets, which 3MF wants; write PLY"));
    }
    CHECK(folder.names().empty());
}

TEST_CASE("3MF holds its three members, every vertex and triangle, and whether it is closed", "[mesh_io]") {
    const Folder folder;
    PolygonMesh open = pyramid(40);
    open.first.pop_back();
    open.corners.resize(open.first.back());
    for (const bool closed : {true, false}) {
        CAPTURE(closed);
        write_mesh(folder / "m.3mf", closed ? pyramid(40) : open, MeshFormat::mf3,
                   {.unit = LengthUnit::inch});
        const auto bytes = io::SourceBytes::open(folder / "m.3mf");
        const io::ZipArchive archive(bytes);
        REQUIRE(archive.size() == 3);
        CHECK(archive.name(0) == "[Content_Types].xml");
        CHECK(archive.name(1) == "_rels/.rels");
        CHECK(archive.name(2) == "3D/3dmodel.model");
        const auto model = archive.read(2, archive.bytes_of(2));
        const std::string xml(model.view());
        CHECK(times_in(xml, "<vertex ") == 5);
        CHECK(times_in(xml, "<triangle ") == (closed ? 6 : 5));
        CHECK(times_in(xml, closed ? "type=\"model\"" : "type=\"surface\"") == 1);
        CHECK(times_in(xml, "<model unit=\"inch\"") == 1);
        CHECK(times_in(xml, "<vertex x=\"20\" y=\"20\" z=\"40\"/>") == 1);
        CHECK(xml.ends_with("</build>\n</model>\n"));
    }
}
