#include "hsdm/simplify/cell_tree.hh"
#include "support/random.hh"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>

using namespace hsdm;

namespace {

std::vector<Vec3> random_positions(std::uint64_t seed, int count) {
    support::Random random(seed);
    std::vector<Vec3> positions;
    for (int i = 0; i < count; ++i) {
        // On a sphere that sticks out of the unit cube a little.
        const Vec3 d(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
        positions.push_back(Vec3(0.5, 0.5, 0.5) + d.normalized() * 0.51);
    }
    return positions;
}

/// Some cells are not whole, nor any above them.
void subdivide_somewhere(CellTree& tree, std::uint64_t seed) {
    support::Random random(seed);
    for (std::size_t level = tree.levels.size() - 1; level-- > 0;) {
        const CellLevel& below = tree.levels[level + 1];
        for (std::size_t c = 0; c < below.codes.size(); ++c)
            if (!below.whole[c]) tree.levels[level].whole[below.parent[c]] = 0;
        for (auto& whole : tree.levels[level].whole)
            if (random.uniform(0, 1) < 0.02) whole = 0;
    }
}

struct Leaf {
    int level;
    VoxelCoord at;
};

std::vector<Leaf> leaves(const CellTree& tree) {
    std::vector<Leaf> found;
    for (int level = 0; level <= tree.depth(); ++level) {
        const CellLevel& cells = tree.levels[static_cast<std::size_t>(level)];
        for (Index c = 0; c < cells.codes.size(); ++c)
            if (tree.is_leaf(level, c)) found.push_back({level, morton_decode(cells.codes[c])});
    }
    return found;
}

bool touch(const Leaf& a, const Leaf& b, int depth) {
    for (unsigned k = 0; k < 3; ++k) {
        const int size_a = 1 << (depth - a.level), size_b = 1 << (depth - b.level);
        const int lo_a = a.at[k] * size_a, lo_b = b.at[k] * size_b;
        if (lo_a > lo_b + size_b || lo_b > lo_a + size_a) return false;
    }
    return true;
}

/// Subdivides any leaf that touches a smaller cell that is subdivided, until there is none.
void balance_by_force(CellTree& tree) {
    for (bool changed = true; changed;) {
        changed = false;
        std::vector<Leaf> divided;
        for (int level = 0; level < tree.depth(); ++level) {
            const CellLevel& cells = tree.levels[static_cast<std::size_t>(level)];
            for (Index c = 0; c < cells.codes.size(); ++c)
                if (!cells.whole[c]) divided.push_back({level, morton_decode(cells.codes[c])});
        }
        for (const Leaf& leaf : leaves(tree))
            for (const Leaf& cell : divided)
                if (leaf.level < cell.level && touch(leaf, cell, tree.depth()))
                    changed =
                        tree.split(leaf.level, tree.find(leaf.level, morton_encode(leaf.at))) || changed;
    }
}

} // namespace

TEST_CASE("every vertex lies in one cell of each level, children under their parents", "[simplify]") {
    const auto positions = random_positions(1, 500);
    const CellTree tree = build_cell_tree(positions, 1, 5);
    REQUIRE(tree.depth() == 5);
    for (std::size_t v = 0; v < positions.size(); ++v) {
        Index cell = tree.of_vertex[v];
        for (int level = 5; level > 0; --level) {
            REQUIRE(tree.levels[static_cast<std::size_t>(level)].codes[cell]
                    == tree.code_at(positions[v]) >> 3 * (5 - level));
            cell = tree.levels[static_cast<std::size_t>(level)].parent[cell];
        }
    }
    CHECK(leaves(tree).size() == tree.levels[0].codes.size());
}

TEST_CASE("balancing subdivides exactly the cells that brute force does", "[simplify]") {
    for (std::uint64_t seed = 1; seed <= 6; ++seed) {
        INFO("seed " << seed);
        CellTree tree = build_cell_tree(random_positions(seed, 1500), 1, 6);
        subdivide_somewhere(tree, seed);
        CellTree by_force = tree;
        const std::size_t splits = balance(tree);
        balance_by_force(by_force);
        CHECK(splits > 0);
        for (std::size_t level = 0; level < tree.levels.size(); ++level)
            CHECK(tree.levels[level].whole == by_force.levels[level].whole);
        CHECK(balance(tree) == 0);
    }
}

TEST_CASE("only leaves above the deepest level can be subdivided", "[simplify]") {
    CellTree tree = build_cell_tree(random_positions(2, 200), 1, 3);
    CHECK_FALSE(tree.split(3, 0));
    CHECK_FALSE(tree.split(2, 0));
    CHECK(tree.split(0, 0));
    CHECK_FALSE(tree.split(0, 0));
    CHECK(tree.is_leaf(1, 0));
}
