#include "hsdm/quality/triangle_tree.hh"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_invoke.h>

#include <algorithm>
#include <cmath>

namespace hsdm {
namespace {

using Range = tbb::blocked_range<std::size_t>;
constexpr std::size_t grain = 1 << 10;
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
    std::nth_element(begin, middle, end, [axis](const Item& a, const Item& b) {
        return a.centre[axis] != b.centre[axis] ? a.centre[axis] < b.centre[axis] : a.triangle < b.triangle;
    });
    if (n < 4096) {
        split(begin, middle);
        split(middle, end);
    } else {
        tbb::parallel_invoke([=] { split(begin, middle); }, [=] { split(middle, end); });
    }
}

} // namespace

TriangleTree::TriangleTree(const std::vector<Vec3>& positions, const std::vector<Triangle>& triangles) {
    if (triangles.empty()) return;
    Box box;
    for (const Triangle& t : triangles)
        for (Index v : t) box.add(positions[v]);
    centre_ = box.lo + box.size() / 2;
    order(positions, triangles);
    fill_blocks(positions, triangles);
}

void TriangleTree::order(const std::vector<Vec3>& positions, const std::vector<Triangle>& triangles) {
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
    split(items.data(), items.data() + items.size());
    triangle_of_.resize(items.size());
    for (std::size_t i = 0; i < items.size(); ++i) triangle_of_[i] = items[i].triangle;
}

void TriangleTree::fill_blocks(const std::vector<Vec3>& positions, const std::vector<Triangle>& triangles) {
    const std::size_t blocks = (triangles.size() + width - 1) / width;
    const std::size_t parents = (blocks + width - 1) / width;
    blocks_.resize(blocks);
    std::vector<Boxes> boxes(parents);
    tbb::parallel_for(Range(0, parents * width, grain), [&](const Range& range) {
        for (std::size_t b = range.begin(); b != range.end(); ++b) {
            Box box;
            for (std::size_t lane = 0; b < blocks && lane < width; ++lane) {
                const std::size_t place = std::min(b * width + lane, triangle_of_.size() - 1);
                const Triangle& t = triangles[triangle_of_[place]];
                const Vec3 a = positions[t[0]] - centre_, p = positions[t[1]] - centre_,
                           q = positions[t[2]] - centre_;
                for (unsigned k = 0; k < 3; ++k) {
                    blocks_[b].a[k][lane] = a[k];
                    blocks_[b].ab[k][lane] = p[k] - a[k];
                    blocks_[b].ac[k][lane] = q[k] - a[k];
                }
                box.add(a);
                box.add(p);
                box.add(q);
            }
            for (unsigned k = 0; k < 3; ++k) {
                boxes[b / width].lo[k][b % width] = round_down(box.lo[k]);
                boxes[b / width].hi[k][b % width] = round_up(box.hi[k]);
            }
        }
    });
    build_levels(boxes);
}

void TriangleTree::build_levels(std::vector<Boxes>& level) {
    for (;;) {
        level_first_.push_back(nodes_.size());
        nodes_.insert(nodes_.end(), level.begin(), level.end());
        if (level.size() == 1) return;
        Boxes empty;
        for (std::size_t k = 0; k < 3; ++k) {
            empty.lo[k].fill(infinity);
            empty.hi[k].fill(-infinity);
        }
        std::vector<Boxes> parents((level.size() + width - 1) / width, empty);
        for (std::size_t i = 0; i < level.size(); ++i)
            for (std::size_t k = 0; k < 3; ++k) {
                const auto& [lo, hi] = level[i];
                parents[i / width].lo[k][i % width] = *std::min_element(lo[k].begin(), lo[k].end());
                parents[i / width].hi[k][i % width] = *std::max_element(hi[k].begin(), hi[k].end());
            }
        level.swap(parents);
    }
}

