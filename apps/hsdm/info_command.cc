// hsdm info: what a file holds.

#include "command.hh"
#include "file_claims.hh"
#include "load.hh"
#include "messages.hh"
#include "summary.hh"

#include "hsdm/cloud/cloud_frame.hh"
#include "hsdm/quality/sampling.hh"

#include <array>
#include <cmath>
#include <iostream>
#include <optional>

namespace hsdm::command {
namespace {

/// Scaled so that squares of lengths do not overflow.
double diagonal(const Box& box) {
    const double unit = CloudFrame(box).unit();
    return (box.hi / unit - box.lo / unit).norm() * unit;
}

/// The least and the greatest length of the normals that are there; nothing if none is.
std::optional<std::pair<double, double>> normal_lengths(const PointCloud& cloud) {
    std::optional<std::pair<double, double>> range;
    for (const Vec3& n : cloud.normals) {
        const double length = std::hypot(n[0], n[1], n[2]);
        if (!(length > 0)) continue;
        if (!range) range.emplace(length, length);
        range->first = std::min(range->first, length);
        range->second = std::max(range->second, length);
    }
    return range;
}

void fill_sampling(JsonText& json, const Sampling& sampling) {
    json.member("spacing", sampling.spacing);
    json.key("nearest");
    json.begin_object();
    json.member("p5", sampling.nearest.p5);
    json.member("median", sampling.nearest.median);
    json.member("p95", sampling.nearest.p95);
    json.member("p99", sampling.nearest.p99);
    json.end();
    json.member("duplicates", sampling.duplicates);
    json.member("isolated", sampling.isolated);
    json.member("statistical_outliers", sampling.statistical_outliers);
}

void fill_cloud(JsonText& json, const Loaded& loaded) {
    json.begin_object();
    json.member("points", loaded.cloud.size());
    json.member("dropped_nonfinite", loaded.dropped.nonfinite);
    json.member("withheld", loaded.withheld);
    json.member("has_normals", loaded.cloud.has_normals());
    json.member("bad_normals", loaded.dropped.bad_normals);
    json.member("has_colors", !loaded.cloud.colors.empty());
    json.key("scalars");
    json.begin_array();
    for (const Scalar& scalar : loaded.cloud.scalars) json.value(scalar.name);
    json.end();
    fill_sampling(json, measure_sampling(loaded.cloud));
    if (const auto lengths = normal_lengths(loaded.cloud))
        json.member("normal_lengths", std::array{lengths->first, lengths->second});
    if (!loaded.columns.empty()) json.member("columns", loaded.columns);
    if (loaded.cloud.sensor) json.member("sensor", *loaded.cloud.sensor);
    if (!loaded.cloud.sensors.empty()) {
        json.key("sensors");
        json.begin_array();
        for (const Vec3& sensor : loaded.cloud.sensors) json.value(sensor);
        json.end();
    }
    json.end();
}

void print_normals(const Loaded& loaded) {
    std::cout << "normals   " << (loaded.cloud.has_normals() ? "yes" : "no");
    constexpr double rounding = 0.03; // of two decimals
    if (const auto lengths = normal_lengths(loaded.cloud);
        lengths && (lengths->first < 1 - rounding || lengths->second > 1 + rounding))
        std::cout << ", not of unit length (" << lengths->first << " to " << lengths->second << ')';
    if (loaded.dropped.bad_normals > 0)
        std::cout << ", " << grouped(loaded.dropped.bad_normals) << " of them zero or not finite";
    std::cout << '\n';
    if (!loaded.columns.empty())
        std::cout << "columns   " << columns_words(loaded.columns, loaded.cloud.has_normals()) << '\n';
}

void print_json(const std::string& path, const Loaded& loaded) {
    const Box box = bounds_of(loaded.mesh.positions);
    JsonText json;
    json.begin_object();
    json.member("file", path);
    json.member("kind", loaded.is_mesh() ? "mesh" : "cloud");
    json.member("bbox_min", box.lo);
    json.member("bbox_max", box.hi);
    json.member("diagonal", diagonal(box));
    json.key(loaded.is_mesh() ? "mesh" : "cloud");
    if (loaded.is_mesh())
        fill_topology(json, loaded.mesh);
    else
        fill_cloud(json, loaded);
    json.end();
    std::cout << std::move(json).take();
}

void print_sampling(const SamplingOptions& options, const Sampling& sampling) {
    std::cout << "density   nearest other point of 5 % within " << sampling.nearest.p5 << ", of half within "
              << sampling.nearest.median << ", of 95 % within " << sampling.nearest.p95 << '\n'
              << "outliers  " << 100 * sampling.isolated << " % lie " << options.isolation
              << " medians from their " << options.neighbors << " nearest, "
              << 100 * sampling.statistical_outliers << " % more than the mean and 3 deviations\n";
    if (sampling.duplicates > 0)
        std::cout << "repeated  " << grouped(sampling.duplicates)
                  << (sampling.duplicates == 1 ? " point" : " points") << " at the place of another\n";
}

void print_cloud(const Loaded& loaded) {
    const PointCloud& cloud = loaded.cloud;
    const SamplingOptions options;
    const Sampling sampling = measure_sampling(cloud, options);
    std::cout << "cloud     " << grouped(cloud.size()) << " points, spacing " << sampling.spacing << '\n';
    print_sampling(options, sampling);
    print_normals(loaded);
    print_dropped(std::cout, loaded);
    if (cloud.sensor) std::cout << "sensor    " << *cloud.sensor << '\n';
    if (!cloud.sensors.empty())
        std::cout << "sensors   " << cloud.sensors.size() << ", each point has its own\n";
    if (!cloud.colors.empty()) std::cout << "colours   yes\n";
    for (const Scalar& scalar : cloud.scalars)
        std::cout << "scalar    " << printable(scalar.name) << (scalar.is_label ? " (labels)" : "") << '\n';
}

int show(const std::string& path, bool json) {
    FileClaims claims;
    claims.reads("the file", path);
    claims.writes("the output", "-");
    claims.check();
    const Loaded loaded = load(path);
    if (json) {
        print_json(path, loaded);
        return done;
    }
    const Box box = bounds_of(loaded.mesh.positions);
    std::cout << "file      " << printable(path) << '\n';
    if (loaded.is_mesh()) {
        print_topology(std::cout, loaded.mesh);
    } else {
        print_cloud(loaded);
    }
    std::cout << "bounds    " << box.lo << "  to  " << box.hi << ", diagonal " << diagonal(box) << '\n';
    return done;
}

} // namespace

void add_info(CLI::App& app, Run& run) {
    CLI::App* const sub =
        app.add_subcommand("info", "what a cloud or a mesh holds: counts, bounds, topology, shape");
    const auto path = std::make_shared<std::string>();
    const auto json = std::make_shared<bool>(false);
    sub->add_option("file", *path, "a point file or a mesh; - is standard input")->required();
    sub->add_flag("--json", *json, "as JSON")->group("Output");
    sub->footer("Examples:\n  hsdm info scan.ply\n  hsdm info part.stl --json");
    sub->callback([&run, path, json] { run = [path, json] { return show(*path, *json); }; });
}

} // namespace hsdm::command
