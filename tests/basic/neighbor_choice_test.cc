#include "hsdm/basic/neighbor_choice.hh"
#include "hsdm/octree/octree.hh"

#include <catch2/catch.hpp>

#include <bit>

using namespace hsdm;

namespace {

NeighborMask mask(std::initializer_list<VoxelCoord> offsets) {
    NeighborMask m = 0;
    for (const VoxelCoord& offset : offsets)
        for (unsigned i = 0; i < neighbor_count; ++i)
            if (neighbor_offsets[i] == offset) m |= NeighborMask{1} << i;
    return m;
}

NeighborDistances even() {
    NeighborDistances d;
    d.fill(1);
    return d;
}

NeighborDistances with(const VoxelCoord& offset, double distance) {
    NeighborDistances d = even();
    d[static_cast<unsigned>(std::countr_zero(mask({offset})))] = distance;
    return d;
}

} // namespace

TEST_CASE("every edge neighbour is adjacent to the two face neighbours between it and the voxel", "[basic]") {
    for (int e = 6; e < neighbor_count; ++e) {
        CHECK(std::popcount(adjacent_faces(e)) == 2);
        CHECK((adjacent_faces(e) & edge_neighbors) == 0);
    }
    const int e = std::countr_zero(mask({{1, 0, -1}}));
    CHECK(adjacent_faces(e) == mask({{1, 0, 0}, {0, 0, -1}}));
}

TEST_CASE("on a flat layer the four face neighbours are chosen and no diagonal ones", "[basic]") {
    const NeighborMask faces = mask({{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}});
    const NeighborMask diagonals = mask({{1, 1, 0}, {-1, 1, 0}, {1, -1, 0}, {-1, -1, 0}});
    CHECK(choose_neighbors(faces | diagonals, even()) == faces);
}

TEST_CASE("on stairs the missing neighbour is found across an edge", "[basic]") {
    // Steps along x: the neighbour at x + 1 lies one voxel higher.
    const NeighborMask faces = mask({{-1, 0, 0}, {0, 1, 0}, {0, -1, 0}});
    const NeighborMask step = mask({{1, 0, 1}});
    CHECK(choose_neighbors(faces | step | mask({{-1, 1, 0}, {-1, -1, 0}}), even()) == (faces | step));
}

TEST_CASE("an edge neighbour next to a present face neighbour is not chosen: three neighbours remain",
          "[basic]") {
    const NeighborMask faces = mask({{-1, 0, 0}, {0, 1, 0}, {0, -1, 0}});
    const NeighborMask ignored = mask({{-1, 0, 1}, {0, 1, 1}, {1, 1, 0}, {1, -1, 0}});
    CHECK(choose_neighbors(faces | ignored, even()) == faces);
}

TEST_CASE("at a corner of three sides the three face neighbours suffice", "[basic]") {
    const NeighborMask faces = mask({{1, 0, 0}, {0, 1, 0}, {0, 0, 1}});
    const NeighborMask between = mask({{1, 1, 0}, {1, 0, 1}, {0, 1, 1}});
    CHECK(choose_neighbors(faces | between, even()) == faces);
}

TEST_CASE("a voxel without face neighbours takes its four nearest edge neighbours", "[basic]") {
    const NeighborMask present = mask({{1, 1, 0}, {-1, 1, 0}, {1, -1, 0}, {-1, -1, 0}, {1, 0, 1}});
    CHECK(choose_neighbors(present, with({1, 1, 0}, 2)) == (present & ~mask({{1, 1, 0}})));
    CHECK(choose_neighbors(present, even()) == (present & ~mask({{1, 0, 1}}))); // ties: the lower bit
    CHECK(choose_neighbors(present, even(), {.wanted = 5}) == present);
}

TEST_CASE("of five and six face neighbours all are kept, or the four nearest if so asked", "[basic]") {
    const NeighborMask six = face_neighbors;
    CHECK(choose_neighbors(six | edge_neighbors, even()) == six);
    NeighborChoiceOptions four;
    four.max_face_neighbors = 4;
    NeighborDistances d = with({0, 0, 1}, 2);
    d[static_cast<unsigned>(std::countr_zero(mask({{-1, 0, 0}})))] = 3;
    CHECK(choose_neighbors(six | edge_neighbors, d, four) == (six & ~mask({{0, 0, 1}, {-1, 0, 0}})));
    CHECK(choose_neighbors(six & ~mask({{0, 1, 0}}), d, four) == (six & ~mask({{0, 1, 0}, {-1, 0, 0}})));
}

TEST_CASE("a voxel alone has no neighbours", "[basic]") {
    CHECK(choose_neighbors(0, even()) == 0);
}
