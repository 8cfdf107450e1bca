#include "hsdm/quality/triangle_tree.hh"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_invoke.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

namespace hsdm {
namespace {

using Range = tbb::blocked_range<std::size_t>;
constexpr std::size_t grain = 1 << 10;
/// Four entries a level of the walk, and 4^15 blocks hold 2^32 triangles.
constexpr std::size_t stack_size = 4 * 17;
constexpr float infinity = std::numeric_limits<float>::infinity();

float round_down(double x) {
    const float f = static_cast<float>(x);
    return f > x ? std::nextafter(f, -infinity) : f;
}
float round_up(double x) {
    const float f = static_cast<float>(x);
    return f < x ? std::nextafter(f, infinity) : f;
}

/// A triangle on its way to its place: the centre of its box, and its index.
struct Item {
    std::array<float, 3> centre;
    Index triangle;
};

std::size_t widest_axis(const Item* begin, const Item* end) {
    std::array<float, 3> lo = begin->centre, hi = begin->centre;
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

/// Orders items so that aligned runs of 4, 16, 64 ... lie close together: halves along the widest axis, cut
/// at a multiple of the largest run that still leaves something on both sides.
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
        Range(0, triangles.size(), grain), Box{},
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
    rounding_ = 4 * std::numeric_limits<double>::epsilon() * box.diagonal();
    set_order(positions, triangles, order);
    fill_blocks(positions, triangles);
}

void TriangleTree::set_order(const std::vector<Vec3>& positions, const std::vector<Triangle>& triangles,
                             Order order) {
    std::vector<Item> items(triangles.size());
    tbb::parallel_for(Range(0, items.size(), grain), [&](const Range& range) {
        for (std::size_t t = range.begin(); t != range.end(); ++t) {
            Box box;
            for (Index v : triangles[t]) box.add(positions[v] - centre_);
            const Vec3 middle = (box.lo + box.hi) / 2;
            for (unsigned k = 0; k < 3; ++k) items[t].centre[k] = static_cast<float>(middle[k]);
            items[t].triangle = static_cast<Index>(t);
        }
    });
    if (order == Order::compact) split(items.data(), items.data() + items.size());
    triangle_of_.resize(items.size());
    place_of_.resize(items.size());
    tbb::parallel_for(Range(0, items.size(), grain), [&](const Range& range) {
        for (std::size_t i = range.begin(); i != range.end(); ++i) {
            triangle_of_[i] = items[i].triangle;
            place_of_[items[i].triangle] = static_cast<Index>(i);
        }
    });
}

void TriangleTree::fill_blocks(const std::vector<Vec3>& positions, const std::vector<Triangle>& triangles) {
    const std::size_t blocks = block_count_ = (triangles.size() + width - 1) / width;
    const std::size_t parents = (blocks + width - 1) / width;
    blocks_ = std::make_unique_for_overwrite<Block[]>(blocks);
    std::vector<Boxes> boxes(parents);
    tbb::parallel_for(Range(0, parents * width, grain), [&](const Range& range) {
        for (std::size_t b = range.begin(); b != range.end(); ++b) {
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
                boxes[b / width].lo[k][b % width] = round_down(box.lo[k]);
                boxes[b / width].hi[k][b % width] = round_up(box.hi[k]);
            }
        }
    });
    for (std::size_t b = 0; b < blocks; ++b) {
        double squared = 0;
        for (std::size_t k = 0; k < 3; ++k)
            squared += square(static_cast<double>(boxes[b / width].hi[k][b % width])
                              - static_cast<double>(boxes[b / width].lo[k][b % width]));
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
        for (std::size_t k = 0; k < 3; ++k) {
            empty.lo[k] = Float4{} + infinity;
            empty.hi[k] = Float4{} - infinity;
        }
        std::vector<Boxes> parents((level.size() + width - 1) / width, empty);
        for (std::size_t i = 0; i < level.size(); ++i)
            for (std::size_t k = 0; k < 3; ++k) {
                const Float4 lo = level[i].lo[k], hi = level[i].hi[k];
                parents[i / width].lo[k][i % width] = std::min({lo[0], lo[1], lo[2], lo[3]});
                parents[i / width].hi[k][i % width] = std::max({hi[0], hi[1], hi[2], hi[3]});
            }
        level.swap(parents);
    }
}

/// The nearest triangle to a point so far. A box is skipped when even the float point, moved by its rounding
/// error, cannot come below the best.
class TriangleTree::Search {
public:
    /// Of what is farther than `most` nothing need be found.
    Search(const TriangleTree& tree, const Vec3& given, double most = infinity) : tree_(tree) {
        const Vec3 point = given - tree.centre_;
        double rounding = 0;
        for (unsigned k = 0; k < 3; ++k) {
            spread_[k] = Double2{} + point[k];
            point_[k] = static_cast<float>(point[k]);
            rounding += std::abs(point[k] - static_cast<double>(point_[k]));
        }
        slack_ = 102 * rounding * rounding;
        limit_ = limit(most * most);
    }

