#include "hsdm/spatial/triangle_tree.hh"

#include "hsdm/core/chunks.hh"

#include <tbb/blocked_range.h>
#include <tbb/parallel_invoke.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <cmath>

namespace hsdm {
namespace {

using Range = tbb::blocked_range<std::size_t>;
/// Four entries a level of the walk, and 4^15 blocks hold 2^32 triangles.
constexpr std::size_t stack_size = 4 * 17;
// of the mesh's diagonal: covers what rounding makes of distances in EightBounds
constexpr double bounds_rounding_share = 1e-11;

/// A triangle while they are sorted: the centre of its box, and its index.
struct Item {
    std::array<double, 3> centre;
    Index triangle;
};

std::size_t widest_axis(const Item* begin, const Item* end) {
    std::array<double, 3> lo = begin->centre, hi = begin->centre;
    for (const Item* item = begin; item != end; ++item)
        for (std::size_t k = 0; k < 3; ++k) {
            lo[k] = std::min(lo[k], item->centre[k]);
            hi[k] = std::max(hi[k], item->centre[k]);
        }
    std::size_t axis = 0;
    for (std::size_t k = 1; k < 3; ++k)
        if (hi[k] - lo[k] > hi[axis] - lo[axis]) axis = k;
    return axis;
}

/// Orders items so that aligned runs of 4, 16, 64 ... lie close together: halves them along the widest axis,
/// at a multiple of the largest run that leaves something on both sides.
void split(Item* begin, Item* end) {
    const auto n = static_cast<std::size_t>(end - begin);
    if (n <= 4) return;
    std::size_t run = 4;
    while (4 * run < n) run *= 4;
    Item* middle = begin + (n <= 2 * run ? run : 2 * run);
    const std::size_t axis = widest_axis(begin, end);
    std::nth_element(begin, middle, end,
                     [axis](const Item& a, const Item& b) { return a.centre[axis] < b.centre[axis]; });
    if (n < 4096) {
        split(begin, middle);
        split(middle, end);
    } else {
        tbb::parallel_invoke([=] { split(begin, middle); }, [=] { split(middle, end); });
    }
}

} // namespace

TriangleTree::TriangleTree(const std::vector<Vec3>& positions, const std::vector<Triangle>& triangles,
                           Order order) {
    if (triangles.empty()) return;
    const Box box = tbb::parallel_reduce(
        Range(0, triangles.size(), chunks::slow), Box{},
        [&](const Range& range, Box part) {
            for (std::size_t t = range.begin(); t != range.end(); ++t)
                for (Index v : triangles[t]) part.add(positions[v]);
            return part;
        },
        [](Box a, const Box& b) {
            a.add(b);
            return a;
        });
    centre_ = box.lo + box.size() / 2;
    diagonal_ = box.diagonal();
    rounding_ = 4 * std::numeric_limits<double>::epsilon() * diagonal_;
    set_order(positions, triangles, order);
    fill_blocks(positions, triangles);
}

void TriangleTree::set_order(const std::vector<Vec3>& positions, const std::vector<Triangle>& triangles,
                             Order order) {
    if (order == Order::given) {
        triangle_of_ = place_of_ = indices_below(triangles.size());
        return;
    }
    std::vector<Item> items = unwritten_vector<Item>(triangles.size());
    for_each_index(items.size(), chunks::slow, [&](Index t) {
        Box box;
        for (Index v : triangles[t]) box.add(positions[v] - centre_);
        const Vec3 middle = (box.lo + box.hi) / 2;
        for (unsigned k = 0; k < 3; ++k) items[t].centre[k] = middle[k];
        items[t].triangle = t;
    });
    split(items.data(), items.data() + items.size());
    resize_unwritten(triangle_of_, items.size());
    resize_unwritten(place_of_, items.size());
    for_each_index(items.size(), chunks::slow, [&](Index i) {
        triangle_of_[i] = items[i].triangle;
        place_of_[items[i].triangle] = i;
    });
}

void TriangleTree::fill_blocks(const std::vector<Vec3>& positions, const std::vector<Triangle>& triangles) {
    const std::size_t blocks = block_count_ = (triangles.size() + width - 1) / width;
    const std::size_t parents = (blocks + width - 1) / width;
    blocks_ = std::make_unique_for_overwrite<Block[]>(blocks);
    std::vector<Boxes> boxes(parents);
    for_each_index(parents * width, chunks::slow, [&](Index b) {
        Box box;
        for (std::size_t lane = 0; b < blocks && lane < width; ++lane) {
            const std::size_t place = std::min(b * width + lane, triangle_of_.size() - 1);
            const Triangle& t = triangles[triangle_of_[place]];
            const Vec3 p0 = positions[t[0]] - centre_, p1 = positions[t[1]] - centre_,
                       p2 = positions[t[2]] - centre_;
            blocks_[b][lane / 2].put(lane % 2, p0, p1 - p0, p2 - p0);
            for (const Vec3& p : {p0, p1, p2}) box.add(p);
        }
        for (unsigned k = 0; k < 3; ++k) {
            boxes[b / width].lo[k][b % width / 2][b % 2] = box.lo[k];
            boxes[b / width].hi[k][b % width / 2][b % 2] = box.hi[k];
        }
    });
    for (std::size_t b = 0; b < blocks; ++b) {
        double squared = 0;
        for (std::size_t k = 0; k < 3; ++k)
            squared += square(boxes[b / width].hi[k][b % width / 2][b % 2]
                              - boxes[b / width].lo[k][b % width / 2][b % 2]);
        block_size_ += std::sqrt(squared) / static_cast<double>(blocks);
    }
    build_levels(boxes);
}

void TriangleTree::build_levels(std::vector<Boxes>& level) {
    for (;;) {
        level_first_.push_back(nodes_.size());
        nodes_.insert(nodes_.end(), level.begin(), level.end());
        if (level.size() == 1) return;
        Boxes empty;
        for (std::size_t k = 0; k < 3; ++k)
            for (std::size_t half = 0; half < 2; ++half) {
                empty.lo[k][half] = Double2{} + Box::inf;
                empty.hi[k][half] = Double2{} - Box::inf;
            }
        std::vector<Boxes> parents((level.size() + width - 1) / width, empty);
        for (std::size_t i = 0; i < level.size(); ++i)
            for (std::size_t k = 0; k < 3; ++k) {
                const Double2 lo = min_lanes(level[i].lo[k][0], level[i].lo[k][1]);
                const Double2 hi = max_lanes(level[i].hi[k][0], level[i].hi[k][1]);
                parents[i / width].lo[k][i % width / 2][i % 2] = std::min(lo[0], lo[1]);
                parents[i / width].hi[k][i % width / 2][i % 2] = std::max(hi[0], hi[1]);
            }
        level.swap(parents);
    }
}

/// The nearest triangle to a point so far. A box is skipped when its distance is more than the best by what
/// rounding can make of the two.
class TriangleTree::Search {
public:
    /// Squared distances to the boxes of four children.
    using FourSquares = std::array<Double2, 2>;

