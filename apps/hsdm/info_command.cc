// hsdm info: what a file holds.

#include "command.hh"
#include "load.hh"
#include "summary.hh"

#include "hsdm/octree/spacing.hh"

#include <iostream>

namespace hsdm::command {
namespace {

using Json = nlohmann::ordered_json;

Json list(const Vec3& v) {
    return {v[0], v[1], v[2]};
}

Box bounds(const std::vector<Vec3>& positions) {
    Box box;
    for (const Vec3& p : positions) box.add(p);
    return box;
}

/// 0 for points without extent, which have no octree.
double spacing(const PointCloud& cloud) {
    return cloud.bounds().extent() > 0 ? estimate_spacing(build_octree(cloud)) : 0;
}

void print_json(const std::string& path, const Loaded& loaded) {
    const Box box = bounds(loaded.mesh.positions);
    Json json = {{"file", path},
                 {"kind", loaded.is_mesh() ? "mesh" : "cloud"},
                 {"bbox_min", list(box.lo)},
                 {"bbox_max", list(box.hi)},
                 {"diagonal", box.diagonal()}};
    if (loaded.is_mesh()) {
        json["mesh"] = topology_json(loaded.mesh);
    } else {
        std::vector<std::string> scalars;
        for (const Scalar& scalar : loaded.cloud.scalars) scalars.push_back(scalar.name);
        json["cloud"] = {{"points", loaded.cloud.size()},
                         {"dropped_nonfinite", loaded.dropped.nonfinite},
                         {"has_normals", loaded.cloud.has_normals()},
                         {"bad_normals", loaded.dropped.bad_normals},
                         {"has_colors", !loaded.cloud.colors.empty()},
                         {"scalars", scalars},
                         {"spacing", spacing(loaded.cloud)}};
        if (loaded.cloud.sensor) json["cloud"]["sensor"] = list(*loaded.cloud.sensor);
    }
    std::cout << json.dump(2, ' ', false, Json::error_handler_t::replace) << '\n';
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
