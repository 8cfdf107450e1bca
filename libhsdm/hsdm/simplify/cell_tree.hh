#pragma once
// Section 3.4.1: the balanced octree over a fine mesh, stored as the cells of every level that hold vertices.

#include "hsdm/core/morton.hh"
#include "hsdm/types.hh"

#include <span>
#include <vector>

namespace hsdm {

/// One level's occupied cells, by ascending code.
struct CellLevel {
    std::vector<MortonCode> codes;   ///< counted from one cube before the least corner, in every direction
    std::vector<Index> parent;       ///< on the level above (coarser); empty on level 0
    std::vector<std::uint8_t> whole; ///< is neither the cell nor any cell below it to be subdivided?
};

/// The octree's cells that hold vertices, levels 0 (the cube) to depth. A leaf is a whole cell whose parent
/// is not whole; a cell of the deepest level is always whole, and a parent is whole only if its children are.
struct CellTree {
    std::vector<CellLevel> levels;
    std::vector<Index> of_vertex; ///< per vertex, its cell of the deepest level
    double extent = 0;            ///< edge of the cube
    /// In cells of the deepest level: how far a plane on the faces of cells may be off them by rounding.
    static constexpr double rounding = 0.01;

    int depth() const { return static_cast<int>(levels.size()) - 1; }
    /// The code of the deepest level's cell that holds a position relative to the cube's least corner;
    /// positions up to one cube away have codes too. A position on a face, within `rounding`, belongs to the
    /// upper cell, or on the cube's own upper faces to the lower one.
    MortonCode code_at(const Vec3& position) const;
    /// The cell of a level with this code, or no_index. O(log cells).
    Index find(int level, MortonCode code) const;
    bool is_leaf(int level, Index cell) const;
    /// Subdivides a leaf. False if the cell is not a leaf or is of the deepest level.
    bool split(int level, Index cell);
};

/// All cells whole. O(vertices log vertices), parallel.
CellTree build_cell_tree(std::span<const Vec3> positions, double extent, int depth);

/// Subdivides leaves until none touches, at a face, an edge or a corner, a cell of half its size that is
/// itself subdivided. One pass from the deepest level up, 27 look-ups a cell. Returns the number of cells
/// subdivided.
std::size_t balance(CellTree& tree);

} // namespace hsdm