    /// Triangles farther than `most` need not be found. A point with a coordinate that is not finite is near
    /// nothing.
    Search(const TriangleTree& tree, const Vec3& given, double most = Box::inf) : tree_(tree) {
        const Vec3 point = given - tree.centre_;
        for (unsigned k = 0; k < 3; ++k) point_[k] = Double2{} + point[k];
        rounding_ = 4 * std::numeric_limits<double>::epsilon() * (point.l1_norm() + tree.diagonal_);
        // Seen from so far away that rounding exceeds the mesh, any triangle counts as nearest.
        if (!(rounding_ < tree.diagonal_)) rounding_ = 0;
        limit_ = std::isfinite(point.l1_norm()) ? limit(most) : -1;
    }

    void look_at(Index block) {
        const Double2 one = to_pair(block, 0), other = to_pair(block, 1), pairs = min_lanes(one, other);
        const double squared = std::min(pairs[0], pairs[1]);
        if (!(squared < squared_)) return;
        const Index lane = one[0] == squared ? 0 : one[1] == squared ? 1 : other[0] == squared ? 2 : 3;
        take(squared, block * static_cast<Index>(width) + lane);
    }

    /// Tests half a block.
    void look_at(Index block, Index half) {
        const Double2 pair = to_pair(block, half);
        const Index lane = pair[1] < pair[0];
        if (pair[lane] < squared_) take(pair[lane], block * static_cast<Index>(width) + 2 * half + lane);
    }

