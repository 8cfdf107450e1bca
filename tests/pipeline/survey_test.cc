#include "hsdm/pipeline/survey.hh"
#include "support/random.hh"
#include "support/sample.hh"

#include <catch2/catch.hpp>

#include <cmath>
#include <numeric>

using namespace hsdm;

namespace {

/// The points of whole cells, `most` or a cell's at a time.
void add_in_parts(const Octree& octree, int cell_depth, std::size_t most, Survey& survey) {
    const std::vector<Index> first = first_points(octree, cell_depth);
    for (std::size_t begin = 0, end; begin + 1 < first.size(); begin = end) {
        for (end = begin + 1; end + 1 < first.size() && first[end + 1] - first[begin] <= most;) ++end;
        Octree part = octree;
        std::vector<std::uint8_t> others(octree.size(), 1);
        std::fill(others.begin() + first[begin], others.begin() + first[end], std::uint8_t{0});
        remove_points(part, others);
        survey.add(part);
    }
}

/// A scan, of which few points are left far from one corner: cells of many points and of some.
PointCloud thinning_scan(unsigned seed) {
    const PointCloud all = support::sample(support::sphere(1), {.points = 12000, .seed = seed});
    support::Random random(seed);
    PointCloud cloud;
    for (std::size_t i = 0; i < all.size(); ++i) {
        const double distance = (all.positions[i] - Vec3(1, 1, 1)).norm();
        if (random.uniform(0, 1) < std::exp(-3 * distance)) continue;
        if (distance > 1.5 && random.uniform(0, 1) < 0.95) continue;
        cloud.positions.push_back(all.positions[i]);
        cloud.normals.push_back(all.normals[i]);
    }
    return cloud;
}

} // namespace

TEST_CASE("parts of a cloud tell on which level neighbours are sought in the whole", "[pipeline]") {
    const Octree octree = build_octree(thinning_scan(GENERATE(1u, 2u, 3u)));
    const int cell_depth = GENERATE(0, 2, 3, 5);
    const auto leaves = count_leaves(octree.codes);
    Survey survey(cell_depth + 3, cell_depth, octree.size());
    add_in_parts(octree, cell_depth, 500, survey);
    CHECK(survey.points() == octree.size());
    CHECK(survey.leaves() == std::accumulate(leaves.begin(), leaves.end(), std::size_t{0}));
    CHECK(survey.finest_leaves() == finest_leaves(leaves));
    const std::vector<Index> first = first_points(octree, cell_depth);
    const std::vector<Survey::FirstPoint> found = survey.first_points();
    REQUIRE(found.size() + 1 == first.size());
    for (std::size_t c = 0; c < found.size(); ++c) CHECK(found[c].number == first[c]);
}
