#pragma once
// A hierarchy of boxes over triangles: nearest triangle to a point, pairs of triangles that may touch.

#include "hsdm/facets/triangulate.hh"

#include <array>
#include <cstdint>

namespace hsdm {

/// Implicit 4-ary tree. Triangles are ordered so that every four make a block, every four blocks a node of
/// level 0, every four nodes of level k a node of level k + 1: children are found by arithmetic, a node is
/// nothing but the boxes of its four children. Everything is relative to the centre of the mesh, boxes are
/// floats rounded outwards.
class TriangleTree {
public:
    /// O(t log t), parallel; the same tree for any number of threads. Nothing given need outlive it.
    TriangleTree(const std::vector<Vec3>& positions, const std::vector<Triangle>& triangles);

    /// A squared distance and the block that holds the nearest triangle.
    struct Nearest {
        double squared = std::numeric_limits<double>::infinity();
        Index block = no_index;
    };
    /// Nearest triangle to a point in the mesh's own coordinates. `hint` is a block to begin with (the answer
    /// for a point nearby), or no_index: it changes the time, never the distance.
    Nearest nearest(const Vec3& point, Index hint = no_index) const;

    std::size_t size() const { return triangle_of_.size(); }

private:
    static constexpr std::size_t width = 4;

    /// Boxes of four children; an absent child's box is empty.
    struct Boxes {
        std::array<std::array<float, width>, 3> lo, hi;
    };
    /// Four triangles, corner a and the sides from it; a block not full repeats its last triangle.
    struct Block {
        std::array<std::array<double, width>, 3> a, ab, ac;
    };

    void order(const std::vector<Vec3>& positions, const std::vector<Triangle>& triangles);
    void fill_blocks(const std::vector<Vec3>& positions, const std::vector<Triangle>& triangles);
    void build_levels(std::vector<Boxes>& block_boxes);
    static double nearest_in_block(const Block& block, const Vec3& point);

    Vec3 centre_{0, 0, 0};
    std::vector<Index> triangle_of_; // by place in the order: the triangle's own index
    std::vector<Block> blocks_;
    std::vector<Boxes> nodes_;             // level 0 first, the root last
    std::vector<std::size_t> level_first_; // of each level, its first node
};

} // namespace hsdm
