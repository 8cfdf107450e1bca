#include "hsdm/spatial/triangles_meet.hh"

#include "hsdm/core/orientation.hh"

#include <cmath>
#include <cstddef>

namespace hsdm {
namespace {

using Corners = std::array<Vec3, 3>;

Vec2 project(const Vec3& p, unsigned dropped) {
    return {p[(dropped + 1) % 3], p[(dropped + 2) % 3]};
}

/// The axis along which the triangle's projection is largest, so that dropping this coordinate leaves a
/// triangle. Decided by the rounded area vector; where that is 0 the projections are tried exactly.
unsigned dominant_axis(const Corners& t) {
    const Vec3 n = (t[1] - t[0]) % (t[2] - t[0]);
    unsigned axis = 0;
    for (unsigned k = 1; k < 3; ++k)
        if (std::abs(n[k]) > std::abs(n[axis])) axis = k;
    for (unsigned k = 0; k < 3; ++k) {
        const unsigned candidate = (axis + k) % 3;
        if (orientation(project(t[0], candidate), project(t[1], candidate), project(t[2], candidate)) != 0)
            return candidate;
    }
    return axis;
}

int side(const Corners& t, const Vec3& p) {
    return orientation(t[0], t[1], t[2], p);
}

/// Whether p, known to be on the line through a and b, lies between them, ends included.
bool between(const Vec2& a, const Vec2& b, const Vec2& p) {
    for (std::size_t k = 0; k < 2; ++k)
        if (p[k] < std::min(a[k], b[k]) || p[k] > std::max(a[k], b[k])) return false;
    return true;
}

bool segments_meet(const Vec2& a, const Vec2& b, const Vec2& p, const Vec2& q) {
    const int ap = orientation(a, b, p), aq = orientation(a, b, q);
    const int pa = orientation(p, q, a), pb = orientation(p, q, b);
    if (ap * aq < 0 && pa * pb < 0) return true;
    return (ap == 0 && between(a, b, p)) || (aq == 0 && between(a, b, q)) || (pa == 0 && between(p, q, a))
           || (pb == 0 && between(p, q, b));
}

bool coplanar_segment_meets(const Corners& t, const Vec3& p, const Vec3& q) {
    const unsigned axis = dominant_axis(t);
    const std::array<Vec2, 3> flat{project(t[0], axis), project(t[1], axis), project(t[2], axis)};
    const Vec2 from = project(p, axis), to = project(q, axis);
    int left = 0, right = 0;
    for (std::size_t k = 0; k < 3; ++k) {
        const int turn = orientation(flat[k], flat[(k + 1) % 3], from);
        left += turn > 0;
        right += turn < 0;
    }
    if (left == 0 || right == 0) return true; // the segment begins inside
    for (std::size_t k = 0; k < 3; ++k)
        if (segments_meet(flat[k], flat[(k + 1) % 3], from, to)) return true;
    return false;
}

/// `p_side` and `q_side`: the sides of the triangle's plane on which the segment's ends lie.
bool segment_meets(const Corners& t, const Vec3& p, int p_side, const Vec3& q, int q_side) {
    if (p_side * q_side > 0) return false;
    if (p_side == 0 && q_side == 0) return coplanar_segment_meets(t, p, q);
    int left = 0, right = 0;
    for (std::size_t k = 0; k < 3; ++k) {
        const int turn = orientation(p, q, t[k], t[(k + 1) % 3]);
        left += turn > 0;
        right += turn < 0;
    }
    return left == 0 || right == 0;
}

using Sides = std::array<int, 3>;

Sides sides(const Corners& t, const Corners& of) {
    return {side(t, of[0]), side(t, of[1]), side(t, of[2])};
}

bool one_sided(const Sides& s) {
    return s[0] == s[1] && s[1] == s[2] && s[0] != 0;
}

bool separate_triangles_meet(const Corners& a, const Corners& b) {
    const Sides of_b = sides(a, b);
    if (one_sided(of_b)) return false;
    const Sides of_a = sides(b, a);
    if (one_sided(of_a)) return false;
    for (std::size_t k = 0, next = 1; k < 3; ++k, next = (next + 1) % 3) {
        if (segment_meets(a, b[k], of_b[k], b[next], of_b[next])) return true;
        if (segment_meets(b, a[k], of_a[k], a[next], of_a[next])) return true;
    }
    return false;
}

/// The triangles share one vertex, corner i of a and j of b: they meet elsewhere only if the side of one
/// opposite to it meets the other.
bool meet_beside_vertex(const Corners& a, std::size_t i, const Corners& b, std::size_t j) {
    const Vec3 &a1 = a[(i + 1) % 3], &a2 = a[(i + 2) % 3], &b1 = b[(j + 1) % 3], &b2 = b[(j + 2) % 3];
    const int s1 = side(a, b1), s2 = side(a, b2);
    if (s1 * s2 > 0) return false;
    const int r1 = side(b, a1), r2 = side(b, a2);
    if (r1 * r2 > 0) return false;
    return segment_meets(a, b1, s1, b2, s2) || segment_meets(b, a1, r1, a2, r2);
}

/// The triangles share the side opposite to corner i of a, and to corner j of b.
bool meet_beside_edge(const Corners& a, std::size_t i, const Corners& b, std::size_t j) {
    if (side(a, b[j]) != 0) return false;
    const unsigned axis = dominant_axis(a);
    const Vec2 p = project(a[(i + 1) % 3], axis), q = project(a[(i + 2) % 3], axis);
    return orientation(p, q, project(a[i], axis)) == orientation(p, q, project(b[j], axis));
}

} // namespace

bool is_collinear(const Corners& t) {
    for (unsigned axis = 0; axis < 3; ++axis)
        if (orientation(project(t[0], axis), project(t[1], axis), project(t[2], axis)) != 0) return false;
    return true;
}

bool triangles_meet(const PlacedTriangle& a, const PlacedTriangle& b) {
    std::size_t shared = 0, sum_a = 0, sum_b = 0;
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 3; ++j)
            if (a.vertex[i] == b.vertex[j]) {
                ++shared;
                sum_a += i;
                sum_b += j;
            }
    switch (shared) {
    case 0:
        return separate_triangles_meet(a.corner, b.corner);
    case 1:
        return meet_beside_vertex(a.corner, sum_a, b.corner, sum_b);
    case 2:
        return meet_beside_edge(a.corner, 3 - sum_a, b.corner, 3 - sum_b);
    default:
        return true;
    }
}

} // namespace hsdm