    /// Tests two triangles, one of them at this place.
    void look_around(Index place) {
        const Double2 pair = to_pair(place / width, place / 2 % 2);
        const Index lane = pair[1] < pair[0];
        take(pair[lane], place - place % 2 + lane);
    }

    FourSquares to_children(const Boxes& boxes) const {
        FourSquares squared{};
        for (std::size_t half = 0; half < 2; ++half)
            for (std::size_t k = 0; k < 3; ++k)
                squared[half] += square(max_lanes(
                    max_lanes(boxes.lo[k][half] - point_[k], point_[k] - boxes.hi[k][half]), Double2{}));
        return squared;
    }

    /// To be called before any test where other distances than those of boxes decide what is tested: by how
    /// much rounding may change them.
    void rely_on(double rounding) { rounding_ = std::max(rounding_, rounding); }

    /// May a box at this squared distance hold a nearer triangle? Never true of an absent child, whose box is
    /// infinitely far.
    bool reaches(double squared) const { return squared < limit_; }
    double squared() const { return squared_; }

    Nearest result() const {
        if (place_ == no_index) return {};
        return {squared_, tree_.triangle_of_[std::min<std::size_t>(place_, tree_.triangle_of_.size() - 1)]};
    }

private:
    Double2 to_pair(std::size_t block, std::size_t half) const {
        return tree_.blocks_[block][half].squared_distances(point_);
    }

    void take(double squared, Index place) {
        squared_ = squared;
        place_ = place;
        limit_ = std::min(limit_, limit(std::sqrt(squared)));
    }

    /// The squared distance below which a box is of interest, given the best distance.
    double limit(double distance) const {
        const double enough = distance + rounding_;
        return enough * enough + std::numeric_limits<double>::min();
    }