/// Least squared distance to the four triangles. For each: the point's foot on the plane if it lies inside,
/// and the nearest point of each side; all of them are points of the triangle, so their least distance is
/// right even where a degenerate triangle makes the foot meaningless. No branches: four lanes at once.
double TriangleTree::nearest_in_block(const Block& block, const Vec3& point) {
    std::array<double, width> least;
    for (std::size_t i = 0; i < width; ++i) {
        const double bx = block.ab[0][i], by = block.ab[1][i], bz = block.ab[2][i];
        const double cx = block.ac[0][i], cy = block.ac[1][i], cz = block.ac[2][i];
        const double px = point[0] - block.a[0][i], py = point[1] - block.a[1][i],
                     pz = point[2] - block.a[2][i];
        const double ex = cx - bx, ey = cy - by, ez = cz - bz;
        const double qx = px - bx, qy = py - by, qz = pz - bz;
        const double bb = bx * bx + by * by + bz * bz, cc = cx * cx + cy * cy + cz * cz;
        const double bc = bx * cx + by * cy + bz * cz, ee = ex * ex + ey * ey + ez * ez;
        const double pb = px * bx + py * by + pz * bz, pc = px * cx + py * cy + pz * cz;
        const double qe = qx * ex + qy * ey + qz * ez;
        constexpr double tiny = std::numeric_limits<double>::min();

        auto clamp01 = [](double t) {
            t = t > 0.0 ? t : 0.0;
            return t < 1.0 ? t : 1.0;
        };
        const double tb = clamp01(pb / (bb > tiny ? bb : tiny));
        const double tc = clamp01(pc / (cc > tiny ? cc : tiny));
        const double te = clamp01(qe / (ee > tiny ? ee : tiny));
        const double det = bb * cc - bc * bc, safe_det = det > tiny ? det : tiny;
        const double s = (cc * pb - bc * pc) / safe_det, t = (bb * pc - bc * pb) / safe_det;

        auto squared = [](double x, double y, double z) { return x * x + y * y + z * z; };
        const double to_b = squared(px - tb * bx, py - tb * by, pz - tb * bz);
        const double to_c = squared(px - tc * cx, py - tc * cy, pz - tc * cz);
        const double to_e = squared(qx - te * ex, qy - te * ey, qz - te * ez);
        const double to_plane = squared(px - s * bx - t * cx, py - s * by - t * cy, pz - s * bz - t * cz);
        double d = to_b < to_c ? to_b : to_c;
        d = to_e < d ? to_e : d;
        const double inside_margin = s < t ? s : t, far_margin = 1 - s - t;
        const double margin = inside_margin < far_margin ? inside_margin : far_margin;
        const double inside = margin >= 0 ? to_plane : d;
        least[i] = inside < d ? inside : d;
    }
    return std::min(std::min(least[0], least[1]), std::min(least[2], least[3]));
}

TriangleTree::Nearest TriangleTree::nearest(const Vec3& given, Index hint) const {
    Nearest best;
    if (blocks_.empty()) return best;
    const Vec3 point = given - centre_;
    const std::array<float, 3> p{static_cast<float>(point[0]), static_cast<float>(point[1]),
                                 static_cast<float>(point[2])};
    // A box is skipped when even the float point, moved by its rounding error, cannot come below the best.
    double rounding = 0;
    for (unsigned k = 0; k < 3; ++k) rounding += std::abs(point[k] - static_cast<double>(p[k]));
    float limit = infinity;
    auto look_at = [&](Index block) {
        const double squared = nearest_in_block(blocks_[block], point);
        if (!(squared < best.squared)) return;
        best = {squared, block};
        const double reach = std::sqrt(squared) + rounding;
        limit = static_cast<float>(1.00001 * reach * reach) + std::numeric_limits<float>::min();
    };
    if (hint != no_index) look_at(hint);

    struct Entry {
        float squared;
        Index child; // index in its level, or block
        int level;   // -1: a block
    };
    std::array<Entry, 4 * 18> stack; // four entries a level, and 4^17 blocks hold more than 2^32 triangles
    std::size_t top = 0;
    stack[top++] = {0, 0, static_cast<int>(level_first_.size()) - 1};
    while (top > 0) {
        const Entry entry = stack[--top];
        if (entry.squared > limit) continue;
        if (entry.level < 0) {
            if (entry.child != hint) look_at(entry.child);
            continue;
        }
        const Boxes& boxes = nodes_[level_first_[static_cast<std::size_t>(entry.level)] + entry.child];
        std::array<float, width> squared{};
        for (std::size_t k = 0; k < 3; ++k)
            for (std::size_t i = 0; i < width; ++i) {
                const float below = boxes.lo[k][i] - p[k], above = p[k] - boxes.hi[k][i];
                float outside = below > above ? below : above;
                outside = outside > 0 ? outside : 0;
                squared[i] += outside * outside;
            }
        // Nearest child last, so that it is the next one taken.
        const std::size_t bottom = top;
        for (std::size_t i = 0; i < width; ++i) {
            if (!(squared[i] <= limit)) continue;
            std::size_t at = top++;
            for (; at > bottom && stack[at - 1].squared < squared[i]; --at) stack[at] = stack[at - 1];
            stack[at] = {squared[i], static_cast<Index>(width * entry.child + i), entry.level - 1};
        }
    }
    return best;
}

} // namespace hsdm
