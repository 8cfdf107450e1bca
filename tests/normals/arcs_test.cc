#include "hsdm/normals/arcs.hh"
#include "hsdm/normals/normals.hh"
#include "support/random.hh"
#include "support/sample.hh"

#include <catch2/catch.hpp>
#include <tbb/global_control.h>

using namespace hsdm;

namespace {

/// A scan with exact normals, which tests then spoil.
struct RoundScan {
    Octree octree;
    Neighbors neighbors;
    EstimatedNormals estimate;

    explicit RoundScan(const support::Solid& solid, std::size_t points)
        : octree(build_octree(support::sample(solid, {.points = points}))),
          neighbors(find_neighbors(octree)) {
        estimate.normals = octree.normals;
        for (double reach : neighbors.reach) estimate.tolerance.push_back(0.08 * reach);
        for (Index i = 0; i < octree.size(); ++i) estimate.bent.push_back(i);
    }
    /// Turns all normals by up to that angle, a different way each.
    void spoil(double angle) {
        support::Random random(7);
        for (Vec3& n : estimate.normals) {
            Vec3 aside;
            for (double& x : aside) x = random.uniform(-1, 1);
            aside -= n * (aside | n);
            n = (n + aside * (std::tan(angle) * random.uniform(0, 1) / aside.norm())).normalized();
        }
    }
    /// Degrees, over the points whose distance from the z axis and whose z are within a ring's.
    double mean_error(double least, double most, double ends) const {
        double sum = 0, count = 0;
        for (Index i = 0; i < octree.size(); ++i) {
            const Vec3 p = octree.positions[i] + octree.origin;
            const double off = std::hypot(p[0], p[1]);
            if (off < least || off > most || std::abs(p[2]) > ends) continue;
            sum += std::acos(std::min(1.0, estimate.normals[i] | octree.normals[i])) * 57.3;
            ++count;
        }
        REQUIRE(count > 100);
        return sum / count;
    }
};

/// A rod of two spacings' radius, in 1,000 points, and the hole that it leaves in a block, in 6,000.
support::Solid rod() {
    return support::cylinder(0.2, 8);
}
support::Solid bore() {
    return support::box({1.6, 1.6, 8}) - support::cylinder(0.2, 9);
}

} // namespace

TEST_CASE("normals of thin rods and narrow bores come to agree with the arcs between points", "[normals]") {
    for (const auto& [solid, points] : {std::pair(rod(), 1000), std::pair(bore(), 6000)}) {
        RoundScan scan(solid, static_cast<std::size_t>(points));
        scan.spoil(0.5);
        const double before = scan.mean_error(0.19, 0.21, 3.9);
        CHECK(before > 10);
        bend_to_arcs(scan.octree, scan.neighbors, scan.estimate);
        CHECK(scan.mean_error(0.19, 0.21, 3.9) < 0.3 * before);
    }
}

TEST_CASE("normals of a narrow bore are estimated to a few degrees", "[normals]") {
    RoundScan scan(bore(), 6000);
    Octree octree = scan.octree;
    make_normals(octree);
    REQUIRE(octree.size() == scan.octree.size());
    scan.estimate.normals = octree.normals;
    CHECK(scan.mean_error(0.19, 0.21, 3.5) < 4);
}

TEST_CASE("exact normals of rods, balls and boxes stay", "[normals]") {
    const support::Solid cube = support::in_general_pose(support::box({1, 1, 1}));
    for (const auto& [solid, points] :
         {std::pair(rod(), 1000), std::pair(support::sphere(1), 300), std::pair(cube, 4000)}) {
        RoundScan scan(solid, static_cast<std::size_t>(points));
        bend_to_arcs(scan.octree, scan.neighbors, scan.estimate);
        std::size_t off = 0; // by more than eight degrees: on edges two faces hold a point
        for (Index i = 0; i < scan.octree.size(); ++i)
            off += (scan.estimate.normals[i] | scan.octree.normals[i]) < 0.99;
        CHECK(off * 100 <= scan.octree.size());
    }
}

TEST_CASE("where normals are averaged for noise none is bent, nor one that is not said to be", "[normals]") {
    RoundScan scan(rod(), 1000);
    scan.spoil(0.5);
    const std::vector<Vec3> before = scan.estimate.normals;
    RoundScan noisy = scan, flat = scan;
    noisy.estimate.noise = 0.05;
    flat.estimate.bent.clear();
    for (RoundScan* kept : {&noisy, &flat}) {
        bend_to_arcs(kept->octree, kept->neighbors, kept->estimate);
        CHECK(kept->estimate.normals == before);
    }
    bend_to_arcs(scan.octree, scan.neighbors, scan.estimate);
    CHECK(scan.estimate.normals != before);
}

TEST_CASE("bent normals are unit and do not depend on the number of threads", "[normals]") {
    RoundScan many(bore(), 6000);
    many.spoil(0.5);
    RoundScan single = many;
    bend_to_arcs(many.octree, many.neighbors, many.estimate);
    {
        const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
        bend_to_arcs(single.octree, single.neighbors, single.estimate);
    }
    CHECK(many.estimate.normals == single.estimate.normals);
    for (const Vec3& n : many.estimate.normals) CHECK(n.norm() == Approx(1).margin(1e-12));
}
