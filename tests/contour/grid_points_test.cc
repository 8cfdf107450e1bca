#include "hsdm/contour/grid_points.hh"
#include "support/random.hh"

#include <catch2/catch.hpp>
#include <tbb/global_control.h>

#include <map>
#include <set>

using namespace hsdm;

namespace {

/// Voxels scattered over a cube, so that most grid points have few of them.
OctreeLevel scattered(std::size_t points, int depth) {
    support::Random random(points);
    PointCloud cloud;
    for (std::size_t i = 0; i < points; ++i)
        cloud.positions.emplace_back(random.uniform(), random.uniform(), random.uniform());
    return extract_level(build_octree(cloud), depth);
}

VoxelCoord shifted(VoxelCoord c, unsigned axis, int by) {
    c[axis] += by;
    return c;
}

/// Checks `next` by looking up each neighbour of each grid point.
void check_next(const GridPoints& grid) {
    std::map<VoxelCoord, Index> number;
    for (Index c = 0; c < grid.size(); ++c) number[grid.coord(c)] = c;
    REQUIRE(number.size() == grid.size());
    REQUIRE(grid.next.size() == grid.size());
    std::size_t wrong = 0;
    for (const auto& [at, c] : number) {
        wrong += grid.find(grid.codes[c]) != c || GridPoints::code(at) != grid.codes[c];
        for (unsigned axis = 0; axis < 3; ++axis) {
            const auto found = number.find(shifted(at, axis, 1));
            wrong += grid.next[c][axis] != (found == number.end() ? no_index : found->second);
        }
    }
    CHECK(wrong == 0);
}

void check_voxels(const GridPoints& grid, const OctreeLevel& level, std::size_t count) {
    std::size_t wrong = 0;
    for (Index c = 0; c < count; ++c)
        for (unsigned octant = 0; octant < 8; ++octant) {
            VoxelCoord at = grid.coord(c);
            for (unsigned k = 0; k < 3; ++k) at[k] -= octant >> k & 1u ? 0 : 1;
            wrong += grid.voxels[c][octant] != level.find(at);
        }
    CHECK(wrong == 0);
}

/// Codes of places beside grid points where there is none yet, ascending; at the margins too.
std::vector<MortonCode> beside(const GridPoints& grid, std::size_t count) {
    std::set<MortonCode> found;
    support::Random random(9);
    const auto last = *std::max_element(grid.codes.begin(), grid.codes.end());
    while (found.size() < count) {
        VoxelCoord at = grid.coord(static_cast<Index>(random.below(grid.size())));
        const auto axis = static_cast<unsigned>(random.below(3));
        at = shifted(at, axis, random.below(2) == 0 ? -1 : 1);
        if (at[axis] >= -1 && grid.find(GridPoints::code(at)) == no_index) found.insert(GridPoints::code(at));
    }
    CHECK(*found.rbegin() > last); // beyond what was there
    return {found.begin(), found.end()};
}

} // namespace

TEST_CASE("the corners of voxels are grid points, each once and in Morton order", "[contour]") {
    for (const int depth : {0, 1, 3, 6}) { // one voxel, and several chunks of them
        INFO("depth " << depth);
        const OctreeLevel level = scattered(6000, depth);
        std::set<MortonCode> expected;
        for (Index v = 0; v < level.size(); ++v)
            for (int k = 0; k < 8; ++k) {
                const VoxelCoord at = level.coord(v);
                expected.insert(GridPoints::code({at[0] + k % 2, at[1] + k / 2 % 2, at[2] + k / 4}));
            }
        const GridPoints grid = build_grid_points(level);
        CHECK(grid.codes == std::vector<MortonCode>(expected.begin(), expected.end()));
    }
}

TEST_CASE("a grid point knows the voxels round it and the next grid point along each axis", "[contour]") {
    for (const int depth : {0, 4, 6}) {
        INFO("depth " << depth);
        const OctreeLevel level = scattered(6000, depth);
        const GridPoints grid = build_grid_points(level);
        check_next(grid);
        check_voxels(grid, level, grid.size());
    }
}

TEST_CASE("what lies below a grid point is what it is next to", "[contour]") {
    const GridPoints grid = build_grid_points(scattered(3000, 5));
    const auto below = grid_points_below(grid);
    std::size_t pairs = 0, wrong = 0;
    for (Index c = 0; c < grid.size(); ++c)
        for (unsigned axis = 0; axis < 3; ++axis) {
            const Index up = grid.next[c][axis], down = below[c][axis];
            pairs += up != no_index;
            if (up != no_index) wrong += below[up][axis] != c;
            if (down != no_index) wrong += grid.next[down][axis] != c;
        }
    CHECK(pairs > 1000);
    CHECK(wrong == 0);
}

TEST_CASE("grid points that are added are connected like the others, and have no voxels", "[contour]") {
    const OctreeLevel level = scattered(3000, 5);
    GridPoints grid = build_grid_points(level);
    const std::vector<MortonCode> before = grid.codes;
    for (const std::size_t count : {500u, 3000u}) { // once, and again behind those
        const std::size_t size = grid.size();
        const std::vector<MortonCode> codes = beside(grid, count);
        add_grid_points(grid, codes);
        REQUIRE(grid.size() == size + codes.size());
        CHECK(std::equal(codes.begin(), codes.end(), grid.codes.end() - std::ssize(codes)));
        check_next(grid);
    }
    CHECK(std::equal(before.begin(), before.end(), grid.codes.begin()));
    check_voxels(grid, level, before.size());
    std::size_t with_voxels = 0;
    for (std::size_t c = before.size(); c < grid.size(); ++c)
        for (Index voxel : grid.voxels[c]) with_voxels += voxel != no_index;
    CHECK(with_voxels == 0);
}

TEST_CASE("grid points do not depend on the number of threads", "[contour]") {
    const OctreeLevel level = scattered(9000, 6);
    const GridPoints many = build_grid_points(level);
    const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
    const GridPoints single = build_grid_points(level);
    CHECK(many.codes == single.codes);
    CHECK(many.voxels == single.voxels);
    CHECK(many.next == single.next);
}