    const TriangleTree& tree_;
    std::array<Double2, 3> point_{}; // each coordinate twice
    double rounding_ = 0;
    double limit_ = Box::inf;
    double squared_ = Box::inf;
    Index place_ = no_index; // in the tree's order
};

double TriangleTree::bounds_rounding() const {
    return bounds_rounding_share * diagonal_;
}

/// Number of nodes of a level, or of blocks for level -1.
std::size_t TriangleTree::size_of(int level) const {
    if (level < 0) return block_count_;
    const auto next = static_cast<std::size_t>(level) + 1;
    return (next < level_first_.size() ? level_first_[next] : nodes_.size()) - level_first_[next - 1];
}

/// Searches all that is below a node except what is `known`, until a triangle is near enough.
void TriangleTree::descend(Search& search, const Node& from, const Node& known, double enough) const {
    struct Entry {
        double squared;
        Node node;
    };
    std::array<Entry, stack_size> stack;
    std::size_t top = 0;
    // Nearest child last, so that it is the next one taken.
    const auto push_children = [&](const Node& node) {
        const auto four =
            search.to_children(nodes_[level_first_[static_cast<std::size_t>(node.level)] + node.index]);
        const std::size_t bottom = top;
        for (Index i = 0; i < width; ++i) {
            const double squared = four[i / 2][i % 2];
            if (!search.reaches(squared)) continue;
            const Node child{node.level - 1, static_cast<Index>(width) * node.index + i};
            if (child.index == known.index && child.level == known.level) continue;
            std::size_t at = top++;
            for (; at > bottom && stack[at - 1].squared < squared; --at) stack[at] = stack[at - 1];
            stack[at] = {squared, child};
        }
    };
    push_children(from);
    while (top > 0 && search.squared() > enough) {
        const auto [squared, node] = stack[--top];
        if (!search.reaches(squared)) continue;
        if (node.level < 0)
            search.look_at(node.index);
        else
            push_children(node);
    }
}

TriangleTree::Nearest TriangleTree::nearest(const Vec3& point, Index hint) const {
    if (block_count_ == 0) return {};
    Search search(*this, point);
    const Index block = block_of(hint);
    if (block != no_index) search.look_at(block);
    descend(search, root(), {-1, block}, 0);
    return search.result();
}

TriangleTree::Nearest TriangleTree::within(const Vec3& point, double bound, Index hint) const {
    if (block_count_ == 0) return {};
    Search search(*this, point, bound);
    const double enough = bound * bound;
    if (hint == no_index) {
        descend(search, root(), {-1, no_index}, enough);
        return search.result();
    }
    search.look_around(place_of_[hint]);
    if (search.squared() > enough) search.look_at(block_of(hint));
    for (Node known{-1, block_of(hint)}; search.squared() > enough && known.level < root().level;) {
        const Node up{known.level + 1, known.index / static_cast<Index>(width)};
        descend(search, up, known, enough);
        known = up;
    }
    return search.result();
}

bool TriangleTree::is_apart(const Boxes& boxes, std::size_t child, const std::array<double, 3>& lo,
                            const std::array<double, 3>& hi) {
    for (std::size_t k = 0; k < 3; ++k)
        if (boxes.lo[k][child / 2][child % 2] > hi[k] || lo[k] > boxes.hi[k][child / 2][child % 2])
            return true;
    return false;
}

bool TriangleTree::find_part(const Packet& packet, Part& part) const {
    part.pair_count_ = 0;
    if (block_count_ == 0) return true;
    if (!part.find_blocks(*this, packet.box, 1.00001 * (packet.off + packet.radius))) return false;
    part.take_near(*this, packet.middle, 1.00001 * (packet.off + 2 * packet.radius));
    return true;
}

/// Finds all blocks that may have a point within `reach` of a box; false if there are too many.
bool TriangleTree::Part::find_blocks(const TriangleTree& tree, const Box& box, double reach) {
    blocks_.clear();
    std::array<double, 3> lo, hi;
    reach += 4 * tree.rounding_; // a distance that rounds to 0 need not be 0
    for (unsigned k = 0; k < 3; ++k) {
        lo[k] = box.lo[k] - tree.centre_[k] - reach;
        hi[k] = box.hi[k] - tree.centre_[k] + reach;
    }
    std::array<Node, stack_size> stack;
    std::size_t top = 0;
    stack[top++] = tree.root();
    while (top > 0) {
        const Node node = stack[--top];
        if (node.index >= tree.size_of(node.level)) continue;
        const Boxes& boxes =
            tree.nodes_[tree.level_first_[static_cast<std::size_t>(node.level)] + node.index];
        for (std::size_t i = 0; i < width; ++i) {
            if (is_apart(boxes, i, lo, hi)) continue;
            const auto child = static_cast<Index>(width * node.index + i);
            if (node.level > 0)
                stack[top++] = {node.level - 1, child};
            else if (child < tree.block_count_)
                blocks_.push_back(child);
        }
        if (blocks_.size() > most_blocks) return false;
    }
    return true;
}

/// Takes the pairs of the blocks' triangles of which one may be within `most` of the middle, the nearest
/// ones first.
void TriangleTree::Part::take_near(const TriangleTree& tree, const Vec3& middle, double most) {
    middle_ = middle - tree.centre_;
    if (found_.size() < chunk_count(blocks_.size(), 2)) found_.resize(chunk_count(blocks_.size(), 2));
    order_.clear();
    for (std::size_t b = 0; b < blocks_.size(); b += 2) {
        Eight& eight = found_[b / 2];
        load(tree, blocks_[b], 0, eight);
        load(tree, blocks_[std::min(b + 1, blocks_.size() - 1)], 1, eight);
        lanes_.prepare(eight.bounds);
        measure(eight, middle_);
        const std::size_t filled = b + 1 < blocks_.size() ? pairs : pairs / 2;
        for (std::size_t k = 0; k < filled; ++k)
            if (const double squared = eight.least_of(k); squared <= square(most + tree.bounds_rounding()))
                order_.push_back({squared, static_cast<Index>(b / 2 * pairs + k)});
    }
    std::sort(order_.begin(), order_.end());
    for (const auto& [squared, k] : order_) add_pair(found_[k / pairs], k % pairs, std::sqrt(squared));
    // the lanes that are left say what others say
    pair_count_ = order_.size();
    for (std::size_t at = pair_count_; at % pairs != 0; ++at)
        copy_pair(eights_[at / pairs], (pair_count_ - 1) % pairs, eights_[at / pairs], at % pairs);
}

void TriangleTree::Part::load(const TriangleTree& tree, Index block, std::size_t half, Eight& eight) {
    for (std::size_t lane = 0; lane < width; ++lane) {
        const TwoTriangles& two = tree.blocks_[block][lane / 2];
        const auto vector = [&](const std::array<Double2, 3>& lanes) {
            return Vec3(lanes[0][lane % 2], lanes[1][lane % 2], lanes[2][lane % 2]);
        };
        const Vec3 a = vector(two.a);
        eight.bounds.put(half * width + lane, a, a + vector(two.ab), a + vector(two.ac));
        eight.pair[half * width / 2 + lane / 2] = static_cast<Index>(2 * block + lane / 2);
    }
}

void TriangleTree::Part::add_pair(const Eight& from, std::size_t k, double off) {
    const std::size_t at = pair_count_++;
    if (at / pairs == eights_.size()) eights_.emplace_back();
    Eight& eight = eights_[at / pairs];
    if (at % pairs == 0) eight.off_middle = off;
    copy_pair(from, k, eight, at % pairs);
}

void TriangleTree::Part::copy_pair(const Eight& from, std::size_t k, Eight& eight, std::size_t to) {
    const auto copy = [&](const EightBounds::Row& row, EightBounds::Row& into) {
        into[2 * to] = row[2 * k];
        into[2 * to + 1] = row[2 * k + 1];
    };
    for (std::size_t axis = 0; axis < 3; ++axis) {
        copy(from.bounds.corner[axis], eight.bounds.corner[axis]);
        copy(from.bounds.normal[axis], eight.bounds.normal[axis]);
        for (std::size_t side = 0; side < 3; ++side)
            copy(from.bounds.out[side][axis], eight.bounds.out[side][axis]);
    }
    copy(from.bounds.across, eight.bounds.across);
    eight.pair[to] = from.pair[k];
}

/// Sets the least squares of an eight, those of planes where the point is beyond no side; returns the least.
double TriangleTree::Part::measure(Eight& eight, const Vec3& point) const {
    const LeastSquares found = lanes_.squares(eight.bounds, point, eight.least);
    for (double& squared : eight.least) squared = squared == Box::inf ? found.above : squared;
    return std::min(found.above, found.beyond);
}

/// Ends where all triangles that are left are so far from the packet's middle that they are too far from the
/// point.
TriangleTree::Nearest TriangleTree::nearest(Part& part, const Vec3& given) const {
    Search search(*this, given);
    search.rely_on(bounds_rounding());
    const Vec3 point = given - centre_;
    const double away = (point - part.middle_).norm();
    for (std::size_t first = 0; first < part.pair_count_; first += Part::pairs) {
        Part::Eight& eight = part.eights_[first / Part::pairs];
        if (const double off = eight.off_middle - away; off > 0 && !search.reaches(off * off)) break;
        const double least = part.measure(eight, point);
        if (!search.reaches(least)) continue;
        const std::size_t count = std::min(Part::pairs, part.pair_count_ - first);
        for (std::size_t k = 0; k < count; ++k)
            if (eight.least_of(k) <= least) search.look_at(eight.pair[k] / 2, eight.pair[k] % 2);
        for (std::size_t k = 0; k < count; ++k)
            if (const double squared = eight.least_of(k); squared > least && search.reaches(squared))
                search.look_at(eight.pair[k] / 2, eight.pair[k] % 2);
    }
    return search.result();
}

TriangleTree::LaneBoxes TriangleTree::boxes_of(const TwoTriangles& pair) const {
    LaneBoxes boxes;
    for (std::size_t k = 0; k < 3; ++k) {
        const Double2 b = pair.a[k] + pair.ab[k], c = pair.a[k] + pair.ac[k];
        boxes.lo[k] = min_lanes(pair.a[k], min_lanes(b, c)) - rounding_;
        boxes.hi[k] = max_lanes(pair.a[k], max_lanes(b, c)) + rounding_;
    }
    return boxes;
}

void TriangleTree::pair_up(Index block, Index other, std::vector<TrianglePair>& pairs) const {
    const std::array<LaneBoxes, 2> ours{boxes_of(blocks_[block][0]), boxes_of(blocks_[block][1])};
    const std::array<LaneBoxes, 2> theirs{boxes_of(blocks_[other][0]), boxes_of(blocks_[other][1])};
    for (std::size_t i = 0; i < width; ++i) {
        const std::size_t place = block * width + i;
        if (place >= triangle_of_.size()) break;
        const LaneBoxes& one = ours[i / 2];
        for (std::size_t half = 0; half < 2; ++half) {
            const LaneBoxes& two = theirs[half];
            auto apart = one.lo[0][i % 2] > two.hi[0];
            for (std::size_t k = 0; k < 3; ++k)
                apart |= (one.lo[k][i % 2] > two.hi[k]) | (two.lo[k] > one.hi[k][i % 2]);
            for (std::size_t lane = 0; lane < 2; ++lane) {
                const std::size_t other_place = other * width + 2 * half + lane;
                if (!apart[lane] && other_place > place && other_place < triangle_of_.size())
                    pairs.push_back({triangle_of_[place], triangle_of_[other_place]});
            }
        }
    }
}

void TriangleTree::overlapping(Index block, std::vector<TrianglePair>& pairs) const {
    pairs.clear();
    const Boxes& siblings = nodes_[block / width];
    std::array<double, 3> lo, hi;
    for (std::size_t k = 0; k < 3; ++k) {
        lo[k] = siblings.lo[k][block % width / 2][block % 2];
        hi[k] = siblings.hi[k][block % width / 2][block % 2];
    }
    struct Entry {
        Index child;
        int level; // -1: a block
    };
    std::array<Entry, stack_size> stack;
    std::size_t top = 0;
    stack[top++] = {0, static_cast<int>(level_first_.size()) - 1};
    while (top > 0) {
        const Entry entry = stack[--top];
        if (entry.child >= size_of(entry.level)) continue;
        if (entry.level < 0) {
            pair_up(block, entry.child, pairs);
            continue;
        }
        const Boxes& boxes = nodes_[level_first_[static_cast<std::size_t>(entry.level)] + entry.child];
        for (std::size_t i = 0; i < width; ++i) {
            const std::size_t child = width * entry.child + i;
            const bool earlier = (child + 1) << (2 * entry.level) <= block; // ends before the block begins
            if (!earlier && !is_apart(boxes, i, lo, hi))
                stack[top++] = {static_cast<Index>(child), entry.level - 1};
        }
    }
}

} // namespace hsdm
