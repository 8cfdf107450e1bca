#include "hsdm/errors.hh"
#include "hsdm/mesh/to_mesh.hh"
#include "hsdm/stages/stages.hh"
#include "support/folder.hh"
#include "support/meshes.hh"
#include "support/sample.hh"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

using namespace hsdm;
using Catch::Matchers::Contains;

namespace {

/// Points of a cube's surface, each with its height as a scalar and red where x > 0.
PointCloud painted_cube(std::size_t points = 20000) {
    PointCloud cloud = support::sample(support::box({2, 2, 2}), {.points = points});
    cloud.scalars = {{"height", {}, false}};
    for (const Vec3& p : cloud.positions) {
        cloud.scalars[0].values.push_back(p[2]);
        cloud.colors.push_back({static_cast<std::uint8_t>(p[0] > 0 ? 200 : 0), 7, 9, 255});
    }
    return cloud;
}

/// As a table with a header line.
std::string table(const PointCloud& cloud, double unit = 1) {
    std::string text = "x,y,z,red,green,blue,height\n";
    char line[160];
    for (std::size_t i = 0; i < cloud.size(); ++i) {
        const Vec3 p = cloud.positions[i] * unit;
        std::snprintf(line, sizeof line, "%.17g,%.17g,%.17g,%d,%d,%d,%.17g\n", p[0], p[1], p[2],
                      cloud.colors[i][0], cloud.colors[i][1], cloud.colors[i][2], cloud.scalars[0].values[i]);
        text += line;
    }
    return text;
}

/// The values of the property of a name, by vertex.
std::vector<double> values_of(const PolyMesh& mesh, const std::string& name) {
    for (const VertexProperty& property : to_polygons(mesh).properties)
        if (property.name == name) return property.values;
    return {};
}

PolyMesh cube_of(Index side) {
    return to_mesh(support::divided_cube(side)).mesh;
}

std::string transfer(PolyMesh& mesh, const std::string& arguments, const StageContext& context = {}) {
    return parse_stage_call("transfer" + arguments, {})(mesh, context);
}

} // namespace

TEST_CASE("vertices get what a file's points carry, the same as from a scan", "[transfer]") {
    const support::Folder folder;
    const PointCloud cloud = painted_cube();
    const std::string path = folder.write("a,b.csv", table(cloud)), escaped = folder / R"(a\,b.csv)";
    PolyMesh from_file = cube_of(8), from_scan = from_file;
    CHECK(parse_stage_call("transfer:cloud=" + escaped, {}).files() == std::vector<std::string>{path});
    const std::string words = transfer(from_file, ":cloud=" + escaped);
    CHECK_THAT(words, Contains(" properties from 20000 points to 386 vertices"));
    transfer(from_scan, "", {&cloud});
    double worst = 0;
    const std::vector<double> height = values_of(from_file, "height"), red = values_of(from_file, "red");
    REQUIRE(height.size() == from_file.n_vertices());
    REQUIRE(red.size() == from_file.n_vertices());
    for (const auto v : from_file.vertices()) {
        const auto i = static_cast<std::size_t>(v.idx());
        worst = std::max(worst, std::abs(height[i] - from_file.point(v)[2]));
        if (const double x = from_file.point(v)[0]; std::abs(x) > 0.2) CHECK(red[i] == (x > 0 ? 200 : 0));
    }
    CHECK(worst < 0.1); // three spacings
    CHECK(height == values_of(from_scan, "height"));
    CHECK(red == values_of(from_scan, "red"));
}

