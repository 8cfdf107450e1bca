#include "hsdm/simplify/cell_tree.hh"

#include "hsdm/core/chunks.hh"
#include "hsdm/core/parallel_sort.hh"

#include <algorithm>
#include <array>
#include <cmath>

namespace hsdm {
MortonCode CellTree::code_at(const Vec3& position) const {
    const double cells = static_cast<double>(1u << depth());
    std::array<std::uint32_t, 3> c{};
    for (unsigned k = 0; k < 3; ++k) {
        // A plane on the faces of cells, up to rounding, goes to the upper cells only; on the cube's upper
        // faces it counts as inside.
        const double at = position[k] / extent * cells + rounding;
        const double cell = at >= cells && at < cells + 2 * rounding ? cells - 1 : std::floor(at);
        // Shifted by a whole cube, so that positions beside the cube have codes too.
        c[k] = static_cast<std::uint32_t>(std::clamp(cell + cells, 0.0, 3 * cells - 1));
    }
    return morton_encode(c[0], c[1], c[2]);
}

Index CellTree::find(int level, MortonCode code) const {
    const auto& codes = levels[static_cast<std::size_t>(level)].codes;
    const auto at = std::lower_bound(codes.begin(), codes.end(), code);
    return at != codes.end() && *at == code ? static_cast<Index>(at - codes.begin()) : no_index;
}

bool CellTree::is_leaf(int level, Index cell) const {
    const CellLevel& here = levels[static_cast<std::size_t>(level)];
    return here.whole[cell]
           && (level == 0 || !levels[static_cast<std::size_t>(level) - 1].whole[here.parent[cell]]);
}

bool CellTree::split(int level, Index cell) {
    if (level == depth() || !is_leaf(level, cell)) return false;
    levels[static_cast<std::size_t>(level)].whole[cell] = 0;
    return true;
}

CellTree build_cell_tree(std::span<const Vec3> positions, double extent, int depth) {
    CellTree tree;
    tree.extent = extent;
    tree.levels.resize(static_cast<std::size_t>(depth) + 1);
    std::vector<MortonCode> of_vertex = large_vector<MortonCode>(positions.size());
    for_each_index(positions.size(), chunks::quick,
                   [&](Index v) { of_vertex[v] = tree.code_at(positions[v]); });
    std::vector<MortonCode> codes = copy_of_large(of_vertex);
    parallel_sort(codes);
    for (std::size_t level = tree.levels.size(); level-- > 0;) {
        codes.erase(std::unique(codes.begin(), codes.end()), codes.end());
        CellLevel& here = tree.levels[level];
        here.codes = copy_of_large(codes);
        assign_large(here.whole, codes.size(), 1);
        for_each_index(codes.size(), chunks::light, [&](Index c) { codes[c] >>= 3; });
        if (level == 0) break;
        resize_large(here.parent, codes.size());
        for_each_in_order(codes.size(), [&](std::size_t c) {
            here.parent[c] = c == 0 ? 0 : here.parent[c - 1] + (codes[c] != codes[c - 1]);
        });
    }
    resize_large(tree.of_vertex, positions.size());
    for_each_index(positions.size(), chunks::quick,
                   [&](Index v) { tree.of_vertex[v] = tree.find(depth, of_vertex[v]); });
    return tree;
}

std::size_t balance(CellTree& tree) {
    std::size_t splits = 0;
    for (int level = tree.depth() - 1; level > 0; --level) {
        const CellLevel& here = tree.levels[static_cast<std::size_t>(level)];
        CellLevel& above = tree.levels[static_cast<std::size_t>(level) - 1];
        for_each_in_order(here.codes.size(), [&](std::size_t c) {
            if (here.whole[c]) return;
            const VoxelCoord at = morton_decode(here.codes[c]);
            for (int k = 0; k < 27; ++k) {
                const std::array<int, 3> step{k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1};
                // Two of the three steps along an axis lead to the same parent: skip the second.
                const auto repeats = [&](std::size_t axis) { return step[axis] == (at[axis] % 2 == 0); };
                if (repeats(0) || repeats(1) || repeats(2)) continue;
                const VoxelCoord n{at[0] + step[0], at[1] + step[1], at[2] + step[2]};
                if (n[0] < 0 || n[1] < 0 || n[2] < 0) continue;
                const Index cell = tree.find(level - 1, morton_encode(n) >> 3);
                if (cell == no_index || !above.whole[cell]) continue;
                above.whole[cell] = 0;
                splits += k != 13; // not counted: the cell's own parent was subdivided with it
            }
        });
    }
    return splits;
}

} // namespace hsdm
