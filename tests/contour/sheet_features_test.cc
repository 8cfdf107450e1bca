#include "hsdm/contour/sheet_features.hh"

#include "hsdm/contour/dual_contour.hh"
#include "hsdm/features/features.hh"
#include "hsdm/mesh/to_mesh.hh"
#include "hsdm/mesh/vertex_normals.hh"
#include "support/sample.hh"

#include <catch2/catch.hpp>
#include <tbb/global_control.h>

#include <cmath>

using namespace hsdm;

namespace {

constexpr double crease_angle = FeatureOptions{}.crease_angle;

/// A solid's scan and mesh, and what its sheets say about the mesh's edges.
struct Part {
    Octree octree;
    OctreeLevel level;
    NormalSets sets;
    DualContour facets;
    SheetFeatures features;

    Part(const PointCloud& cloud, double voxel_size, bool turned = false) {
        OctreeOptions options;
        int depth = 1;
        while (voxel_size * (1 << depth) < cloud.bounds().extent()) ++depth;
        options.cube_extent = voxel_size * (1 << depth);
        octree = build_octree(cloud, options);
        level = extract_level(octree, depth);
        sets = build_normal_sets(octree, level);
        facets = dual_contour(octree, level, sets);
        if (turned)
            for (std::size_t f = 0; f < facets.mesh.facet_count(); ++f)
                std::reverse(facets.mesh.corners.begin() + facets.mesh.first[f],
                             facets.mesh.corners.begin() + facets.mesh.first[f + 1]);
        features = sheet_features(octree, level, sets, facets.mesh, link_facets(facets.mesh), facets.voxel,
                                  crease_angle, turned);
    }

    PolyMesh by_sheets(FeatureCounts& counts) const {
        PolyMesh mesh = to_mesh(facets.mesh).mesh;
        counts = classify_features(mesh, {}, features.hints);
        return mesh;
    }
    PolyMesh by_dihedral(FeatureCounts& counts) const {
        PolyMesh mesh = to_mesh(facets.mesh).mesh;
        counts = classify_features(mesh);
        return mesh;
    }
};

PointCloud rough_scan(const support::Solid& solid, std::size_t points, double normal_noise = 0) {
    return support::sample(solid, {.points = points, .normal_noise = normal_noise});
}

support::Solid pocket_block() {
    return support::box({1, 0.8, 0.6})
           - support::Solid(support::box({0.5, 0.4, 0.4}))
                 .placed(support::turned({0, 0, 1}, 0, {0, 0, 0.25}));
}

/// Of the edges that one of the two found sharp, the share that both did.
double agreement(const PolyMesh& a, const PolyMesh& b) {
    std::size_t both = 0, either = 0;
    for (const auto e : a.edges()) {
        both += a.status(e).feature() && b.status(e).feature();
        either += a.status(e).feature() || b.status(e).feature();
    }
    return static_cast<double>(both) / static_cast<double>(either);
}

/// Normals blended across edges as a plane fit over neighbours this far away blends them.
PointCloud smeared(PointCloud cloud, double reach) {
    const std::vector<Vec3> exact = cloud.normals;
    for (std::size_t i = 0; i < cloud.size(); ++i) {
        Vec3 sum(0, 0, 0);
        for (std::size_t j = 0; j < cloud.size(); ++j)
            if ((cloud.positions[i] - cloud.positions[j]).sqrnorm() < reach * reach) sum += exact[j];
        cloud.normals[i] = sum.normalized();
    }
    return cloud;
}

} // namespace

TEST_CASE("sheets and the dihedral test agree on the sharp edges of solids with flat sides",
          "[contour][slow]") {
    struct Example {
        const char* name;
        support::Solid solid;
        std::size_t points;
        double voxel;
    };
    const std::vector<Example> examples = {
        {"cube", support::box({1, 1, 1}), 10000, 0.1},
        {"block with pocket", pocket_block(), 20000, 0.05},
        {"wedge", support::wedge(0.52, 1, 1), 20000, 0.06},
        {"plate of half a voxel", support::box({1, 0.7, 0.04}), 20000, 0.08},
        {"plate of a quarter of a voxel", support::box({1, 0.7, 0.02}), 20000, 0.08},
    };
    for (const Example& e : examples) {
        double sum = 0;
        for (std::uint64_t seed : {1u, 2u, 3u, 4u}) {
            const Part part(rough_scan(e.solid.placed(support::random_pose(seed)), e.points), e.voxel);
            FeatureCounts sheets, dihedral;
            const double share = agreement(part.by_sheets(sheets), part.by_dihedral(dihedral));
            INFO(e.name << ", pose " << seed << ": " << sheets.sharp_edges << " sharp edges by sheets, "
                        << dihedral.sharp_edges << " by the dihedral test");
            CHECK(sheets.sharp_edges > 20);
            CHECK(share > 0.9);
            sum += share;
        }
        INFO(e.name);
        CHECK(sum / 4 > 0.95);
    }
}

