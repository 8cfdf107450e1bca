#include "hsdm/contour/dual_contour.hh"
#include "hsdm/mesh/area_vector.hh"
#include "hsdm/spatial/self_intersections.hh"
#include "support/check.hh"
#include "support/named_solid.hh"
#include "support/sample.hh"

#include <catch2/catch.hpp>

#include <cmath>

using namespace hsdm;
using support::faults;

namespace {

/// Quads with a corner that is straight to a ten-thousandth, the diagonal beside it the shorter one.
std::size_t doubtful_quads(const PolygonMesh& mesh) {
    std::size_t count = 0;
    std::vector<Vec3> ring;
    for (std::size_t f = 0; f < mesh.facet_count(); ++f) {
        ring.clear();
        for (const Index v : mesh.facet(f)) ring.push_back(mesh.positions[v]);
        if (ring.size() != 4) continue;
        const Vec3 up = unit(area_vector(ring));
        for (std::size_t i = 0; i < 4; ++i) {
            const double beside = (ring[(i + 1) % 4] - ring[(i + 3) % 4]).norm();
            const double from = (ring[(i + 2) % 4] - ring[i]).norm();
            count += std::abs(corner_sine(ring, i, up)) < 1e-4 && beside < from
                     && ((ring[(i + 1) % 4] - ring[i]) | (ring[(i + 3) % 4] - ring[i])) < 0;
        }
    }
    return count;
}

} // namespace

TEST_CASE(
    "of no quad of an exact wedge or plate rounding decides, and none is passed through wherever it lies",
    "[pipeline]") {
    for (const char* name : {"wedge", "plate"})
        for (std::uint64_t seed = 1; seed <= 6; ++seed) {
            CAPTURE(name, seed);
            const support::Solid solid = support::solid_named(name).placed(support::pose_by_seed(seed));
            const Octree octree = build_octree(support::sample(solid, {.points = 20000, .seed = seed}));
            const OctreeLevel level = extract_level(octree, 5);
            const NormalSets sets = build_normal_sets(octree, level);
            DualContourOptions as_they_come;
            as_they_come.better_quads = false;
            CHECK(doubtful_quads(dual_contour(octree, level, sets, as_they_come).mesh) > 0);
            PolygonMesh mesh = dual_contour(octree, level, sets).mesh;
            CHECK(doubtful_quads(mesh) == 0);
            for (Vec3& p : mesh.positions) p += octree.origin; // rounds
            CHECK(find_self_intersections(mesh).triangle_pairs == 0);
            CHECK(faults(mesh) == "");
        }
}
