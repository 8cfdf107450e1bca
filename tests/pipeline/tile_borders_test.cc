// What tiles know and tell of each other, against looking at all pairs.
#include "hsdm/errors.hh"
#include "hsdm/pipeline/compare_pieces.hh"
#include "hsdm/pipeline/join_pieces.hh"
#include "hsdm/pipeline/near_cells.hh"
#include "support/random.hh"
#include "support/rank_threads.hh"

#include <catch2/catch.hpp>

#include <algorithm>
#include <mutex>
#include <numeric>
#include <set>

using namespace hsdm;

namespace {

/// Different numbers in [0, end), ascending.
std::vector<MortonCode> some_codes(std::size_t count, MortonCode end, support::Random& random) {
    std::set<MortonCode> codes;
    while (codes.size() < count)
        codes.insert(static_cast<MortonCode>(random.uniform() * static_cast<double>(end)));
    return {codes.begin(), codes.end()};
}

constexpr int level_depth = 5, shift_of_cells = 3; // 4 x 4 x 4 cells of 8 x 8 x 8 voxels

/// Tiles of a level: ranges of whole cells.
std::vector<VoxelRange> some_tiles(std::size_t count, support::Random& random) {
    std::vector<MortonCode> begins = some_codes(count - 1, 63, random);
    for (MortonCode& begin : begins) ++begin;
    begins.insert(begins.begin(), 0);
    begins.push_back(64);
    std::vector<VoxelRange> tiles;
    for (std::size_t k = 0; k < count; ++k)
        tiles.push_back({begins[k] << 3 * shift_of_cells, begins[k + 1] << 3 * shift_of_cells, level_depth,
                         shift_of_cells});
    return tiles;
}

/// Pieces that agree: what each has within two voxels of another and what it sees there.
std::vector<Piece> agreeing_pieces(const std::vector<VoxelRange>& tiles,
                                   const std::vector<MortonCode>& voxels) {
    std::vector<Piece> pieces(tiles.size());
    for (std::size_t k = 0; k < tiles.size(); ++k) {
        pieces[k].range = tiles[k];
        for (const MortonCode code : voxels) {
            const VoxelCoord at = morton_decode(code);
            if (!tiles[k].holds(code)) {
                if (tiles[k].is_near(at, compared_voxels)) pieces[k].beyond.push_back({code, 7 * code});
            } else if (!tiles[k].holds_around(at, compared_voxels)) {
                pieces[k].border.push_back({code, 7 * code});
            }
        }
    }
    return pieces;
}

/// What all ranks find, if each has every so-manieth tile.
std::vector<std::uint8_t> found_by(int ranks, const std::vector<Piece>& pieces,
                                   const std::vector<VoxelRange>& tiles) {
    std::vector<std::uint8_t> found;
    std::mutex mutex;
    const auto failures = support::run_ranks(ranks, [&](Ranks& own) {
        const auto owner = [&](std::size_t k) { return static_cast<int>(k) % own.size(); };
        std::vector<Piece> mine(pieces.size());
        for (std::size_t k = 0; k < pieces.size(); ++k)
            if (owner(k) == own.rank()) mine[k] = pieces[k];
        const std::vector<std::uint8_t> result = disagreeing_tiles(mine, tiles, owner, own);
        const std::lock_guard lock(mutex);
        if (own.is_first()) found = result;
    });
    for (const std::string& failure : failures) CHECK(failure.empty());
    return found;
}

} // namespace

TEST_CASE("cells near a range are those that looking at each finds", "[pipeline][tiles]") {
    support::Random random(11);
    const int depth = 4;
    std::vector<ScratchPoints::Cell> cells;
    for (const MortonCode code : some_codes(900, 4096, random)) cells.push_back({code, 1});
    for (int turn = 0; turn < 40; ++turn) {
        const auto borders = some_codes(2, 4097, random);
        const VoxelRange range{turn == 0 ? 0 : borders[0], turn == 0 ? 4096 : borders[1], depth, 0};
        const int reach = turn % 6;
        std::vector<MortonCode> expected;
        for (const auto& cell : cells)
            if (range.is_near(morton_decode(cell.code), reach)) expected.push_back(cell.code);
        CHECK(cells_near(range, reach, cells) == expected);
    }
    CHECK(cells_near({5, 5, depth, 0}, 3, cells).empty());
}

TEST_CASE("tiles that differ in a voxel that both look at are found, and no others", "[pipeline][tiles]") {
    support::Random random(12);
    const std::vector<MortonCode> voxels = some_codes(6000, MortonCode{1} << 3 * level_depth, random);
    for (int turn = 0; turn < 20; ++turn) {
        const std::vector<VoxelRange> tiles = some_tiles(2 + static_cast<std::size_t>(turn), random);
        std::vector<Piece> pieces = agreeing_pieces(tiles, voxels);
        const int ranks = 1 + turn % 3;
        CHECK(std::ranges::count(found_by(ranks, pieces, tiles), 1) == 0);
        // One tile finds another thing, or nothing, in a voxel of another one.
        std::size_t by = 0;
        while (pieces[by].beyond.empty()) ++by;
        std::vector<Piece::Digest>& beyond = pieces[by].beyond;
        const auto odd = beyond.begin() + static_cast<std::ptrdiff_t>(beyond.size() / 2);
        const MortonCode code = odd->code;
        if (turn % 2 == 0)
            ++odd->hash;
        else
            beyond.erase(odd);
        std::vector<std::uint8_t> expected(tiles.size(), 0);
        for (std::size_t k = 0; k < tiles.size(); ++k) expected[k] = k == by || tiles[k].holds(code);
        CHECK(found_by(ranks, pieces, tiles) == expected);
    }
}

TEST_CASE("a mesh of more corners than indices tell apart is refused", "[pipeline][tiles]") {
    const std::size_t most = std::size_t{no_index} - 1;
    CHECK_NOTHROW(check_mesh_size(most, most));
    for (const auto& [vertices, corners] : {std::pair(most + 1, most), {most, most + 1}, {most, 4 * most}})
        CHECK_THROWS_WITH(check_mesh_size(vertices, corners), Catch::Contains("--depth"));
}
