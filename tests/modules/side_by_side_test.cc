#include "hsdm/features/features.hh"
#include "hsdm/mesh/to_mesh.hh"
#include "hsdm/quality/mesh_digest.hh"
#include "hsdm/reconstruct.hh"
#include "hsdm/stages/stages.hh"
#include "modules/own_modules.hh"
#include "support/meshes.hh"
#include "support/sample.hh"

#include <catch2/catch.hpp>

#include <exception>
#include <functional>
#include <latch>
#include <thread>

using namespace hsdm;
using hsdm::test::OwnModules;

namespace {

/// All that a run leaves on a mesh, as text: positions and facets, normals, marks.
std::string results_of(const PolyMesh& mesh) {
    const PolygonMesh polygons = to_polygons(mesh);
    PolygonMesh normals;
    normals.positions = polygons.normals;
    return mesh_digest(polygons) + ' ' + mesh_digest(normals) + '\n' + feature_lines(mesh);
}

using Job = std::function<std::string()>;

/// A reconstruction of a view, its normals given.
std::string reconstruct_view() {
    const PointCloud cloud = support::sample(support::mechanical_part(), {.points = 3000});
    return results_of(reconstruct(view_of(cloud), {.depth = 4}).mesh);
}

/// Another, its normals estimated, by threads of its own.
std::string reconstruct_cloud() {
    PointCloud cloud = support::sample(support::torus(1, 0.4), {.points = 3000, .normals = false});
    return results_of(reconstruct(std::move(cloud), {.depth = 4, .threads = 2}).mesh);
}

/// Stages one after the other on a cube, each found by its name.
std::string run_stages(const std::vector<std::string>& calls, const std::vector<std::string>& folders) {
    PolyMesh mesh = to_mesh(support::divided_cube(6)).mesh;
    std::string text;
    for (const std::string& call : calls) text += parse_stage_call(call, folders)(mesh) + '\n';
    return text + results_of(mesh);
}

std::vector<Job> jobs_of(const std::vector<std::string>& folders) {
    return {reconstruct_view, reconstruct_cloud,
            [&folders] {
                return run_stages({"classify", "smooth", "subdivide", "decimate:ratio=0.5"}, folders);
            },
            [&folders] {
                list_plugins(folders);
                return run_stages({"classify-features", "smooth-normals:rounds=5"}, folders);
            }};
}

/// The job's result, or what it failed of.
std::string done(const Job& job) {
    try {
        return job();
    } catch (const std::exception& error) {
        return std::string("failed: ") + error.what();
    }
}

} // namespace

TEST_CASE("reconstructions and stages, built in and loaded, give side by side what each gives alone") {
    const OwnModules own(HSDM_MODULE_DIR);
    const std::vector<std::string> folders = own;
    const std::vector<Job> jobs = jobs_of(folders);
    constexpr int repeats = 2;
    std::vector<std::vector<std::string>> together(jobs.size());
    std::latch start(static_cast<std::ptrdiff_t>(jobs.size()));
    std::vector<std::thread> threads;
    for (std::size_t i = 0; i < jobs.size(); ++i)
        threads.emplace_back([&, i] {
            start.arrive_and_wait(); // modules too are loaded while the others run
            for (int k = 0; k < repeats; ++k) together[i].push_back(done(jobs[i]));
        });
    for (std::thread& thread : threads) thread.join();
    for (std::size_t i = 0; i < jobs.size(); ++i) {
        INFO("job " << i);
        const std::string alone = done(jobs[i]);
        CHECK(alone.substr(0, 7) != "failed:");
        REQUIRE(together[i].size() == repeats);
        for (const std::string& result : together[i]) CHECK(result == alone);
    }
}
