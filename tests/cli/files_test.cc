// What the command says of the files it writes: precision, shifts, units, features for CAD programs.
#include "cli/run.hh"
#include "cli/scan.hh"
#include "hsdm/io/read_mesh.hh"

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include <filesystem>
#include <sstream>

using namespace hsdm;
using namespace hsdm::test;
using Catch::Contains;
using Catch::StartsWith;
using Json = nlohmann::json;

namespace {

/// A cube's faces, with normals: it has twelve sharp edges and eight corners.
std::string cube_scan(const Vec3& shift) {
    std::ostringstream text;
    text.precision(17);
    text << "x y z nx ny nz\n";
    for (int face = 0; face < 6; ++face)
        for (int i = 0; i < 12; ++i)
            for (int j = 0; j < 12; ++j) {
                const auto axis = static_cast<std::size_t>(face % 3);
                Vec3 p, n(0, 0, 0);
                n[axis] = face < 3 ? -1 : 1;
                p[axis] = 20 * n[axis];
                p[(axis + 1) % 3] = (2 * i - 11) * 20.0 / 12;
                p[(axis + 2) % 3] = (2 * j - 11) * 20.0 / 12;
                p += shift;
                text << p[0] << ' ' << p[1] << ' ' << p[2] << ' ' << n[0] << ' ' << n[1] << ' ' << n[2]
                     << '\n';
            }
    return text.str();
}

std::size_t count_lines(const std::string& text, const std::string& begin) {
    std::istringstream lines(text);
    std::size_t count = 0;
    for (std::string line; std::getline(lines, line);) count += line.starts_with(begin);
    return count;
}

} // namespace

TEST_CASE("an STL file that becomes text for its precision says why, and how it stays binary", "[cli]") {
    const Folder folder;
    folder.write("near.xyz", cube_scan({0, 0, 0}));
    folder.write("far.xyz", cube_scan({1e7, 1e7, 1e7}));
    const std::string text =
        "STL as text: so far from the origin the floats of binary STL would move vertices by up "
        "to ";
    const CommandResult far = run(folder, "reconstruct far.xyz --depth 3 -o far.stl --report far.json");
    CHECK_THAT(far.out, Contains(text) && Contains("--recentre writes it binary"));
    CHECK_THAT(read_file(folder / "far.stl"), StartsWith("solid"));
    const Json told = Json::parse(read_file(folder / "far.json"))["written"];
    CHECK(told["format"] == "stl");
    CHECK(told["text_for_precision"] == true);
    CHECK(told["moved_by_floats"] > 1e-3);
    CHECK(told["shift"] == Json::array({0.0, 0.0, 0.0}));
    CHECK_THAT(run(folder, "reconstruct far.xyz --depth 3 -o far.stl --ascii").out, !Contains(text));
    CHECK_THAT(run(folder, "reconstruct near.xyz --depth 3 -o near.stl").out, !Contains(text));
    CHECK_THAT(run(folder, "process far.stl --stage classify -o again.stl").out, Contains(text));
}

TEST_CASE("mesh and features are written relative to a shift by --recentre, which summary and report tell",
          "[cli]") {
    const Folder folder;
    folder.write("far.xyz", cube_scan({1e7, -2e6, 5}));
    REQUIRE(run(folder, "reconstruct far.xyz --depth 3 -o far.off --features far.txt").status == 0);
    const PolygonMesh far = read_mesh(folder / "far.off");
    for (const std::string format : {"stl", "off", "ply", "obj", "om"}) {
        CAPTURE(format);
        const CommandResult made = run(
            folder,
            "reconstruct far.xyz --depth 3 --recentre --report r.json --features near.txt -o near." + format);
        REQUIRE(made.status == 0);
        CHECK_THAT(made.out, Contains("shift     10000000 -2000000 0: add it") && !Contains("STL as text"));
        const Json told = Json::parse(read_file(folder / "r.json"))["written"];
        CHECK(told["text_for_precision"] == false);
        CHECK(told["shift"] == Json::array({1e7, -2e6, 0.0}));
        const PolygonMesh near = read_mesh(folder / ("near." + format));
        if (format == "stl") continue; // has vertices in another order
        REQUIRE(near.vertex_count() == far.vertex_count());
        for (std::size_t v = 0; v < near.vertex_count(); ++v)
            CHECK((near.positions[v] + Vec3(1e7, -2e6, 0) - far.positions[v]).norm() < 1e-8);
    }
    CHECK(std::filesystem::file_size(folder / "near.stl") % 50 == 84 % 50);
    double x = 0;
    std::istringstream(read_file(folder / "near.txt")) >> x;
    CHECK(std::abs(x) < 100);
    std::istringstream(read_file(folder / "far.txt")) >> x;
    CHECK(x > 9e6);
}

