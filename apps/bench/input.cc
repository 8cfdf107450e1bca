// What a copy of the input costs: a reconstruction of points in structs of floats, read where they are or
// copied into a PointCloud first. One way a run, as the memory is the process's greatest.

#include "benchmarks.hh"

#include "hsdm/mesh/to_mesh.hh"
#include "hsdm/quality/mesh_digest.hh"
#include "hsdm/reconstruct.hh"
#include "support/sample.hh"

#include <CLI/CLI.hpp>

#include <cstdio>

using namespace hsdm;

namespace {

struct Hit {
    float position[3], normal[3];
};

std::vector<Hit> hits_of(const PointCloud& cloud) {
    std::vector<Hit> hits(cloud.size());
    for (std::size_t i = 0; i < hits.size(); ++i)
        for (unsigned k = 0; k < 3; ++k) {
            hits[i].position[k] = static_cast<float>(cloud.positions[i][k]);
            hits[i].normal[k] = static_cast<float>(cloud.normals[i][k]);
        }
    return hits;
}

/// A scan in parts, so that the generator's doubles never take the memory of all of them.
std::vector<Hit> scan(std::size_t points) {
    constexpr std::size_t part = 100000;
    const support::Solid solid = support::torus(1, 0.4);
    std::vector<Hit> hits;
    hits.reserve(points);
    for (std::uint64_t seed = 1; hits.size() < points; ++seed) {
        const std::vector<Hit> more =
            hits_of(support::sample(solid, {.points = std::min(part, points - hits.size()), .seed = seed}));
        hits.insert(hits.end(), more.begin(), more.end());
    }
    return hits;
}

PointView view_of_hits(const std::vector<Hit>& hits) {
    PointView view;
    view.positions = {hits[0].position, hits.size(), sizeof(Hit)};
    view.normals = {hits[0].normal, hits.size(), sizeof(Hit)};
    return view;
}

PointCloud copied(const std::vector<Hit>& hits) {
    PointCloud cloud;
    cloud.positions.reserve(hits.size());
    cloud.normals.reserve(hits.size());
    for (const Hit& hit : hits) {
        cloud.positions.emplace_back(hit.position[0], hit.position[1], hit.position[2]);
        cloud.normals.emplace_back(hit.normal[0], hit.normal[1], hit.normal[2]);
    }
    return cloud;
}

Reconstruction run(const std::string& way, const std::vector<Hit>& hits, const ReconstructOptions& options) {
    if (way == "view") return reconstruct(view_of_hits(hits), options);
    PointCloud cloud = copied(hits);
    if (way == "moved") return reconstruct(std::move(cloud), options);
    return reconstruct(cloud, options);
}

} // namespace

int bench::input(int argc, char** argv) {
    CLI::App app("Memory and time of a reconstruction by the way that its points come in.");
    std::size_t points = 10000000;
    std::string way = "view";
    app.add_option("--points", points, "how many")->capture_default_str();
    app.add_option("--way", way, "view: read in place; copy: a cloud is made; moved: and handed over")
        ->check(CLI::IsMember({"view", "copy", "moved"}))
        ->capture_default_str();
    CLI11_PARSE(app, argc, argv);
    const std::vector<Hit> hits = scan(points);
    const Reconstruction result = run(way, hits, {});
    std::printf("%s: %zu points, %zu MB, %.2f s, mesh %s\n", way.c_str(), hits.size(),
                result.report.peak_memory_bytes / 1000000, result.report.seconds.total,
                mesh_digest(to_polygons(result.mesh)).c_str());
    return 0;
}
