#include "hsdm/normals/outside.hh"
#include "hsdm/octree/spacing.hh"
#include "support/sample.hh"

#include <catch2/catch.hpp>

#include <algorithm>
#include <vector>

using namespace hsdm;

namespace {

struct Votes {
    std::size_t right = 0, wrong = 0, none = 0;
};

/// Patches of a scan with exact normals, so that all are outward, and what they see.
struct Seen {
    explicit Seen(const PointCloud& cloud, bool sky = false) : octree(build_octree(cloud)) {
        EstimatedNormals exact;
        exact.normals = octree.normals;
        exact.tolerance.assign(octree.size(), 0.01);
        const Neighbors neighbors = find_neighbors(octree);
        patches = build_patches(octree, neighbors, exact);
        std::vector<std::uint8_t> beside;
        if (sky) beside = sheets_beside(octree, neighbors, exact, patches);
        view = view_outside(octree, patches, estimate_spacing(octree), {.beside = beside});
    }
    Octree octree;
    Patches patches;
    OutsideView view;
};

Votes votes_of(const PointCloud& cloud) {
    Votes result;
    for (std::int8_t vote : Seen(cloud).view.votes)
        ++(vote > 0 ? result.right : vote < 0 ? result.wrong : result.none);
    return result;
}

/// The evidence of patches that see each other.
Votes facing(const PointCloud& cloud) {
    Votes result;
    for (const SignedEdge& edge : Seen(cloud).view.facing) ++(edge.weight > 0 ? result.right : result.wrong);
    return result;
}

} // namespace

TEST_CASE("nearly all of a sphere is seen from outside", "[normals]") {
    const Votes v = votes_of(support::sample(support::sphere(1), {.points = 5000}));
    CHECK(v.wrong == 0);
    CHECK(v.right > 9 * v.none);
}

TEST_CASE("the cavity of a thick shell is outside again", "[normals]") {
    const Votes v = votes_of(support::sample(support::nested_spheres(1, 0.5), {.points = 10000}));
    CHECK(v.wrong == 0);
    CHECK(v.right > v.none);
}

TEST_CASE("nothing is seen of a plate thinner than the voxels, nor of an open sheet", "[normals]") {
    const Votes plate = votes_of(support::sample(support::box(Vec3(1, 1, 0.01)), {.points = 5000}));
    CHECK(plate.wrong == 0);
    PointCloud sheet = support::sample(support::sphere(1), {.points = 5000});
    PointCloud cap;
    for (std::size_t i = 0; i < sheet.size(); ++i)
        if (sheet.positions[i][2] > 0.2) {
            cap.positions.push_back(sheet.positions[i]);
            cap.normals.push_back(sheet.normals[i]);
        }
    const Votes open = votes_of(cap);
    CHECK(open.right == 0);
    CHECK(open.wrong == 0);
}

TEST_CASE("the sides of a plate face each other, faces that meet in an obtuse crease do not", "[normals]") {
    const Votes plate = facing(support::sample(support::box(Vec3(1, 1, 0.05)), {.points = 10000}));
    CHECK(plate.wrong == 0);
    CHECK(plate.right > 1000);
    const support::Solid bar = support::box(Vec3(1, 1, 1));
    const support::Solid octagon = bar & bar.placed(support::turned(Vec3(0, 0, 1), 0.7));
    // Rough normals, as estimated ones are near creases.
    CHECK(facing(support::sample(octagon, {.points = 10000, .normal_noise = 0.3})).wrong == 0);
}

TEST_CASE("of a plate no sky is clear, of a solid all that is seen of it is", "[normals]") {
    const Seen plate(support::sample(support::box(Vec3(2, 2, 0.02)), {.points = 20000}), true);
    std::size_t seeing = 0, clear = 0;
    for (std::size_t p = 0; p < plate.patches.size(); ++p) {
        const Vec3& c = plate.patches.centroids[p];
        const bool at_rim = std::min({c[0], c[1], 2 - c[0], 2 - c[1]}) < 0.2;
        if (at_rim || plate.view.sky[p] == 0) continue;
        CHECK(plate.view.sky[p] == 1);
        ++seeing, clear += plate.view.clear_sky[p] != 0;
    }
    CHECK(seeing > 500);
    CHECK(clear == 0);

    const Seen ball(support::sample(support::sphere(1), {.points = 20000}), true);
    for (std::size_t p = 0; p < ball.patches.size(); ++p) CHECK(ball.view.clear_sky[p] == ball.view.sky[p]);

    const Vec3 size(1.4, 1, 0.9);
    const Seen box(support::sample(support::box(size), {.points = 20000}), true);
    const double voxel =
        box.octree.extent / (1 << depth_of_space(box.octree.extent, estimate_spacing(box.octree)));
    std::size_t on_faces = 0;
    for (std::size_t p = 0; p < box.patches.size(); ++p) {
        const Vec3& c = box.patches.centroids[p];
        unsigned beside = 0; // how many sides of the box are near
        for (unsigned k = 0; k < 3; ++k) beside += std::min(c[k], size[k] - c[k]) < 2 * voxel;
        if (beside > 1 || box.view.sky[p] == 0) continue;
        ++on_faces;
        CHECK(box.view.clear_sky[p] == box.view.sky[p]);
    }
    CHECK(on_faces > box.patches.size() / 3);
}
