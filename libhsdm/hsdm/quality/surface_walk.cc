#include "hsdm/quality/surface_walk.hh"

#include "hsdm/facets/triangle_sides.hh"
#include "hsdm/quality/point_triangle.hh"

#include <tbb/collaborative_call_once.h>

#include <cmath>
#include <optional>

namespace hsdm {
namespace {

constexpr int most_steps = 12;              // by then a search is quicker
constexpr double least_squared_sine = 1e-8; // of a triangle's corner: flatter ones are not walked over
constexpr double farthest = 3;              // cells: what is farther is left to the tree

std::vector<Index> twins_of(const PolygonMesh& mesh, const Triangulation& cut) {
    const std::span corners(cut.triangles.empty() ? nullptr : cut.triangles.front().data(), 3 * cut.size());
    return link_triangles(corners, {}, mesh.vertex_count()).twin;
}

} // namespace

struct SurfaceWalk::Tree {
    tbb::collaborative_once_flag once;
    std::optional<MeshDistance> distance;
};

SurfaceWalk::~SurfaceWalk() = default;
SurfaceWalk::SurfaceWalk(SurfaceWalk&&) noexcept = default;

SurfaceWalk::SurfaceWalk(const PolygonMesh& mesh) : SurfaceWalk(mesh, triangulate(mesh)) {}

SurfaceWalk::SurfaceWalk(const PolygonMesh& mesh, const Triangulation& cut, TriangleTree::Order order)
    : positions_(mesh.positions),
      triangles_(cut.triangles),
      twin_(twins_of(mesh, cut)),
      tree_(std::make_unique<Tree>()) {
    tree_->distance.emplace(mesh, cut, order);
}

SurfaceWalk::SurfaceWalk(const PolygonMesh& mesh, const Triangulation& cut, const FacetCells& cells)
    : positions_(mesh.positions),
      triangles_(cut.triangles),
      twin_(twins_of(mesh, cut)),
      mesh_(&mesh),
      cells_(&cells),
      first_(cut.first),
      tree_(std::make_unique<Tree>()) {}

const MeshDistance& SurfaceWalk::tree() const {
    if (cells_) tbb::collaborative_call_once(tree_->once, [&] { tree_->distance.emplace(*mesh_); });
    return *tree_->distance;
}

bool SurfaceWalk::is_in_reach(double distance) const {
    return cells_ && distance <= farthest * cells_->cell_size();
}

/// The nearest triangle that is no farther than `reach`, or any that is no farther than `enough`.
SurfaceWalk::Found SurfaceWalk::search_cells(const Vec3& place, double reach, double enough) const {
    const double wider = reach + 2 * FacetCells::rounding * cells_->cell_size();
    const Vec3 step(wider, wider, wider);
    const CellRange range{FacetCells::cell_of(cells_->place(place - step)),
                          FacetCells::cell_of(cells_->place(place + step))};
    Found found;
    double limit = reach * reach;
    range.for_each([&](const VoxelCoord& c) {
        const Index cell = found.squared <= enough * enough ? no_index : cells_->find(c);
        if (cell == no_index) return;
        for (Index f : cells_->facets(cell))
            for (Index t = first_[f]; t < first_[f + 1]; ++t) {
                const auto& [ia, ib, ic] = triangles_[t];
                const Vec3 &a = positions_[ia], &b = positions_[ib], &d = positions_[ic];
                const Vec3 normal = (b - a) % (d - a);
                const double height = normal | (place - a);
                if (height * height > (1 + 1e-9) * limit * normal.sqrnorm()) continue;
                const double squared = PreparedTriangle(a, b, d).nearest(place).squared_distance;
                if (squared > limit || squared >= found.squared) continue;
                found = {t, squared};
                limit = squared;
            }
    });
    return found;
}

Index SurfaceWalk::triangle_within(const Vec3& place, double bound, Index& hint) const {
    if (hint != no_index) {
        const auto [triangle, end, squared] = walk(place, bound * bound, hint);
        hint = triangle;
        if (end == End::near) return triangle;
    }
    if (!is_in_reach(bound)) return tree().triangle_within(place, bound, hint);
    const Found found = search_cells(place, bound, bound);
    if (found.triangle != no_index) hint = found.triangle;
    return found.triangle;
}

bool SurfaceWalk::leads_within(const Vec3& place, double bound, Index& hint) const {
    if (hint != no_index) {
        const auto [triangle, end, squared] = walk(place, bound * bound, hint);
        hint = triangle;
        if (end != End::lost) return end == End::near;
    }
    return triangle_within(place, bound, hint) != no_index;
}

double SurfaceWalk::distance(const Vec3& place, Index& hint, double enough) const {
    double most = cells_ ? farthest * cells_->cell_size() : 0; // is worth a search
    if (hint != no_index) {
        const auto [triangle, end, squared] = walk(place, enough * enough, hint);
        hint = triangle;
        if (end == End::near) return std::sqrt(squared);
        if (end == End::far) most = std::min(most, 1.000001 * std::sqrt(squared));
    }
    for (double tried = 0; tried < most;) {
        tried = std::min(most, std::max(2 * tried, 0.5 * cells_->cell_size()));
        const Found found = search_cells(place, tried, enough);
        if (found.triangle == no_index) continue;
        hint = found.triangle;
        return std::sqrt(found.squared);
    }
    return tree()(place, hint);
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
