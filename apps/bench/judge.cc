// hsdm_bench judge: what came of a scan of a known solid, whoever made the mesh: docs/performance.md beside
// others.

#include "benchmarks.hh"

#include "hsdm/errors.hh"
#include "hsdm/io/read_mesh.hh"
#include "hsdm/io/read_points.hh"
#include "hsdm/quality/distance.hh"
#include "hsdm/quality/topology.hh"
#include "support/named_solid.hh"
#include "support/sample.hh"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>

using namespace hsdm;

namespace {

struct Distances {
    double mean = 0, max = 0;
};

/// Of points spread over the mesh, from the solid's own surface.
Distances from_solid(const PolygonMesh& mesh, const support::Solid& solid, std::size_t samples) {
    Distances result;
    const std::vector<Vec3> points = sample_surface(mesh, samples);
    for (const Vec3& p : points) {
        const double d = std::abs(solid.distance(p));
        result.mean += d;
        result.max = std::max(result.max, d);
    }
    result.mean /= static_cast<double>(std::max<std::size_t>(1, points.size()));
    return result;
}

} // namespace

int bench::judge_mesh(int argc, char** argv) {
    CLI::App app(
        "Counts what a mesh of a solid is made of and measures it, as JSON: distances of the scan's points "
        "and of the solid's own from the mesh, and of the mesh from the solid's exact surface.");
    std::string shape, cloud_file, mesh_file;
    std::uint64_t seed = 1;
    bool turn = false;
    std::size_t samples = 200000;
    app.add_option("shape", shape, "of hsdm_generate")
        ->required()
        ->check(CLI::IsMember(support::solid_names()));
    app.add_option("cloud", cloud_file, "the scan")->required();
    app.add_option("mesh", mesh_file, "the mesh")->required();
    app.add_option("--seed", seed, "as hsdm_generate was given")->capture_default_str();
    app.add_flag("--turn", turn, "as hsdm_generate was given");
    app.add_option("--samples", samples, "points on mesh and solid")->capture_default_str();
    CLI11_PARSE(app, argc, argv);
    support::Solid solid = support::solid_named(shape, seed);
    if (turn) solid = solid.placed(support::pose_by_seed(seed));
    const PolygonMesh mesh = read_mesh(mesh_file);
    if (mesh.facet_count() == 0) throw Error(mesh_file, "holds no facet; there is nothing to judge");
    const Topology t = measure_topology(mesh);
    const Distance points = points_to_mesh(read_points(cloud_file).cloud.positions, mesh);
    const Distance truth =
        points_to_mesh(support::sample(solid, {.points = samples, .seed = seed + 1}).positions, mesh);
    const Distances surface = from_solid(mesh, solid, samples);
    std::printf("{\"vertices\": %zu, \"facets\": %zu, \"quads\": %zu, \"components\": %zu, \"euler\": %ld, "
                "\"boundary_edges\": %zu, \"boundary_loops\": %zu, \"manifold\": %s, \"closed\": %s, "
                "\"misoriented_edges\": %zu, "
                "\"points_to_mesh_mean\": %.9g, \"points_to_mesh_max\": %.9g, "
                "\"truth_to_mesh_mean\": %.9g, \"truth_to_mesh_max\": %.9g, "
                "\"mesh_to_truth_mean\": %.9g, \"mesh_to_truth_max\": %.9g}\n",
                t.vertices, t.faces, t.quads, t.components, t.euler, t.boundary_edges, t.boundary_loops,
                t.manifold() ? "true" : "false", t.closed() ? "true" : "false", t.misoriented_edges,
                points.mean, points.max, truth.mean, truth.max, surface.mean, surface.max);
    return 0;
}