TEST_CASE("units go into 3MF, scale GLB to metres, and are told where a format has no place for them",
          "[cli]") {
    const Folder folder;
    folder.write("cube.xyz", cube_scan({0, 0, 0}));
    const auto words = [&](const std::string& output, const std::string& units) {
        return run(folder,
                   "reconstruct cube.xyz --depth 3 --report r.json --units " + units + " -o " + output)
            .out;
    };
    CHECK_THAT(words("a.3mf", "in"), Contains("units     in\n"));
    CHECK_THAT(words("a.glb", "mm"), Contains("units     mm, scaled to metres, which GLB is in\n"));
    CHECK(Json::parse(read_file(folder / "r.json"))["written"]["units"] == "mm");
    for (const char* output : {"a.off", "a.stl", "a.ply", "a.obj", "a.om"})
        CHECK_THAT(words(output, "cm"), Contains("units     cm, which ") && Contains(" has no place for\n"));
    const CommandResult wrong = run(folder, "reconstruct cube.xyz --units feet -o a.3mf");
    CHECK(wrong.status == 2);
    CHECK_THAT(wrong.err, Contains("--units feet: must be one of mm, cm, m, in"));
    CHECK_THAT(run(folder, "reconstruct cube.xyz --depth 3 -o a.glb").out, !Contains("units"));
}

TEST_CASE("features become lines of OBJ or DXF by the file's extension, else text", "[cli]") {
    const Folder folder;
    folder.write("cube.xyz", cube_scan({0, 0, 0}));
    for (const char* name : {"f.txt", "f.obj", "f.DXF", "f.features"})
        REQUIRE(
            run(folder, std::string("reconstruct cube.xyz --depth 3 -o a.off --units mm --features ") + name)
                .status
            == 0);
    const std::string text = read_file(folder / "f.txt"), obj = read_file(folder / "f.obj"),
                      dxf = read_file(folder / "f.DXF");
    const std::size_t corners = count_lines(text, "c "), edges = count_lines(text, "") - corners;
    CHECK(read_file(folder / "f.features") == text);
    CHECK(corners == 8);
    CHECK(edges >= 12);
    CHECK(count_lines(obj, "l ") == edges);
    CHECK(count_lines(obj, "p ") == corners);
    CHECK(count_lines(obj, "v ") == 2 * edges + corners);
    CHECK(count_lines(dxf, "LINE") == edges);
    CHECK(count_lines(dxf, "POINT") == corners);
    CHECK_THAT(dxf, StartsWith("999\n") && Contains("units: mm") && Catch::EndsWith("0\nEOF\n"));
}

TEST_CASE("GLB and 3MF are written for every command that writes meshes, and read by none", "[cli]") {
    const Folder folder;
    folder.write("cube.xyz", cube_scan({0, 0, 0}));
    REQUIRE(run(folder, "reconstruct cube.xyz --depth 3 -o a.om").status == 0);
    for (const char* format : {"glb", "3mf"}) {
        CAPTURE(format);
        const std::string name = std::string("a.") + format;
        REQUIRE(run(folder, "process a.om --stage classify -o " + name).status == 0);
        const CommandResult out = run(
            folder, std::string("reconstruct cube.xyz --depth 3 -o - --quiet --format ") + format + " > b");
        REQUIRE(out.status == 0);
        CHECK_THAT(read_file(folder / "b"), StartsWith(format[0] == 'g' ? "glTF" : "PK"));
        const CommandResult read = run(folder, "info " + name);
        CHECK(read.status == 1);
        CHECK_THAT(read.err, StartsWith("hsdm: " + name + ": is a ") && Contains("not read"));
    }
}