TEST_CASE("tight bends are smooth by the points though they fold the mesh", "[contour]") {
    for (std::uint64_t seed : {1u, 2u, 3u}) {
        INFO("pose " << seed);
        const Part part(rough_scan(support::torus(1, 0.2).placed(support::random_pose(seed)), 30000), 0.12);
        FeatureCounts sheets, dihedral;
        part.by_sheets(sheets);
        part.by_dihedral(dihedral);
        CHECK(dihedral.sharp_edges > 10);
        CHECK(10 * sheets.sharp_edges < dihedral.sharp_edges);
        CHECK(part.features.doubtful == 0);
    }
}

TEST_CASE("corners of a box are found in every pose, and no others", "[contour]") {
    std::size_t by_sheets = 0, by_dihedral = 0;
    for (std::uint64_t seed = 1; seed <= 8; ++seed) {
        const support::Pose placed = support::random_pose(seed);
        const Part part(rough_scan(support::box({1, 0.8, 0.6}).placed(placed), 15000), 0.1);
        FeatureCounts sheets, dihedral;
        const PolyMesh mesh = part.by_sheets(sheets);
        part.by_dihedral(dihedral);
        by_sheets += sheets.corner_vertices;
        by_dihedral += dihedral.corner_vertices;
        OpenMesh::VPropHandleT<std::uint8_t> classes;
        REQUIRE(mesh.get_property_handle(classes, vertex_class_property));
        for (unsigned k = 0; k < 8; ++k) {
            const Vec3 corner = placed.to_world({k & 1 ? 0.5 : -0.5, k & 2 ? 0.4 : -0.4, k & 4 ? 0.3 : -0.3});
            double nearest = 1;
            for (const auto v : mesh.vertices())
                if (mesh.property(classes, v) == static_cast<std::uint8_t>(VertexClass::corner))
                    nearest = std::min(nearest, (mesh.point(v) + part.octree.origin - corner).norm());
            INFO("pose " << seed << ", corner " << k);
            CHECK(nearest < 0.035);
        }
    }
    CHECK(by_sheets == 64);
    CHECK(by_dihedral < 70);
}

TEST_CASE("normals smeared across creases leave the decision to the dihedral test", "[contour][slow]") {
    const PointCloud cloud =
        smeared(rough_scan(support::box({1, 0.8, 0.6}).placed(support::random_pose(4)), 4000), 0.08);
    const Part part(cloud, 0.1);
    FeatureCounts sheets, dihedral;
    part.by_sheets(sheets);
    part.by_dihedral(dihedral);
    CHECK(part.features.doubtful > 0);
    CHECK(part.features.smooth == 0);
    CHECK(sheets.sharp_edges >= dihedral.sharp_edges);
}

TEST_CASE("edges amid a thousand points a voxel are judged as those amid few", "[contour]") {
    const Part bent(rough_scan(support::torus(1, 0.2), 600000), 0.12);
    CHECK(bent.features.smooth > 10);
    CHECK(bent.features.doubtful == 0);

    PointCloud box = rough_scan(support::box({1, 0.8, 0.6}), 300000);
    const Part creased(box, 0.1);
    CHECK(creased.features.sharp > 50);
    CHECK(creased.features.doubtful == 0);
    constexpr double reach = 0.08; // within it normals are blended with those of the next face
    const Vec3 half(0.5, 0.4, 0.3);
    for (std::size_t i = 0; i < box.size(); ++i) {
        const Vec3& p = box.positions[i];
        Vec3 blend;
        for (unsigned k = 0; k < 3; ++k)
            blend[k] = std::copysign(std::max(0.0, std::abs(p[k]) - half[k] + reach), p[k]);
        box.normals[i] = blend.normalized();
    }
    const Part smeared_box(box, 0.1);
    CHECK(smeared_box.features.doubtful > 10);
    CHECK(smeared_box.features.smooth == 0);
}

TEST_CASE("features are the same whichever way the normals point", "[contour]") {
    const PointCloud outward = rough_scan(pocket_block().placed(support::random_pose(2)), 15000);
    PointCloud inward = outward;
    for (Vec3& n : inward.normals) n = -n;
    FeatureCounts a, b;
    Part(outward, 0.06).by_sheets(a);
    Part(inward, 0.06, true).by_sheets(b);
    CHECK(static_cast<double>(b.sharp_edges) == Approx(static_cast<double>(a.sharp_edges)).epsilon(0.05));
    CHECK(a.sharp_edges > 100);
}

TEST_CASE("what the sheets say does not depend on the number of threads", "[contour]") {
    const PointCloud cloud = rough_scan(support::mechanical_part(support::random_pose(1)), 20000);
    const Part part(cloud, 0.15);
    tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
    const Part again(cloud, 0.15);
    CHECK(part.features.sharp > 50);
    CHECK(part.features.hints.sides == again.features.hints.sides);
}
