#include "hsdm/basic/basic_facets.hh"
#include "hsdm/errors.hh"
#include "hsdm/quality/topology.hh"

#include <catch2/catch.hpp>
#include <tbb/global_control.h>

#include <algorithm>
#include <random>

using namespace hsdm;

namespace {

/// Every point of a grid of the given step on the faces of a box.
PointCloud box_cloud(const Vec3& size, double step) {
    PointCloud cloud;
    auto count = [&](unsigned k) { return static_cast<int>(size[k] / step + 0.5); };
    for (int x = 0; x <= count(0); ++x)
        for (int y = 0; y <= count(1); ++y)
            for (int z = 0; z <= count(2); ++z)
                if (x == 0 || y == 0 || z == 0 || x == count(0) || y == count(1) || z == count(2))
                    cloud.positions.emplace_back(x * step + 10, y * step - 5, z * step);
    return cloud;
}

PointCloud sphere_cloud(std::size_t n, unsigned seed) {
    std::mt19937_64 random(seed);
    std::normal_distribution<double> gauss;
    PointCloud cloud;
    for (std::size_t i = 0; i < n; ++i)
        cloud.positions.push_back(Vec3(gauss(random), gauss(random), gauss(random)).normalized());
    return cloud;
}

BasicFacets reconstruct(const PointCloud& cloud, int depth, const BasicFacetOptions& options = {}) {
    const Octree octree = build_octree(cloud);
    const OctreeLevel level = extract_level(octree, depth);
    return reconstruct_facets(octree, level, extract_graph(octree, level), options);
}

} // namespace

TEST_CASE("a box becomes a closed outward surface of quads where it stands", "[basic]") {
    const BasicFacets facets = reconstruct(box_cloud({1, 1, 1}, 1 / 32.0), 3);
    const Topology topology = measure_topology(facets.mesh);
    CHECK(topology.closed());
    CHECK(topology.manifold());
    CHECK(topology.misoriented_edges == 0);
    CHECK(topology.euler == 2);
    CHECK(topology.quads == topology.faces);
    CHECK(topology.signed_volume > 0.7);
    Box box;
    for (const Vec3& p : facets.mesh.positions) box.add(p);
    CHECK((box.lo - Vec3(10, -5, 0)).norm() < 0.2);
}

TEST_CASE("a densely sampled sphere becomes a closed sphere", "[basic]") {
    const BasicFacets facets = reconstruct(sphere_cloud(60000, 1), 4);
    const Topology topology = measure_topology(facets.mesh);
    CHECK(topology.closed());
    CHECK(topology.manifold());
    CHECK(topology.euler == 2);
    CHECK(topology.signed_volume == Approx(4.18).margin(0.1));
}

TEST_CASE("every selection of the tests gives an oriented 2-manifold", "[basic]") {
    const PointCloud cloud = sphere_cloud(3000, 2); // sparse: holes are bound to be there
    for (int tests = 0; tests < 8; ++tests) {
        const BasicFacetOptions options{.hit_test = (tests & 1) != 0,
                                        .distance_criterion = (tests & 2) != 0,
                                        .angle_comparison = (tests & 4) != 0};
        const Topology topology = measure_topology(reconstruct(cloud, 5, options).mesh);
        CHECK(topology.faces > 0);
        CHECK(topology.manifold());
        CHECK(topology.misoriented_edges == 0);
    }
}

TEST_CASE("two bodies apart are both outward", "[basic]") {
    PointCloud cloud = sphere_cloud(40000, 3);
    for (const Vec3& p : sphere_cloud(40000, 4).positions) cloud.positions.push_back(p + Vec3(3, 0, 0));
    const Topology topology = measure_topology(reconstruct(cloud, 5).mesh);
    CHECK(topology.components == 2);
    CHECK(topology.signed_volume == Approx(2 * 4.18).margin(0.4));
}

TEST_CASE("facets do not depend on threads or on the order of the points", "[basic]") {
    PointCloud cloud = sphere_cloud(20000, 5);
    const BasicFacets facets = reconstruct(cloud, 5);
    std::shuffle(cloud.positions.begin(), cloud.positions.end(), std::mt19937_64(6));
    const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
    const BasicFacets again = reconstruct(cloud, 5);
    CHECK(facets.mesh.positions == again.mesh.positions);
    CHECK(facets.mesh.corners == again.mesh.corners);
    CHECK(facets.mesh.first == again.mesh.first);
}

TEST_CASE("a graph without loops has no facets", "[basic]") {
    PointCloud line;
    for (int i = 0; i < 100; ++i) line.positions.emplace_back(i, 0, 0);
    const BasicFacets facets = reconstruct(line, 4);
    CHECK(facets.mesh.facet_count() == 0);
    CHECK(facets.mesh.vertex_count() == 0);
}

TEST_CASE("a loop length out of range is refused", "[basic]") {
    CHECK_THROWS_AS(reconstruct(sphere_cloud(100, 7), 2, {.max_loop_edges = 2}), OptionError);
}
