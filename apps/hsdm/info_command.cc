// hsdm info: what a file holds.

#include "command.hh"
#include "load.hh"
#include "summary.hh"

#include "hsdm/octree/spacing.hh"

#include <iostream>

namespace hsdm::command {
namespace {

Box bounds(const std::vector<Vec3>& positions) {
    Box box;
    for (const Vec3& p : positions) box.add(p);
    return box;
}

/// 0 for points without extent, which have no octree.
double spacing(const PointCloud& cloud) {
    return cloud.bounds().extent() > 0 ? estimate_spacing(build_octree(cloud)) : 0;
}

void fill_cloud(JsonText& json, const Loaded& loaded) {
    json.begin_object();
    json.member("points", loaded.cloud.size());
    json.member("dropped_nonfinite", loaded.dropped.nonfinite);
    json.member("has_normals", loaded.cloud.has_normals());
    json.member("bad_normals", loaded.dropped.bad_normals);
    json.member("has_colors", !loaded.cloud.colors.empty());
    json.key("scalars");
    json.begin_array();
    for (const Scalar& scalar : loaded.cloud.scalars) json.value(scalar.name);
    json.end();
    json.member("spacing", spacing(loaded.cloud));
    if (loaded.cloud.sensor) json.member("sensor", *loaded.cloud.sensor);
    json.end();
}

void print_json(const std::string& path, const Loaded& loaded) {
    const Box box = bounds(loaded.mesh.positions);
    JsonText json;
    json.begin_object();
    json.member("file", path);
    json.member("kind", loaded.is_mesh() ? "mesh" : "cloud");
    json.member("bbox_min", box.lo);
    json.member("bbox_max", box.hi);
    json.member("diagonal", box.diagonal());
    json.key(loaded.is_mesh() ? "mesh" : "cloud");
    if (loaded.is_mesh())
        fill_topology(json, loaded.mesh);
    else
        fill_cloud(json, loaded);
    json.end();
    std::cout << std::move(json).take();
}

void print_cloud(const Loaded& loaded) {
    const PointCloud& cloud = loaded.cloud;
    std::cout << "cloud     " << grouped(cloud.size()) << " points, spacing " << spacing(cloud) << '\n'
              << "normals   " << (cloud.has_normals() ? "yes" : "no");
    if (loaded.dropped.bad_normals > 0)
        std::cout << ", " << grouped(loaded.dropped.bad_normals) << " of them zero or not finite";
    std::cout << '\n';
    if (loaded.dropped.nonfinite > 0)
        std::cout << "dropped   " << grouped(loaded.dropped.nonfinite) << " points that are not finite\n";
    if (cloud.sensor) std::cout << "sensor    " << *cloud.sensor << '\n';
    if (!cloud.colors.empty()) std::cout << "colours   yes\n";
    for (const Scalar& scalar : cloud.scalars)
        std::cout << "scalar    " << scalar.name << (scalar.is_label ? " (labels)" : "") << '\n';
}

int show(const std::string& path, bool json) {
    const Loaded loaded = load(path);
    if (json) {
        print_json(path, loaded);
        return done;
    }
    const Box box = bounds(loaded.mesh.positions);
    std::cout << "file      " << path << '\n';
    if (loaded.is_mesh()) {
        print_topology(std::cout, loaded.mesh);
    } else {
        print_cloud(loaded);
    }
    std::cout << "bounds    " << box.lo << "  to  " << box.hi << ", diagonal " << box.diagonal() << '\n';
    return done;
}

} // namespace

void add_info(CLI::App& app, Run& run) {
    CLI::App* const sub =
        app.add_subcommand("info", "what a cloud or a mesh holds: counts, bounds, topology, shape");
    const auto path = std::make_shared<std::string>();
    const auto json = std::make_shared<bool>(false);
    sub->add_option("file", *path, "a point file or a mesh; - is standard input (points)")->required();
    sub->add_flag("--json", *json, "as JSON");
    sub->footer("Examples:\n  hsdm info scan.ply\n  hsdm info part.stl --json");
    sub->callback([&run, path, json] { run = [path, json] { return show(*path, *json); }; });
}

} // namespace hsdm::command
