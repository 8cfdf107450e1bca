#include "hsdm/simplify/collapsing_mesh.hh"

#include "hsdm/core/constants.hh"
#include "hsdm/simplify/constants.hh"
#include "hsdm/simplify/triangle_shape.hh"

#include <algorithm>
#include <numeric>

namespace hsdm {
namespace {

bool is_along(const Vec3& a, const Vec3& b) {
    return (a | b) > angles::one_sheet * a.norm() * b.norm();
}

bool faces_along(const Vec3& normal, std::span<const Vec3> faces) {
    return std::any_of(faces.begin(), faces.end(), [&](const Vec3& n) { return is_along(normal, n); });
}

/// Does a facet turn too far? One that faced none of `faces` may turn to face one. One that faces away from
/// one (where leaves' vertices have passed each other) must not grow.
bool turns(const Vec3& before, const Vec3& after, std::span<const Vec3> faces) {
    if (faces_along(after, faces)) return faces_along(before, faces) && !is_along(before, after);
    return !is_along(before, after) || (faces_along(-after, faces) && after.sqrnorm() > before.sqrnorm());
}

std::vector<Index> corners_of(const Triangulation& cut) {
    std::vector<Index> corners;
    corners.reserve(3 * cut.size());
    for (const Triangle& t : cut.triangles) corners.insert(corners.end(), t.begin(), t.end());
    return corners;
}

} // namespace

CollapsingMesh::CollapsingMesh(const PolygonMesh& mesh) : CollapsingMesh(mesh, triangulate(mesh)) {}

CollapsingMesh::CollapsingMesh(const PolygonMesh& mesh, const Triangulation& cut)
    : EditableTriangles(corners_of(cut), {}, mesh.vertex_count()),
      mesh_(mesh),
      positions_(mesh.positions),
      stands_for_(mesh.vertex_count()),
      facet_(facet_of_triangle(cut)),
      locked_(mesh.vertex_count(), 0),
      changed_(mesh.vertex_count(), 1),
      touched_(mesh.facet_count(), 0),
      flipped_(mesh.vertex_count(), 0) {
    std::iota(stands_for_.begin(), stands_for_.end(), Index{0});
    lock_facets();
}

/// Locks facets with a diagonal that is already an edge of other facets.
void CollapsingMesh::lock_facets() {
    for (Index s = 0; s < side_count(); ++s) {
        const auto ring = mesh_.facet(facet_[s / 3]);
        if (ring.size() == 3 || (twin(s) != no_index && facet_[twin(s) / 3] == facet_[s / 3])) continue;
        const auto at = std::find(ring.begin(), ring.end(), start(s));
        if (end(s) == (at + 1 == ring.end() ? ring.front() : at[1])) continue;
        for (Index v : ring) locked_[v] = 1;
    }
}

std::vector<Index> CollapsingMesh::sides_out() const {
    std::vector<Index> out(vertex_count(), no_index);
    for (Index s = 0; s < side_count(); ++s)
        if (!is_gone(s)) out[start(s)] = s;
    return out;
}

bool CollapsingMesh::may_collapse(const std::vector<Index>& ring, const std::vector<Index>& ring_to,
                                  const Vec3& place, std::span<const Vec3> faces) const {
    if (!is_link(ring, ring_to)) return false;
    double thinnest = collapses::least_shape, thinnest_new = 1;
    const Index to = ring[0];
    return suits_ring(place, ring, ring_to[0], faces, thinnest, thinnest_new)
           && (place == at(to) || suits_ring(place, ring_to, to, faces, thinnest, thinnest_new))
           && thinnest_new >= thinnest;
}

/// The link condition: the ends share no neighbour but the two beside the edge, and those two keep three
/// facets (one at a border).
bool CollapsingMesh::is_link(const std::vector<Index>& from, const std::vector<Index>& to) const {
    if (std::min(from.size(), to.size()) < 3 || from.size() + to.size() < 7) return false;
    if (from.size() + to.size() > collapses::most_facets + 4) return false;
    for (std::size_t i = 2; i + 1 < from.size(); ++i)
        if (std::find(to.begin(), to.end(), from[i]) != to.end()) return false;
    return spares(from[1]) && spares(from.back());
}

/// Checks the facets of a ring that remain when its centre moves to a place: none may turn. Lowers `thinnest`
/// to the worst shape before and `thinnest_new` to the worst after.
bool CollapsingMesh::suits_ring(const Vec3& place, const std::vector<Index>& ring, Index centre,
                                std::span<const Vec3> faces, double& thinnest, double& thinnest_new) const {
    for (std::size_t i = 0; i < ring.size(); ++i)
        thinnest =
            std::min(thinnest, triangle_shape(at(centre), at(ring[i]), at(ring[(i + 1) % ring.size()])));
    for (std::size_t i = 1; i + 1 < ring.size(); ++i) {
        const Vec3 &p = at(ring[i]), &q = at(ring[i + 1]);
        // A vertex amid three others may go even if two of these and the place are on a line: the next
        // collapse along that line removes the needle.
        if (ring.size() == 3 && !faces.empty() && triangle_shape(place, p, q) < collapses::least_shape)
            continue;
        const Vec3 before = triangle_normal(at(centre), p, q), after = triangle_normal(place, p, q);
        if (turns(before, after, faces)) return false;
        thinnest_new = std::min(thinnest_new, triangle_shape(place, p, q));
    }
    return true;
}

bool CollapsingMesh::collapse(Index side, const Vec3& place, std::span<const Vec3> faces) {
    const Index from = start(side), to = end(side);
    if (!ring_of(side, ring_) || !ring_of(twin(side), ring_to_)) return false;
    if (!may_collapse(ring_, ring_to_, place, faces)) return false;
    if (place != at(to)) {
        touch(twin(side));
        for (Index v : ring_to_) changed_[v] = 1;
    }
    touch(side);
    positions_[to] = place;
    for (Index v : ring_) changed_[v] = 1;
    stands_for_[from] = to;
    collapse_edge(side);
    return true;
}

bool CollapsingMesh::move(Index side, const Vec3& place, std::span<const Vec3> faces) {
    const Index v = start(side);
    if (locked_[v] || !ring_of(side, ring_)) return false;
    double thinnest = collapses::least_shape;
    for (std::size_t i = 0; i < ring_.size(); ++i) {
        if ((place - at(v)).sqrnorm() >= (at(ring_[i]) - at(v)).sqrnorm()) return false;
        thinnest = std::min(thinnest, triangle_shape(at(v), at(ring_[i]), at(ring_[(i + 1) % ring_.size()])));
    }
    for (std::size_t i = 0; i < ring_.size(); ++i) {
        const Vec3 &p = at(ring_[i]), &q = at(ring_[(i + 1) % ring_.size()]);
        const Vec3 before = triangle_normal(at(v), p, q), after = triangle_normal(place, p, q);
        if (turns(before, after, faces)) return false;
        if (triangle_shape(place, p, q) < thinnest) return false;
    }
    touch(side);
    positions_[v] = place;
    changed_[v] = 1;
    for (Index w : ring_) changed_[w] = 1;
    return true;
}

bool CollapsingMesh::flip(Index side) {
    if (twin(side) == no_index) return false;
    const Index a = start(side), b = end(side), c = opposite(side), d = opposite(twin(side));
    if ((locked_[a] && locked_[b]) || (locked_[c] && locked_[d])) return false;
    if (!spares(a) || !spares(b)) return false;
    if (std::max(facet_count(c), facet_count(d)) >= bounds::most_squared) return false;
    if (!ring_of(previous_side(side), ring_)) return false;
    if (std::find(ring_.begin(), ring_.end(), d) != ring_.end()) return false;
    lay(side);
    return true;
}

void CollapsingMesh::lay(Index side) {
    const Index other = twin(side);
    touched_[facet_[side / 3]] = touched_[facet_[other / 3]] = 1;
    for (Index v : {start(side), start(other), opposite(side), opposite(other)})
        changed_[v] = flipped_[v] = 1;
    flip_edge(side);
}

bool CollapsingMesh::unfold(Index side, std::span<const Vec3> faces) {
    if (twin(side) == no_index) return false;
    const Vec3 &a = at(start(side)), &b = at(end(side));
    const Vec3 &c = at(opposite(side)), &d = at(opposite(twin(side)));
    const auto faces_away = [&](const Vec3& n) { return faces_along(-n, faces) && !faces_along(n, faces); };
    if (!faces_away(triangle_normal(a, b, c)) && !faces_away(triangle_normal(b, a, d))) return false;
    return faces_along(triangle_normal(c, a, d), faces) && faces_along(triangle_normal(d, b, c), faces)
           && flip(side);
}

/// Marks the facets round the start of a side as changed.
void CollapsingMesh::touch(Index side) {
    Index s = side;
    do {
        touched_[facet_[s / 3]] = 1;
        s = twin(previous_side(s));
    } while (s != side);
}

CollapsedMesh CollapsingMesh::write() {
    PolygonMesh kept;
    kept.corners.reserve(side_count());
    kept.first.reserve(facet_.size() + 1);
    Index t = 0;
    for (std::size_t f = 0; f < mesh_.facet_count(); ++f) {
        if (!touched_[f]) kept.add_facet(mesh_.facet(f));
        for (; t < facet_.size() && facet_[t] == f; ++t)
            if (touched_[f] && !is_gone(3 * t)) kept.add_facet(triangle(t));
    }
    kept.positions = std::move(positions_);
    kept.origin = mesh_.origin;
    for (Index& v : stands_for_)
        while (stands_for_[v] != v) v = stands_for_[v];
    return {std::move(kept), std::move(stands_for_), std::move(flipped_)};
}

} // namespace hsdm
