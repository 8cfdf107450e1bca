#include "hsdm/normals/patches.hh"
#include "support/sample.hh"

#include <catch2/catch.hpp>
#include <tbb/global_control.h>

#include <algorithm>

using namespace hsdm;

namespace {

/// A scan with exact normals, each turned over where a random number says so, and its patches.
struct Patched {
    Octree octree;
    Neighbors neighbors;
    EstimatedNormals estimate;
    Patches patches;

    explicit Patched(const PointCloud& cloud, double flipped = 0)
        : octree(build_octree(cloud)), neighbors(find_neighbors(octree)) {
        estimate.normals = octree.normals;
        estimate.tolerance.assign(octree.size(), 0.01);
        support::Random random(4);
        for (Vec3& n : estimate.normals)
            if (random.uniform() < flipped) n = -n;
        patches = build_patches(octree, neighbors, estimate);
    }
    /// Does a point's normal, as its patch has it, point outwards?
    bool is_outward(Index i) const { return (estimate.normals[i] | octree.normals[i]) * patches.sign[i] > 0; }
    std::vector<SignedEdge> evidence() const { return patch_evidence(octree, neighbors, estimate, patches); }
};

support::Solid cube() {
    return support::box({1, 1, 1}).placed(support::turned(Vec3(1, 2, 3), 0.5));
}

PointCloud scan(const support::Solid& solid) {
    return support::sample(solid, {.points = 4000});
}

} // namespace

TEST_CASE("patches sum up their points, which are of one leaf", "[normals]") {
    PointCloud cloud = scan(cube());
    for (std::size_t i = 0; i < cloud.size(); i += 10) cloud.normals[i] = Vec3(0, 0, 0);
    const Patched p(cloud, 0.3);
    std::vector<Vec3> positions(p.patches.size(), Vec3(0, 0, 0)), normals(positions);
    std::vector<Index> counts(p.patches.size(), 0), leaf_of(counts.size(), no_index);
    std::size_t wrong = 0;
    for (std::size_t leaf = 0; leaf + 1 < p.neighbors.leaf_first.size(); ++leaf)
        for (Index i = p.neighbors.leaf_first[leaf]; i < p.neighbors.leaf_first[leaf + 1]; ++i) {
            const Index patch = p.patches.of_point[i];
            wrong += (patch == no_index) != (p.octree.normals[i] == Vec3(0, 0, 0));
            if (patch == no_index) continue;
            positions[patch] += p.octree.positions[i];
            normals[patch] += p.estimate.normals[i] * p.patches.sign[i];
            ++counts[patch];
            wrong += leaf_of[patch] != no_index && leaf_of[patch] != leaf;
            leaf_of[patch] = static_cast<Index>(leaf);
        }
    CHECK(wrong == 0);
    CHECK(counts == p.patches.counts);
    CHECK(*std::min_element(counts.begin(), counts.end()) >= 1);
    CHECK(*std::max_element(counts.begin(), counts.end()) >= 5);
    double off = 0;
    for (std::size_t k = 0; k < counts.size(); ++k) {
        off = std::max(off, (positions[k] / counts[k] - p.patches.centroids[k]).norm());
        off = std::max(off, (normals[k].normalized() - p.patches.normals[k]).norm());
    }
    CHECK(off < 1e-12);
}

TEST_CASE("no patch has points of two faces", "[normals]") {
    const Patched p(scan(cube()), 0.5);
    std::vector<Index> first(p.patches.size(), no_index);
    std::size_t mixed = 0;
    for (Index i = 0; i < p.octree.size(); ++i) {
        Index& one = first[p.patches.of_point[i]];
        if (one == no_index) one = i;
        mixed += (p.octree.normals[i] | p.octree.normals[one]) < 0.9;
    }
    CHECK(mixed == 0);
    CHECK(p.patches.size() < p.octree.size() / 3);
}

TEST_CASE("within a patch signs make normals point to one side, whichever way each points", "[normals]") {
    for (const support::Solid& solid : {cube(), support::sphere(1)}) {
        const Patched p(scan(solid), 0.5), straight(scan(solid));
        CHECK(p.patches.of_point == straight.patches.of_point);
        CHECK(std::count(straight.patches.sign.begin(), straight.patches.sign.end(), 1)
              == std::ssize(straight.patches.sign));
        std::vector<int> outward(p.patches.size(), 0);
        for (Index i = 0; i < p.octree.size(); ++i) outward[p.patches.of_point[i]] += p.is_outward(i);
        std::size_t torn = 0;
        for (std::size_t k = 0; k < outward.size(); ++k)
            torn += outward[k] != 0 && outward[k] != static_cast<int>(p.patches.counts[k]);
        CHECK(torn == 0);
    }
}

TEST_CASE("the evidence between patches is for the same side of the surface, over creases too", "[normals]") {
    for (const support::Solid& solid : {cube(), support::sphere(1), support::box({1, 1, 0.05})}) {
        const Patched p(scan(solid), 0.5);
        std::vector<int> side(p.patches.size(), 0);
        for (Index i = 0; i < p.octree.size(); ++i) side[p.patches.of_point[i]] = p.is_outward(i) ? 1 : -1;
        const std::vector<SignedEdge> edges = p.evidence();
        CHECK(edges.size() > p.patches.size());
        double right = 0, wrong = 0;
        std::size_t odd = 0;
        for (const SignedEdge& edge : edges) {
            odd +=
                edge.a >= edge.b || edge.b >= p.patches.size() || std::abs(edge.weight) > edge.total * 1.001f;
            const double weight = edge.weight * static_cast<float>(side[edge.a] * side[edge.b]);
            (weight > 0 ? right : wrong) += std::abs(weight);
        }
        CHECK(odd == 0);
        CHECK(wrong < 0.01 * right);
    }
}

TEST_CASE("patches do not depend on the number of threads", "[normals]") {
    const Patched many(scan(support::mechanical_part()), 0.5);
    const std::vector<SignedEdge> evidence = many.evidence();
    const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
    const Patched single(scan(support::mechanical_part()), 0.5);
    CHECK(single.patches.of_point == many.patches.of_point);
    CHECK(single.patches.sign == many.patches.sign);
    CHECK(single.patches.normals == many.patches.normals);
    CHECK(single.patches.centroids == many.patches.centroids);
    const std::vector<SignedEdge> again = single.evidence();
    CHECK(std::equal(again.begin(), again.end(), evidence.begin(), evidence.end(),
                     [](const SignedEdge& a, const SignedEdge& b) {
                         return a.a == b.a && a.b == b.b && a.weight == b.weight && a.total == b.total;
                     }));
}
