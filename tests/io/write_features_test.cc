#include "hsdm/io/write_features.hh"
#include "hsdm/mesh/vertex_normals.hh"
#include "support/folder.hh"

#include <catch2/catch.hpp>

#include <algorithm>
#include <sstream>

using namespace hsdm;
using support::Folder;

namespace {

/// A triangle with one sharp edge and, at one of its ends, a corner.
PolyMesh triangle_with_features() {
    PolyMesh mesh;
    const auto a = mesh.add_vertex(Vec3(1000.1, 0, 0)), b = mesh.add_vertex(Vec3(1001, 0.25, 0)),
               c = mesh.add_vertex(Vec3(1000, 1, -2));
    mesh.add_face(std::vector{a, b, c});
    mesh.status(mesh.edge_handle(mesh.find_halfedge(a, b))).set_feature(true);
    OpenMesh::VPropHandleT<std::uint8_t> classes;
    mesh.add_property(classes, vertex_class_property);
    for (const auto v : mesh.vertices()) mesh.property(classes, v) = 0;
    mesh.property(classes, b) = static_cast<std::uint8_t>(VertexClass::corner);
    return mesh;
}

std::string written(const std::string& name, LengthUnit unit, const Vec3& shift) {
    const Folder folder;
    write_features(folder / name, triangle_with_features(), feature_format(name), unit, shift);
    return support::read_file(folder / name);
}

} // namespace

TEST_CASE("features as OBJ are a line for each sharp edge and a point for each corner", "[mesh_io]") {
    CHECK(written("f.OBJ", LengthUnit::none, {0, 0, 0})
          == "# hsdm: sharp edges as lines, corners as points\n"
             "v 1000.1 0 0\nv 1001 0.25 0\nv 1001 0.25 0\ng sharp_edges\nl 1 2\ng corners\np 3\n");
}

TEST_CASE("features as DXF are pairs of a code and its value, sections that close, less the shift",
          "[mesh_io]") {
    const std::string dxf = written("f.dxf", LengthUnit::millimetre, {1000, 0, 0});
    std::vector<std::pair<int, std::string>> pairs;
    std::istringstream lines(dxf);
    for (std::string code, value; std::getline(lines, code) && std::getline(lines, value);)
        pairs.emplace_back(std::stoi(code), value);
    REQUIRE(pairs.size() * 2 == static_cast<std::size_t>(std::count(dxf.begin(), dxf.end(), '\n')));
    CHECK(pairs.front() == std::pair<int, std::string>(999, "hsdm: sharp edges and corners, units: mm"));
    CHECK(pairs.back() == std::pair<int, std::string>(0, "EOF"));
    CHECK(std::count(pairs.begin(), pairs.end(), std::pair<int, std::string>(0, "SECTION")) == 3);
    CHECK(std::count(pairs.begin(), pairs.end(), std::pair<int, std::string>(0, "ENDSEC")) == 3);
    const auto line = std::find(pairs.begin(), pairs.end(), std::pair<int, std::string>(0, "LINE"));
    REQUIRE(pairs.end() - line == 15);
    const std::vector<std::pair<int, std::string>> entities(line + 1, line + 13);
    CHECK(entities[0].second == "SHARP_EDGES");
    std::vector<int> codes;
    std::vector<double> ends;
    for (std::size_t i = 1; i < 7; ++i) {
        codes.push_back(entities[i].first);
        ends.push_back(std::stod(entities[i].second));
    }
    CHECK(codes == std::vector<int>{10, 20, 30, 11, 21, 31});
    CHECK(ends == std::vector<double>{1000.1 - 1000, 0, 0, 1, 0.25, 0});
    CHECK(entities[7] == std::pair<int, std::string>(0, "POINT"));
    CHECK(entities[8].second == "CORNERS");
    CHECK(entities[9] == std::pair<int, std::string>(10, "1"));
    CHECK(entities[10] == std::pair<int, std::string>(20, "0.25"));
    CHECK(entities[11] == std::pair<int, std::string>(30, "0"));
}