    void look_at(Index block) {
        const Double2 one = to_pair(block, 0), other = to_pair(block, 1), pairs = min_lanes(one, other);
        const double squared = std::min(pairs[0], pairs[1]);
        if (!(squared < squared_)) return;
        const Index lane = one[0] == squared ? 0 : one[1] == squared ? 1 : other[0] == squared ? 2 : 3;
        take(squared, block * static_cast<Index>(width) + lane);
    }

    /// At two triangles, one of them at this place.
    void look_around(Index place) {
        const Double2 pair = to_pair(place / width, place / 2 % 2);
        const Index lane = pair[1] < pair[0];
        take(pair[lane], place - place % 2 + lane);
    }

    /// Per child of a node, the squared distance to its box.
    Float4 to_children(const Boxes& boxes) const {
        Float4 squared{};
        for (std::size_t k = 0; k < 3; ++k)
            squared +=
                square(max_lanes(max_lanes(boxes.lo[k] - point_[k], point_[k] - boxes.hi[k]), Float4{}));
        return squared;
    }

    auto reaches(auto squared) const { return squared <= limit_; } // a float, or four
    double squared() const { return squared_; }

    Nearest result() const {
        if (place_ == no_index) return {};
        return {squared_, tree_.triangle_of_[std::min<std::size_t>(place_, tree_.triangle_of_.size() - 1)]};
    }

private:
    Double2 to_pair(std::size_t block, std::size_t half) const {
        return tree_.blocks_[block][half].squared_distances(spread_);
    }

    void take(double squared, Index place) {
        squared_ = squared;
        place_ = place;
        limit_ = std::min(limit_, limit(squared));
    }

    /// No less than the square of the distance and the rounding together, and a little.
    float limit(double squared) const {
        return static_cast<float>(1.01 * squared + slack_) + std::numeric_limits<float>::min();
    }

