#include "hsdm/normals/outside.hh"
#include "hsdm/octree/spacing.hh"
#include "support/sample.hh"

#include <catch2/catch.hpp>

using namespace hsdm;

namespace {

struct Votes {
    std::size_t right = 0, wrong = 0, none = 0;
};

/// Patches of a scan with exact normals, so that all are outward, and what they see.
struct Seen {
    explicit Seen(const PointCloud& cloud) : octree(build_octree(cloud)) {
        EstimatedNormals exact;
        exact.normals = octree.normals;
        exact.tolerance.assign(octree.size(), 0.01);
        patches = build_patches(octree, find_neighbors(octree), exact);
        view = view_outside(octree, patches, estimate_spacing(octree));
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
