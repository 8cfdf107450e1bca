#include "hsdm/normals/outside.hh"
#include "hsdm/octree/spacing.hh"
#include "support/sample.hh"

#include <catch2/catch.hpp>

using namespace hsdm;

namespace {

struct Votes {
    std::size_t right = 0, wrong = 0, none = 0;
};

/// Patches of a scan with exact normals vote; right is outward.
Votes votes(const PointCloud& cloud) {
    const Octree octree = build_octree(cloud);
    EstimatedNormals exact;
    exact.normals = octree.normals;
    exact.tolerance.assign(octree.size(), 0.01);
    const Patches patches = build_patches(octree, find_neighbors(octree), exact);
    Votes result;
    for (std::int8_t vote : view_outside(octree, patches, estimate_spacing(octree)).votes)
        ++(vote > 0 ? result.right : vote < 0 ? result.wrong : result.none);
    return result;
}

} // namespace

TEST_CASE("nearly all of a sphere is seen from outside", "[normals]") {
    const Votes v = votes(support::sample(support::sphere(1), {.points = 5000}));
    CHECK(v.wrong == 0);
    CHECK(v.right > 9 * v.none);
}

TEST_CASE("the cavity of a thick shell is outside again", "[normals]") {
    const Votes v = votes(support::sample(support::nested_spheres(1, 0.5), {.points = 10000}));
    CHECK(v.wrong == 0);
    CHECK(v.right > v.none);
}

TEST_CASE("nothing is seen of a plate thinner than the voxels, nor of an open sheet", "[normals]") {
    const Votes plate = votes(support::sample(support::box(Vec3(1, 1, 0.01)), {.points = 5000}));
    CHECK(plate.wrong == 0);
    PointCloud sheet = support::sample(support::sphere(1), {.points = 5000});
    PointCloud cap;
    for (std::size_t i = 0; i < sheet.size(); ++i)
        if (sheet.positions[i][2] > 0.2) {
            cap.positions.push_back(sheet.positions[i]);
            cap.normals.push_back(sheet.normals[i]);
        }
    const Votes open = votes(cap);
    CHECK(open.right == 0);
    CHECK(open.wrong == 0);
}
