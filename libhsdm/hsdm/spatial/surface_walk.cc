#include "hsdm/spatial/surface_walk.hh"

#include "hsdm/core/chunks.hh"
#include "hsdm/mesh/triangle_sides.hh"
#include "hsdm/point_cloud.hh"
#include "hsdm/spatial/point_triangle.hh"

#include <tbb/collaborative_call_once.h>

#include <cmath>
#include <optional>

namespace hsdm {
namespace {

constexpr int most_steps = 12; // after more steps a search is faster
// of a triangle's corner angle: the walk does not cross flatter triangles
constexpr double least_squared_sine = 1e-4;
constexpr double farthest_cells = 3; // in cells: farther triangles are searched for in the tree

std::vector<Index> twins_of(const PolygonMesh& mesh, const Triangulation& cut) {
    const std::span corners(cut.triangles.empty() ? nullptr : cut.triangles.front().data(), 3 * cut.size());
    return link_triangles(corners, {}, mesh.vertex_count()).twin;
}

} // namespace

/// A triangle in single precision, relative to the centre: corner a, the gradients of the barycentric
/// coordinates of the other two corners, the unit normal, and the triangles beyond the sides. The normal is
/// infinite if there is hardly any area.
struct alignas(64) SurfaceWalk::Step {
    std::array<float, 3> a, to_b, to_c, normal;
    std::array<Index, 3> twin;
};

struct SurfaceWalk::Tree {
    tbb::collaborative_once_flag once;
    std::optional<MeshDistance> distance;
};

SurfaceWalk::~SurfaceWalk() = default;
SurfaceWalk::SurfaceWalk(SurfaceWalk&&) noexcept = default;

SurfaceWalk::SurfaceWalk(const PolygonMesh& mesh) : SurfaceWalk(mesh, triangulate(mesh)) {}

SurfaceWalk::SurfaceWalk(const PolygonMesh& mesh, const Triangulation& cut, TriangleTree::Order order)
    : positions_(mesh.positions), triangles_(cut.triangles), tree_(std::make_unique<Tree>()) {
    make_steps(twins_of(mesh, cut));
    tree_->distance.emplace(mesh, cut, order);
}

SurfaceWalk::SurfaceWalk(const PolygonMesh& mesh, const Triangulation& cut, const FacetCells& cells)
    : positions_(mesh.positions),
      triangles_(cut.triangles),
      mesh_(&mesh),
      cells_(&cells),
      first_(cut.first),
      tree_(std::make_unique<Tree>()) {
    make_steps(twins_of(mesh, cut));
}

const MeshDistance& SurfaceWalk::tree() const {
    if (cells_) tbb::collaborative_call_once(tree_->once, [&] { tree_->distance.emplace(*mesh_); });
    return *tree_->distance;
}

bool SurfaceWalk::is_in_reach(double distance) const {
    return cells_ && distance <= farthest_cells * cells_->cell_size();
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
                const Vec3 ab = b - a, ad = d - a, normal = ab % ad;
                const double height = normal | (place - a), area = normal.sqrnorm();
                if (area > least_squared_sine * ab.sqrnorm() * ad.sqrnorm()
                    && height * height > (1 + 1e-9) * limit * area)
                    continue;
                const double squared = squared_distance(place, t);
                if (squared > limit || squared >= found.squared) continue;
                found = {t, squared};
                limit = squared;
            }
    });
    return found;
}

Index SurfaceWalk::triangle_within(const Vec3& place, double bound, Index& hint) const {
    if (hint != no_index) {
        const auto [triangle, end] = walk(place, bound, hint);
        hint = triangle;
        if (end == End::near) return triangle;
    }
    return search(place, bound, hint);
}

Index SurfaceWalk::search(const Vec3& place, double bound, Index& hint) const {
    if (!is_in_reach(bound)) return tree().triangle_within(place, bound, hint);
    const Found found = search_cells(place, bound, bound);
    if (found.triangle != no_index) hint = found.triangle;
    return found.triangle;
}

bool SurfaceWalk::leads_within(const Vec3& place, double bound, Index& hint) const {
    if (hint != no_index) {
        const auto [triangle, end] = walk(place, bound, hint);
        hint = triangle;
        if (end != End::lost) return end == End::near;
    }
    return search(place, bound, hint) != no_index;
}

