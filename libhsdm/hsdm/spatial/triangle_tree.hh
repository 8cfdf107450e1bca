#pragma once
// A hierarchy of boxes over triangles: nearest triangle to a point, pairs of triangles that may touch.

#include "hsdm/mesh/triangulate.hh"
#include "hsdm/spatial/eight_bounds.hh"
#include "hsdm/spatial/two_triangles.hh"

#include <array>
#include <memory>

namespace hsdm {

/// Two triangles by their indices.
using TrianglePair = std::array<Index, 2>;

/// Implicit 4-ary tree. Triangles are ordered so that every four make a block, every four blocks a node of
/// level 0, every four nodes of level k a node of level k + 1: children are found by arithmetic, a node is
/// nothing but the boxes of its four children. Everything is relative to the centre of the mesh, in double
/// precision: a search costs no more where an outlier lies far from the mesh, or the mesh has one far from
/// itself.
class TriangleTree {
public:
    /// given: triangles that follow each other in the list lie close together already. compact: they are
    /// sorted so that they do, which takes most of the build time but makes queries much faster.
    enum class Order { compact, given };

    /// O(t log t), parallel; the same tree for any number of threads. Nothing given need outlive it.
    TriangleTree(const std::vector<Vec3>& positions, const std::vector<Triangle>& triangles,
                 Order order = Order::compact);

    /// A squared distance and the nearest triangle.
    struct Nearest {
        double squared = std::numeric_limits<double>::infinity();
        Index triangle = no_index;
    };
    /// Nearest triangle to a point in the mesh's own coordinates. `hint` is a triangle to begin at (the
    /// answer for a point nearby), or no_index: it changes the time, never the distance.
    Nearest nearest(const Vec3& point, Index hint = no_index) const;
    /// A triangle within `bound` (its squared distance in `squared`) if there is one, else a farther one or
    /// none. With a hint nearby several times faster than nearest(), as the search goes up the tree from
    /// there.
    Nearest within(const Vec3& point, double bound, Index hint = no_index) const;

    /// The triangles that may be nearest to some of a few points close together, to search instead of the
    /// whole tree.
    class Part;
    /// Points in the mesh's own coordinates: their box, one of them, how far the others are from that one at
    /// most, and how far it is from the mesh.
    struct Packet {
        Box box;
        Vec3 middle;
        double radius, off;
    };
    /// Replaces `part` by the triangles for a packet. False if there are too many: the part is then not to be
    /// used.
    bool find_part(const Packet& packet, Part& part) const;
    /// As above for a point of the part's packet. The part keeps what it measures.
    Nearest nearest(Part& part, const Vec3& point) const;

    /// Replaces `pairs` by all pairs of triangles whose boxes overlap or touch, one of the pair being in
    /// `block` and the other in it or a later one. Over all blocks every such pair comes once.
    void overlapping(Index block, std::vector<TrianglePair>& pairs) const;

    std::size_t block_count() const { return block_count_; }
    /// Mean diagonal of the boxes of blocks.
    double block_size() const { return block_size_; }

private:
    static constexpr std::size_t width = 4;
    Index block_of(Index triangle) const {
        return triangle == no_index ? no_index : place_of_[triangle] / width;
    }

    /// Boxes of four children by pairs; an absent child's box is empty, from infinity to its negative.
    struct Boxes {
        std::array<std::array<Double2, 2>, 3> lo, hi;
    };
    /// Four triangles; a block not full repeats its last one.
    using Block = std::array<TwoTriangles, 2>;

    class Search;

    struct LaneBoxes {
        std::array<Double2, 3> lo, hi;
    };

    void set_order(const std::vector<Vec3>& positions, const std::vector<Triangle>& triangles, Order order);
    void fill_blocks(const std::vector<Vec3>& positions, const std::vector<Triangle>& triangles);
    void build_levels(std::vector<Boxes>& block_boxes);
    std::size_t size_of(int level) const;
    double bounds_rounding() const;
    static bool is_apart(const Boxes& boxes, std::size_t child, const std::array<double, 3>& lo,
                         const std::array<double, 3>& hi);
    /// A node, or below them a block.
    struct Node {
        int level; ///< -1: of the blocks
        Index index;
    };
    Node root() const { return {static_cast<int>(level_first_.size()) - 1, 0}; }
    void descend(Search& search, const Node& from, const Node& known, double enough) const;
    LaneBoxes boxes_of(const TwoTriangles& pair) const;
    void pair_up(Index block, Index other, std::vector<TrianglePair>& pairs) const;

    Vec3 centre_{0, 0, 0};
    double diagonal_ = 0;
    double rounding_ = 0; // bound on the error of a + ab in a block
    double block_size_ = 0;
    std::vector<Index> triangle_of_; // by place in the order: the triangle's own index
    std::vector<Index> place_of_;    // ... and the other way
    std::size_t block_count_ = 0;
    std::unique_ptr<Block[]> blocks_;      // no vector: threads fill fresh memory sooner than one clears it
    std::vector<Boxes> nodes_;             // level 0 first, the root last
    std::vector<std::size_t> level_first_; // of each level, its first node
};

/// By the triangle inequality no point of a packet is farther from its nearest triangle than from that of the
/// packet's middle, so triangles farther from the middle than that and twice the radius are left out.
class TriangleTree::Part {
    friend class TriangleTree;
    static constexpr std::size_t most_blocks = 128;
    static constexpr std::size_t pairs = EightBounds::size / 2;

    /// Four pairs of triangles as they stand in the tree's blocks, and for the point that is looked at the
    /// square of a distance that each triangle is no nearer than.
    struct Eight {
        EightBounds bounds;
        EightBounds::Row least;
        std::array<Index, pairs> pair;
        double off_middle; ///< of the packet: none of the pairs, and of those of later eights, is nearer

        double least_of(std::size_t k) const { return std::min(least[2 * k], least[2 * k + 1]); }
    };
    struct Found {
        double squared; ///< of a distance from the middle that the pair is no nearer than
        Index pair;
        auto operator<=>(const Found&) const = default;
    };

    bool find_blocks(const TriangleTree& tree, const Box& box, double reach);
    void take_near(const TriangleTree& tree, const Vec3& middle, double most);
    static void load(const TriangleTree& tree, Index block, std::size_t half, Eight& eight);
    double measure(Eight& eight, const Vec3& point) const;
    void add_pair(const Eight& from, std::size_t k, double off);
    static void copy_pair(const Eight& from, std::size_t k, Eight& eight, std::size_t to);

    const BoundLanes& lanes_ = bound_lanes().front();
    Vec3 middle_{0, 0, 0};      // relative to the tree's centre
    std::vector<Index> blocks_; // while triangles are looked for, as the next two
    std::vector<Eight> found_;
    std::vector<Found> order_;
    std::vector<Eight> eights_; // of the packet, and memory that is kept
    std::size_t pair_count_ = 0;
};

} // namespace hsdm