    const TriangleTree& tree_;
    std::array<Double2, 3> spread_{};
    std::array<float, 3> point_{};
    double slack_ = 0;
    float limit_ = infinity;
    double squared_ = std::numeric_limits<double>::infinity();
    Index place_ = no_index; // in the tree's order
};

/// Nodes or, below them, blocks. Coordinates so large that floats overflow lead to absent ones too.
std::size_t TriangleTree::size_of(int level) const {
    if (level < 0) return block_count_;
    const auto next = static_cast<std::size_t>(level) + 1;
    return (next < level_first_.size() ? level_first_[next] : nodes_.size()) - level_first_[next - 1];
}

/// All that is below a node, but for what is known, until something is near enough.
void TriangleTree::descend(Search& search, const Node& from, const Node& known, double enough) const {
    struct Entry {
        float squared;
        Node node;
    };
    std::array<Entry, stack_size> stack;
    std::size_t top = 0;
    // Nearest child last, so that it is the next one taken.
    const auto push_children = [&](const Node& node) {
        const Float4 squared =
            search.to_children(nodes_[level_first_[static_cast<std::size_t>(node.level)] + node.index]);
        const std::size_t bottom = top;
        for (unsigned left = lanes_of(search.reaches(squared)); left != 0; left &= left - 1) {
            const auto i = static_cast<Index>(std::countr_zero(left));
            const Node child{node.level - 1, static_cast<Index>(width) * node.index + i};
            if (child.index == known.index && child.level == known.level) continue;
            std::size_t at = top++;
            for (; at > bottom && stack[at - 1].squared < squared[i]; --at) stack[at] = stack[at - 1];
            stack[at] = {squared[i], child};
        }
    };
    push_children(from);
    while (top > 0 && search.squared() > enough) {
        const auto [squared, node] = stack[--top];
        if (!search.reaches(squared)) continue;
        if (squared == infinity && node.index >= size_of(node.level)) continue;
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

bool TriangleTree::find_part(const Box& box, double reach, Part& part) const {
    part.count_ = 0;
    if (block_count_ == 0) return true;
    std::array<float, 3> lo, hi;
    reach += 4 * rounding_; // a distance that came out as nothing need not be none
    for (unsigned k = 0; k < 3; ++k) {
        lo[k] = round_down(box.lo[k] - centre_[k] - reach);
        hi[k] = round_up(box.hi[k] - centre_[k] + reach);
    }
    struct Entry {
        Index node; // in its level
        int level;
    };
    std::array<Entry, stack_size> stack;
    std::size_t top = 0;
    stack[top++] = {0, static_cast<int>(level_first_.size()) - 1};
    while (top > 0) {
        const Entry entry = stack[--top];
        if (entry.node >= size_of(entry.level)) continue;
        const Boxes& boxes = nodes_[level_first_[static_cast<std::size_t>(entry.level)] + entry.node];
        auto apart = boxes.lo[0] > hi[0];
        for (std::size_t k = 0; k < 3; ++k) apart |= (boxes.lo[k] > hi[k]) | (lo[k] > boxes.hi[k]);
        for (std::size_t i = 0; i < width; ++i) {
            if (apart[i]) continue;
            const auto child = static_cast<Index>(width * entry.node + i);
            if (entry.level > 0)
                stack[top++] = {child, entry.level - 1};
            else if (child < block_count_ && !part.add(boxes, i, child))
                return false;
        }
    }
    part.fill_up();
    return true;
}

bool TriangleTree::Part::add(const Boxes& boxes, std::size_t lane, Index block) {
    if (count_ == width * most_nodes) return false;
    for (std::size_t k = 0; k < 3; ++k) {
        nodes_[count_ / width].lo[k][count_ % width] = boxes.lo[k][lane];
        nodes_[count_ / width].hi[k][count_ % width] = boxes.hi[k][lane];
    }
    blocks_[count_ / width][count_ % width] = block;
    ++count_;
    return true;
}

/// The last block stands in for those that the last node lacks.
void TriangleTree::Part::fill_up() {
    if (count_ == 0) return;
    const std::size_t last = count_ - 1;
    while (count_ % width != 0) add(nodes_[last / width], last % width, blocks_[last / width][last % width]);
}

TriangleTree::Nearest TriangleTree::nearest(const Part& part, const Vec3& point) const {
    Search search(*this, point);
    if (part.count_ == 0) return search.result();
    const std::size_t nodes = part.count_ / width;
    // Per lane the least, its node in the lowest bits: floats that are not negative are in order as integers.
    static_assert(std::has_single_bit(Part::most_nodes));
    constexpr std::int32_t node_bits = Part::most_nodes - 1;
    Int4 least = Int4{} + std::numeric_limits<std::int32_t>::max();
    std::array<Float4, Part::most_nodes> squared;
    for (std::size_t n = 0; n < nodes; ++n) {
        squared[n] = search.to_children(part.nodes_[n]);
        const Int4 key = (reinterpret_cast<Int4>(squared[n]) & ~node_bits) | static_cast<std::int32_t>(n);
        least = min_lanes(least, key);
    }
    std::size_t lane = 0;
    for (std::size_t i = 1; i < width; ++i) lane = least[i] < least[lane] ? i : lane;
    const std::size_t first = static_cast<std::size_t>(least[lane] & node_bits);
    search.look_at(part.blocks_[first][lane]);
    squared[first][lane] = infinity;
    for (std::size_t n = 0; n < nodes; ++n) {
        if (!any(search.reaches(squared[n]))) continue;
        for (std::size_t i = 0; i < width; ++i)
            if (search.reaches(squared[n][i])) search.look_at(part.blocks_[n][i]);
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
    std::array<float, 3> lo, hi;
    for (std::size_t k = 0; k < 3; ++k) {
        lo[k] = siblings.lo[k][block % width];
        hi[k] = siblings.hi[k][block % width];
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
        auto apart = boxes.lo[0] > hi[0];
        for (std::size_t k = 0; k < 3; ++k) apart |= (boxes.lo[k] > hi[k]) | (lo[k] > boxes.hi[k]);
        for (std::size_t i = 0; i < width; ++i) {
            const std::size_t child = width * entry.child + i;
            const bool earlier = (child + 1) << (2 * entry.level) <= block; // ends before the block begins
            if (!apart[i] && !earlier) stack[top++] = {static_cast<Index>(child), entry.level - 1};
        }
    }
}

} // namespace hsdm