double SurfaceWalk::distance(const Vec3& place, Index& hint, double enough) const {
    double most = cells_ ? farthest_cells * cells_->cell_size() : 0; // largest bound for a search in cells
    if (hint != no_index) {
        const auto [triangle, end] = walk(place, enough, hint);
        hint = triangle;
        const double there = end == End::lost ? most : std::sqrt(squared_distance(place, triangle));
        if (end == End::near) return there;
        most = std::min(most, 1.000001 * there);
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

void SurfaceWalk::make_steps(const std::vector<Index>& twin) {
    const Box box = bounds_of(positions_);
    centre_ = 0.5 * (box.lo + box.hi);
    // Bounds the error of a place and a corner, at most half the diagonal away, divided by the least sine:
    // the sideways error at a sharp corner.
    rounding_ = static_cast<float>(2 * std::numeric_limits<float>::epsilon() * box.diagonal()
                                   / std::sqrt(least_squared_sine));
    steps_ = std::make_unique_for_overwrite<Step[]>(triangles_.size());
    for_each_index(triangles_.size(), chunks::quick, [&](Index t) {
        const auto& [ia, ib, ic] = triangles_[t];
        const Vec3 &a = positions_[ia], ab = positions_[ib] - a, ac = positions_[ic] - a;
        const Vec3 normal = ab % ac;
        const double area = normal.sqrnorm();
        const bool flat = !(area > least_squared_sine * ab.sqrnorm() * ac.sqrnorm());
        const Vec3 to_b = flat ? Vec3(0, 0, 0) : (ac % normal) / area;
        const Vec3 to_c = flat ? Vec3(0, 0, 0) : (normal % ab) / area;
        const Vec3 up = flat ? Vec3(Box::inf, Box::inf, Box::inf) : normal / std::sqrt(area);
        Step& step = steps_[t];
        for (unsigned k = 0; k < 3; ++k) {
            step.a[k] = static_cast<float>(a[k] - centre_[k]);
            step.to_b[k] = static_cast<float>(to_b[k]);
            step.to_c[k] = static_cast<float>(to_c[k]);
            step.normal[k] = static_cast<float>(up[k]);
            step.twin[k] = twin[3 * t + k];
        }
    });
}

/// Walks over the side that the place is farthest beyond (the most negative barycentric coordinate) until it
/// is beyond none or would go back over the side just crossed.
SurfaceWalk::Walked SurfaceWalk::walk(const Vec3& place, double bound, Index from) const {
    const Vec3 given = place - centre_;
    const std::array<float, 3> p{static_cast<float>(given[0]), static_cast<float>(given[1]),
                                 static_cast<float>(given[2])};
    const float surely = static_cast<float>(bound) - rounding_;
    Index back = no_index; // the side by which the walk entered the triangle
    for (int count = 0; count < most_steps; ++count) {
        const Step& step = steps_[from];
        const float x = p[0] - step.a[0], y = p[1] - step.a[1], z = p[2] - step.a[2];
        const float b = x * step.to_b[0] + y * step.to_b[1] + z * step.to_b[2];
        const float c = x * step.to_c[0] + y * step.to_c[1] + z * step.to_c[2];
        const float a = 1 - b - c;
        if (std::min(a, std::min(b, c)) >= 0) {
            for (const Index side : step.twin) // where the next place is likely to be
                if (side != no_index) __builtin_prefetch(&steps_[side / 3]);
            const float height = x * step.normal[0] + y * step.normal[1] + z * step.normal[2];
            if (std::abs(height) <= surely) return {from, End::near};
            return {from, at_end(place, bound, from)};
        }
        Index k = c < a ? 0 : 1;
        if (b < std::min(a, c)) k = 2;
        const Index side = 3 * from + k, next = step.twin[k];
        if (next == no_index || side == back) return {from, at_end(place, bound, from)};
        back = next;
        from = next / 3;
    }
    return {from, End::lost};
}

SurfaceWalk::End SurfaceWalk::at_end(const Vec3& place, double bound, Index triangle) const {
    if (std::isinf(steps_[triangle].normal[0])) return End::lost;
    return squared_distance(place, triangle) <= bound * bound ? End::near : End::far;
}

double SurfaceWalk::squared_distance(const Vec3& place, Index triangle) const {
    const auto& [a, b, c] = triangles_[triangle];
    return PreparedTriangle(positions_[a], positions_[b], positions_[c]).nearest(place).squared_distance;
}

} // namespace hsdm
