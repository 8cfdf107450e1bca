#include "hsdm/quality/surface_walk.hh"

#include "hsdm/facets/triangle_sides.hh"

namespace hsdm {
namespace {

constexpr int most_steps = 12;              // by then the tree is quicker
constexpr double least_squared_sine = 1e-8; // of a triangle's corner: flatter ones are left to the tree

std::vector<Index> twins_of(const PolygonMesh& mesh, const Triangulation& cut) {
    const std::span corners(cut.triangles.empty() ? nullptr : cut.triangles.front().data(), 3 * cut.size());
    return link_triangles(corners, {}, mesh.vertex_count()).twin;
}

} // namespace

SurfaceWalk::SurfaceWalk(const PolygonMesh& mesh) : SurfaceWalk(mesh, triangulate(mesh)) {}

SurfaceWalk::SurfaceWalk(const PolygonMesh& mesh, const Triangulation& cut, TriangleTree::Order order)
    : positions_(mesh.positions),
      triangles_(cut.triangles),
      twin_(twins_of(mesh, cut)),
      distance_(mesh, cut, order) {}

Index SurfaceWalk::triangle_within(const Vec3& place, double bound, Index& hint) const {
    if (hint != no_index) {
        const auto [triangle, end, squared] = walk(place, bound * bound, hint);
        hint = triangle;
        if (end == End::near) return triangle;
    }
    return distance_.triangle_within(place, bound, hint);
}

bool SurfaceWalk::leads_within(const Vec3& place, double bound, Index& hint) const {
    if (hint != no_index) {
        const auto [triangle, end, squared] = walk(place, bound * bound, hint);
        hint = triangle;
        if (end != End::lost) return end == End::near;
    }
    return distance_.triangle_within(place, bound, hint) != no_index;
}

double SurfaceWalk::distance_enough(const Vec3& place, double enough, Index& hint) const {
    if (hint != no_index) {
        const auto [triangle, end, squared] = walk(place, enough * enough, hint);
        hint = triangle;
        if (end == End::near) return std::sqrt(squared);
    }
    return distance_(place, hint);
}

/// Over the side that the place is farthest beyond, by shares of the corner across, until it is beyond none,
/// or back again beyond the last.
SurfaceWalk::Walked SurfaceWalk::walk(const Vec3& place, double squared_bound, Index from) const {
    Index back = no_index; // the side of the triangle that leads where it was come from
    for (int step = 0; step < most_steps; ++step) {
        const auto& [ia, ib, ic] = triangles_[from];
        const Vec3& a = positions_[ia];
        const Vec3 ab = positions_[ib] - a, ac = positions_[ic] - a, arm = place - a;
        const double bb = ab | ab, cc = ac | ac, bc = ab | ac, pb = arm | ab, pc = arm | ac;
        // The foot on the plane, in shares of the sides from a and of the third, times `area`.
        const double area = bb * cc - bc * bc;
        if (!(area > least_squared_sine * bb * cc)) return {from, End::lost, 0};
        const double to_b = cc * pb - bc * pc, to_c = bb * pc - bc * pb, to_a = area - to_b - to_c;
        if (to_a >= 0 && to_b >= 0 && to_c >= 0) {
            const double height = (ab % ac) | arm, squared = height * height / area;
            return {from, squared <= squared_bound ? End::near : End::far, squared};
        }
        Index k = to_c < to_a ? 0 : 1;
        if (to_b < std::min(to_a, to_c)) k = 2;
        const Index side = 3 * from + k, next = twin_[side];
        if (next == no_index || side == back) {
            const Vec3 start = k == 0 ? arm : k == 1 ? arm - ab : arm - ac;
            const Vec3 along = k == 0 ? ab : k == 1 ? ac - ab : -ac;
            const double share = std::clamp((start | along) / along.sqrnorm(), 0.0, 1.0);
            const double squared = (start - along * share).sqrnorm();
            return {from, squared <= squared_bound ? End::near : End::far, squared};
        }
        back = next;
        from = next / 3;
    }
    return {from, End::lost, 0};
}

} // namespace hsdm