TEST_CASE("a transfer carries what its options ask for", "[transfer]") {
    PointCloud cloud = painted_cube(5000);
    cloud.positions.emplace_back(std::numeric_limits<double>::quiet_NaN(), 0, 0);
    cloud.normals.emplace_back(0, 0, 1);
    cloud.colors.push_back({});
    cloud.scalars[0].values.push_back(1e9);
    PolyMesh mesh = cube_of(4);
    for (const auto v : mesh.vertices()) mesh.set_normal(v, Vec3(0, 0, 0));
    const std::size_t near = mesh.n_vertices();
    mesh.add_face(mesh.add_vertex(Vec3(0, 0, 30)), mesh.add_vertex(Vec3(1, 0, 30)),
                  mesh.add_vertex(Vec3(0, 1, 30)));
    for (std::size_t v = near; v < mesh.n_vertices(); ++v)
        mesh.set_normal(mesh.vertex_handle(static_cast<unsigned>(v)), Vec3(0, 0, 0));
    const std::string words =
        transfer(mesh, ":colors=no,normals=yes,neighbors=3,max-distance=0.5,missing-value=-4", {&cloud});
    CHECK_THAT(words, Contains("1 property and 98 normals from 5000 points (1 more are not finite)"));
    CHECK_THAT(words, Contains("3 of them are too far"));
    CHECK(values_of(mesh, "red").empty());
    const std::vector<double> height = values_of(mesh, "height");
    CHECK(std::count(height.begin(), height.end(), -4) == 3);
    CHECK(height.back() == -4);
    CHECK(*std::max_element(height.begin(), height.end()) < 1.1);
    for (const auto v : mesh.vertices())
        CHECK(mesh.normal(v).norm() == Approx(static_cast<std::size_t>(v.idx()) < near ? 1 : 0));
    transfer(mesh, ":scalars=no", {&cloud});
    CHECK(values_of(mesh, "red").size() == mesh.n_vertices());
}

TEST_CASE("lengths of a transfer are in the unit that the mesh is measured in", "[transfer]") {
    const support::Folder folder;
    const PointCloud cloud = painted_cube(5000);
    const double unit = std::ldexp(1.0, 60);
    const std::string path = folder.write("cube.csv", table(cloud, unit));
    PolyMesh mesh = cube_of(4), same = mesh;
    CHECK(transfer(mesh, ":cloud=" + path + ",max-distance=0.5", {nullptr, unit}).find("too far")
          == std::string::npos);
    transfer(same, ":max-distance=0.5", {&cloud});
    CHECK(values_of(mesh, "height") == values_of(same, "height"));
}

TEST_CASE("a transfer that cannot be done is refused, as early as that is known", "[transfer]") {
    const support::Folder folder;
    const std::string table_path = folder.write("c.csv", table(painted_cube(100)));
    const std::string bare = folder.write("bare.xyz", "0 0 0\n1 0 0\n0 1 0\n");
    const std::string no_points = folder.write("none.xyz", "nan 0 0\n");
    CHECK_THROWS_WITH(parse_stage_call("transfer:cloud=" + (folder / "no.ply"), {}),
                      Contains("no.ply: no such file"));
    CHECK_THROWS_WITH(parse_stage_call("transfer:cloud=" + folder.path(), {}), Contains("is a directory"));
    for (const char* wrong : {"cloud=", "cloud=-", "neighbors=0", "normals=maybe", "max-distance=0",
                              "columns=x", "format=ply", "colors=no,scalars=no"})
        CHECK_THROWS_AS(parse_stage_call(std::string("transfer:") + wrong, {}), OptionError);
    CHECK_THROWS_AS(parse_stage_call("transfer:cloud=" + table_path + ",format=docx", {}), OptionError);
    CHECK_THROWS_AS(parse_stage_call("transfer:cloud=" + table_path + R"(,columns=x\,y)", {}), OptionError);
    CHECK(parse_stage_call("transfer", {}).takes_scan());
    CHECK_FALSE(parse_stage_call("transfer:cloud=c.csv", {}, folder.path()).takes_scan());

    PolyMesh mesh = cube_of(2);
    CHECK_THROWS_WITH(transfer(mesh, ""), Contains("transfer: cloud says whose points"));
    CHECK_THROWS_WITH(transfer(mesh, ":cloud=" + bare), Contains("bare.xyz: its points have nothing"));
    CHECK_THROWS_WITH(transfer(mesh, ":cloud=" + no_points), Contains("none.xyz: no point"));
    CHECK(to_polygons(mesh).properties.empty());
    const std::string four = folder.write("four", "0 0 0 5\n1 0 0 5\n0 1 0 5\n");
    transfer(mesh, ":cloud=" + four + R"(,format=xyz,columns=x\,y\,z\,intensity)");
    CHECK(values_of(mesh, "intensity") == std::vector<double>(mesh.n_vertices(), 5));
}
