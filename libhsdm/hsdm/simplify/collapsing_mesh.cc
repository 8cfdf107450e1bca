#include "hsdm/simplify/collapsing_mesh.hh"

#include "hsdm/mesh/triangulate.hh"
#include "hsdm/simplify/constants.hh"
#include "hsdm/simplify/triangle_shape.hh"

#include <algorithm>
#include <numeric>

namespace hsdm {
namespace {

bool is_along(const Vec3& a, const Vec3& b) {
    return (a | b) > collapses::turn_cosine * a.norm() * b.norm();
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

} // namespace

CollapsingMesh::CollapsingMesh(const PolygonMesh& mesh)
    : mesh_(mesh),
      positions_(mesh.positions),
      stands_for_(mesh.vertex_count()),
      facets_(mesh.vertex_count(), 0),
      locked_(mesh.vertex_count(), 0),
      changed_(mesh.vertex_count(), 1),
      touched_(mesh.facet_count(), 0),
      flipped_(mesh.vertex_count(), 0) {
    std::iota(stands_for_.begin(), stands_for_.end(), Index{0});
    const Triangulation cut = triangulate(mesh);
    facet_ = facet_of_triangle(cut);
    corners_.reserve(3 * cut.size());
    for (const Triangle& t : cut.triangles) corners_.insert(corners_.end(), t.begin(), t.end());
    TriangleSides sides = link_triangles(corners_, {}, mesh.vertex_count());
    twin_ = std::move(sides.twin);
    border_ = std::move(sides.border);
    for (Index v : corners_) ++facets_[v];
    lock_facets();
}

/// Locks facets with a diagonal that is already an edge of other facets.
void CollapsingMesh::lock_facets() {
    for (Index s = 0; s < corners_.size(); ++s) {
        const auto ring = mesh_.facet(facet_[s / 3]);
        if (ring.size() == 3 || (twin_[s] != no_index && facet_[twin_[s] / 3] == facet_[s / 3])) continue;
        const auto start = std::find(ring.begin(), ring.end(), corners_[s]);
        if (end(s) == (start + 1 == ring.end() ? ring.front() : start[1])) continue;
        for (Index v : ring) locked_[v] = 1;
    }
}

std::vector<Index> CollapsingMesh::sides_out() const {
    std::vector<Index> out(vertex_count(), no_index);
    for (Index s = 0; s < side_count(); ++s)
        if (!is_gone(s)) out[start(s)] = s;
    return out;
}

bool CollapsingMesh::ring_of(Index side, std::vector<Index>& ring) const {
    ring.clear();
    Index s = side;
    do {
        ring.push_back(end(s));
        s = twin_[previous_side(s)];
    } while (s != no_index && s != side);
    return s == side && ring.size() == facets_[corners_[side]];
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
    if (!ring_of(side, ring_) || !ring_of(twin_[side], ring_to_)) return false;
    if (!may_collapse(ring_, ring_to_, place, faces)) return false;
    if (place != at(to)) {
        touch(twin_[side]);
        for (Index v : ring_to_) changed_[v] = 1;
    }
    touch(side);
    positions_[to] = place;
    for (Index v : ring_) changed_[v] = 1;
    stands_for_[from] = to;
    facets_[to] = facets_[to] + facets_[from] - 4;
    --facets_[ring_[1]];
    --facets_[ring_.back()];
    remove(side);
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
    const Index other = twin_[side];
    if (other == no_index) return false;
    const Index ca = previous_side(side);
    const Index a = start(side), b = start(other), c = start(ca), d = start(previous_side(other));
    if ((locked_[a] && locked_[b]) || (locked_[c] && locked_[d])) return false;
    if (!spares(a) || !spares(b) || std::max(facets_[c], facets_[d]) >= collapses::most_flipped) return false;
    if (!ring_of(ca, ring_) || std::find(ring_.begin(), ring_.end(), d) != ring_.end()) return false;
    turn_edge(side);
    return true;
}

/// Triangles a b c and b a d become c a d and d b c, each in the place of one.
void CollapsingMesh::turn_edge(Index side) {
    const Index other = twin_[side], ca = previous_side(side), db = previous_side(other);
    const Index a = start(side), b = start(other), c = start(ca), d = start(db);
    const Index beyond_ca = twin_[ca], beyond_db = twin_[db];
    const auto pair_up = [&](Index s, Index t) {
        twin_[s] = t;
        if (t != no_index) twin_[t] = s;
    };
    corners_[side] = d;
    corners_[other] = c;
    pair_up(side, beyond_db);
    pair_up(other, beyond_ca);
    pair_up(ca, db);
    touched_[facet_[side / 3]] = touched_[facet_[other / 3]] = 1;
    --facets_[a];
    --facets_[b];
    ++facets_[c];
    ++facets_[d];
    for (Index v : {a, b, c, d}) changed_[v] = flipped_[v] = 1;
}

bool CollapsingMesh::unfold(Index side, std::span<const Vec3> faces) {
    if (twin_[side] == no_index) return false;
    const Vec3 &a = at(start(side)), &b = at(end(side));
    const Vec3 &c = at(start(previous_side(side))), &d = at(start(previous_side(twin_[side])));
    const auto faces_away = [&](const Vec3& n) { return faces_along(-n, faces) && !faces_along(n, faces); };
    if (!faces_away(triangle_normal(a, b, c)) && !faces_away(triangle_normal(b, a, d))) return false;
    return faces_along(triangle_normal(c, a, d), faces) && faces_along(triangle_normal(d, b, c), faces)
           && flip(side);
}

/// Marks the facets round the start of a side as changed.
void CollapsingMesh::touch(Index side) {
    sides_.clear();
    Index s = side;
    do {
        sides_.push_back(s);
        touched_[facet_[s / 3]] = 1;
        s = twin_[previous_side(s)];
    } while (s != side);
}

/// Removes the two triangles at a side and moves the other corners of its start to its end; touch() must have
/// listed the start's fan last.
void CollapsingMesh::remove(Index side) {
    const Index other = twin_[side], to = end(side);
    for (Index out : sides_) corners_[out] = to;
    for (const Index gone : {side, other}) {
        const Index p = twin_[next_side(gone)], q = twin_[previous_side(gone)];
        twin_[p] = q;
        twin_[q] = p;
    }
    for (const Index gone : {side, other})
        for (const Index corner : {gone, next_side(gone), previous_side(gone)}) corners_[corner] = no_index;
}

CollapsedMesh CollapsingMesh::write() {
    PolygonMesh kept;
    kept.corners.reserve(corners_.size());
    kept.first.reserve(facet_.size() + 1);
    Index t = 0;
    for (std::size_t f = 0; f < mesh_.facet_count(); ++f) {
        if (!touched_[f]) kept.add_facet(mesh_.facet(f));
        for (; t < facet_.size() && facet_[t] == f; ++t)
            if (touched_[f] && !is_gone(3 * t)) kept.add_facet({&corners_[3 * t], 3});
    }
    kept.positions = std::move(positions_);
    for (Index& v : stands_for_)
        while (stands_for_[v] != v) v = stands_for_[v];
    return {std::move(kept), std::move(stands_for_), std::move(flipped_)};
}

} // namespace hsdm
