#include "faults/scenarios.hh"

#include "cli/scan.hh"
#include "io/las_bytes.hh"
#include "io/npy_bytes.hh"
#include "support/sample.hh"

#include "hsdm/io/write_mesh.hh"
#include "hsdm/mesh/to_mesh.hh"
#include "hsdm/reconstruct.hh"

#include <cstring>

namespace hsdm::faults {
namespace {

using test::Folder;
using test::read_file;

PointCloud cube_scan(std::size_t points) {
    return support::sample(support::box({1, 1, 1}), {.points = points});
}

std::string ply_scan(std::size_t points) {
    const Folder folder;
    support::write_ply(folder / "scan.ply", cube_scan(points));
    return read_file(folder / "scan.ply");
}

std::string mesh_file(MeshFormat format, bool ascii, std::size_t points = 300) {
    const Folder folder;
    const Reconstruction result = reconstruct(test::sphere_scan(points), {.depth = 3});
    write_mesh(folder / "mesh", to_polygons(result.mesh), format, {.ascii = ascii});
    return read_file(folder / "mesh");
}

std::string xyz_scan(std::size_t points) {
    return test::xyz(test::sphere_scan(points));
}

/// The same scan with something before it.
std::string with_header(const std::string& header, std::size_t points) {
    return header + xyz_scan(points);
}

std::string ply_text(std::size_t points) {
    return with_header("ply\nformat ascii 1.0\nelement vertex " + std::to_string(points)
                           + "\nproperty double x\nproperty double y\nproperty double z\nend_header\n",
                       points);
}

std::string pcd_header(std::size_t points, const std::string& data) {
    return "VERSION .7\nFIELDS x y z\nSIZE 8 8 8\nTYPE F F F\nCOUNT 1 1 1\nWIDTH " + std::to_string(points)
           + "\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS " + std::to_string(points) + "\nDATA " + data
           + "\n";
}

std::string pcd_binary(std::size_t points) {
    std::string text = pcd_header(points, "binary");
    for (const Vec3& p : test::sphere_scan(points).positions) {
        char bytes[3 * sizeof(double)];
        std::memcpy(bytes, p.data(), sizeof bytes);
        text.append(bytes, sizeof bytes);
    }
    return text;
}

std::string las_scan(std::size_t points) {
    std::vector<test::LasPoint> scan;
    for (const Vec3& p : test::sphere_scan(points).positions) {
        test::LasPoint& point = scan.emplace_back();
        for (unsigned k = 0; k < 3; ++k) point.at[k] = static_cast<std::int32_t>(1000 * p[k]);
    }
    return test::las_file({}, scan);
}

std::string npy_scan(std::size_t points) {
    std::string data;
    for (const Vec3& p : test::sphere_scan(points).positions)
        for (const double x : p) data += test::bytes_of(x);
    return test::npy_file("'<f8'", false, "(" + std::to_string(points) + ", 3)", data);
}

std::string ptx(std::size_t points) {
    std::string text =
        std::to_string(points) + "\n1\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n1 0 0 0\n0 1 0 0\n0 0 1 0\n" + "0 0 0 1\n";
    std::string scan = xyz_scan(points);
    for (std::size_t end = 0; (end = scan.find('\n', end)) != std::string::npos; end += 5)
        scan.insert(end, " 0.5");
    return text + scan;
}

Scenario reconstruction(const std::string& name, std::vector<std::string> options, Files inputs,
                        std::vector<std::string> outputs) {
    options.insert(options.begin(), "reconstruct");
    options.insert(options.end(), {"--threads", "1"});
    return {name, std::move(options), std::move(inputs), std::move(outputs)};
}

} // namespace

std::vector<Scenario> reconstructions() {
    const Files cube = {{"scan.ply", ply_scan(400)}}, sphere = {{"scan.xyz", xyz_scan(300)}};
    std::vector<Scenario> list;
    for (const MeshFormatInfo& info : mesh_formats()) {
        const std::string format(info.name), mesh = "part." + format;
        list.push_back(reconstruction(
            "to " + format,
            {"scan.ply", "--depth", "3", "-o", mesh, "--features", "part.txt", "--report", "part.json"}, cube,
            {mesh, "part.txt", "part.json"}));
    }
    list.front().from_start = true;
    list.push_back(reconstruction("levels", {"scan.ply", "--levels", "2:3", "-o", "part.ply"}, cube,
                                  {"part.d2.ply", "part.d3.ply"}));
    list.push_back(reconstruction(
        "several inputs",
        {"scan.ply", "other.xyz", "--depth", "3", "--out-dir", "meshes", "--report", "all.json"},
        {{"scan.ply", ply_scan(300)}, {"other.xyz", xyz_scan(300)}}, {"meshes/scan.off", "all.json"}));
    list.push_back(reconstruction("debugging output",
                                  {"scan.ply", "--depth", "3", "-o", "part.off", "--debug-dir", "phases"},
                                  cube, {"part.off", "phases/graph.obj"}));
    list.push_back(reconstruction("basic", {"scan.xyz", "--method", "basic", "-o", "part.off"}, sphere, {}));
    list.push_back(reconstruction("normals estimated",
                                  {"scan.xyz", "--depth", "3", "-o", "part.ply", "--ascii"}, sphere,
                                  {"part.ply"}));
    list.push_back(
        reconstruction("adaptive", {"scan.ply", "--max-error", "2%", "-o", "part.off"}, cube, {"part.off"}));
#ifdef HSDM_PAGES
    list.push_back(reconstruction("a page",
                                  {"scan.ply", "--depth", "3", "-o", "part.off", "--html", "part.html"}, cube,
                                  {"part.off", "part.html"}));
#endif
    Scenario streams = reconstruction(
        "streams", {"-", "--input-format", "xyz", "--depth", "3", "-o", "-", "--format", "ply"}, sphere, {});
    streams.standard_input = "scan.xyz";
    streams.prints_result = true;
    list.push_back(streams);
    return list;
}

std::vector<Scenario> readings() {
    const std::vector<std::pair<std::string, std::string>> files = {
        {"text.ply", ply_text(200)},
        {"binary.ply", ply_scan(200)},
        {"large.ply", ply_scan(2000)},
        {"text.pcd", with_header(pcd_header(200, "ascii"), 200)},
        {"binary.pcd", pcd_binary(200)},
        {"scan.xyz", xyz_scan(200)},
        {"large.xyz", xyz_scan(2000)},
        {"scan.csv", "x;y;z\n1;2;3\n1;2;4\n1;3;3\n0;0;1\n0;1;0\n2;2;2\n"},
        {"scan.pts", with_header("200\n", 200)},
        {"scan.ptx", ptx(200)},
        {"scan.las", las_scan(200)},
        {"scan.npy", npy_scan(200)},
        {"scan.npz", test::zip_file({{"points.npy", npy_scan(200)}}, true)},
        {"mesh.off", mesh_file(MeshFormat::off, false)},
        {"large.off", mesh_file(MeshFormat::off, false, 3000)},
        {"mesh.obj", mesh_file(MeshFormat::obj, false)},
        {"text.stl", mesh_file(MeshFormat::stl, true)},
        {"binary.stl", mesh_file(MeshFormat::stl, false)},
        {"mesh.ply", mesh_file(MeshFormat::ply, false)},
        {"text-mesh.ply", mesh_file(MeshFormat::ply, true)},
    };
    std::vector<Scenario> list;
    for (const auto& [name, content] : files)
        list.push_back({"info of " + name, {"info", name}, {{name, content}}, {}, {}, true});
    return list;
}

std::vector<Scenario> other_commands() {
    const std::string mesh = mesh_file(MeshFormat::off, false);
    const std::string suite = R"({"cases": [
        {"name": "sphere", "input": "scan.xyz", "args": ["--depth", "3"], "expect": {"mesh.closed": true}}]})";
    std::vector<Scenario> list = {
        {"info --json", {"info", "mesh.off", "--json"}, {{"mesh.off", mesh}}, {}, {}, true},
        {"compare",
         {"compare", "mesh.off", "scan.xyz"},
         {{"mesh.off", mesh}, {"scan.xyz", xyz_scan(200)}},
         {},
         {},
         true},
        {"compare --json",
         {"compare", "mesh.off", "other.off", "--json"},
         {{"mesh.off", mesh}, {"other.off", mesh}},
         {},
         {},
         true},
        {"compare clouds",
         {"compare", "scan.xyz", "other.xyz"},
         {{"scan.xyz", xyz_scan(200)}, {"other.xyz", xyz_scan(300)}},
         {},
         {},
         true},
        {"process",
         {"process", "mesh.off", "--module", "classify-features", "--module", "smooth-normals:rounds=2", "-o",
          "new.ply"},
         {{"mesh.off", mesh}},
         {"new.ply"}},
        {"regress",
         {"regress", "suite.json", "--json", "result.json"},
         {{"suite.json", suite}, {"scan.xyz", xyz_scan(300)}},
         {"result.json"}},
    };
    for (Scenario& scenario : list) scenario.from_start = true;
    list.back().tells_in_table = true;
    return list;
}

} // namespace hsdm::faults
