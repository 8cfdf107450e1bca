#include "hsdm/simplify/remesh_by_flips.hh"

#include "hsdm/core/chunks.hh"
#include "hsdm/core/constants.hh"
#include "hsdm/core/disjoint_sets.hh"
#include "hsdm/core/groups.hh"
#include "hsdm/core/parallel_sort.hh"
#include "hsdm/mesh/constants.hh"
#include "hsdm/mesh/editable_triangles.hh"
#include "hsdm/mesh/facet_normal.hh"
#include "hsdm/mesh/straight_corners.hh"
#include "hsdm/simplify/constants.hh"
#include "hsdm/simplify/triangle_shape.hh"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

namespace hsdm {
namespace {

class FlipRemeshing {
public:
    FlipRemeshing(PolygonMesh& mesh, const ToleranceEnvelope& fine, std::span<const std::uint8_t> fixed,
                  RemeshedGroups& before)
        : mesh_(mesh),
          fine_(fine),
          before_(before),
          tolerance_(fine.tolerance),
          same_(find_unchanged(before.mesh, mesh)) {
        std::vector<std::uint8_t> whole(mesh.facet_count());
        for (std::size_t f = 0; f < whole.size(); ++f) {
            const auto ring = mesh.facet(f);
            whole[f] =
                ring.size() > 4 || std::all_of(ring.begin(), ring.end(), [&](Index v) { return fixed[v]; });
        }
        group_ = before_.find(mesh, same_, whole);
        cut_what_is_new(whole);
        if (is_sound() || kept_.facet_count() == 0) return;
        group_.assign(group_.size(), no_index);
        cut_what_is_new(std::move(whole));
    }

    RemeshCounts run(Diagonals diagonals) {
        RemeshCounts counts;
        const int sweeps = diagonals == Diagonals::may_flip ? flips::most_sweeps : 0;
        look_.assign(side_count(), Look::none);
        united_.emplace(half_.size());
        std::vector<std::uint8_t> turned(half_.size(), 1);
        for (int sweep = 0; sweep < sweeps; ++sweep) {
            turned_.assign(half_.size(), 0);
            judge_all(turned);
            std::size_t flipped = 0;
            for (Index s = 0; s < side_count(); ++s)
                if (waits_[s / 3] && is_due(s, turned)) flipped += flip(s);
            counts.flipped += flipped;
            turned.swap(turned_);
            if (flipped == 0) break;
        }
        counts.joined = join();
        before_ = std::move(now_);
        before_.mesh.positions = mesh_.positions;
        before_.mesh.origin = mesh_.origin;
        before_.mesh.corners = std::exchange(mesh_.corners, std::move(kept_.corners));
        before_.mesh.first = std::exchange(mesh_.first, std::move(kept_.first));
        return counts;
    }

private:
    const Vec3& at(Index v) const { return mesh_.positions[v]; }

    Index start(Index side) const { return edges_->start(side); }
    Index end(Index side) const { return edges_->end(side); }
    Index opposite(Index side) const { return edges_->opposite(side); }
    Index twin(Index side) const { return edges_->twin(side); }
    Index side_count() const { return static_cast<Index>(3 * half_.size()); }

    Vec3 middle(Index a, Index b) const { return 0.5 * (at(a) + at(b)); }

    /// How far a quad with the diagonals a-b and c-d is off a plane.
    double warp(Index a, Index b, Index c, Index d) const {
        return line_distance(at(a), at(b), at(c), at(d));
    }

    /// Is the middle of an edge on the fine surface? `none`: not looked up yet.
    enum class Look : std::uint8_t { none, on, off };
    Look look(Index a, Index b, Index& hint) const {
        return fine_.holds(middle(a, b), hint) ? Look::on : Look::off;
    }

    void cut_what_is_new(std::vector<std::uint8_t> whole) {
        // A quad whose diagonal is an edge of other facets already must stay whole; try again without.
        do cut_all(whole);
        while (keep_whole(whole));
    }

    /// Do the results of groups taken over fit together? One made beside other facets may rely on an edge
    /// that another group has since flipped away, or on a facet that another gave to a vertex.
    bool is_sound() const {
        if (edges_->is_crowded()) return false;
        for (Index v = 0; v < mesh_.vertex_count(); ++v)
            if (const Index count = edges_->facet_count(v); count > 0 && count < edges_->least_facets(v))
                return false;
        return true;
    }

    void cut_all(const std::vector<std::uint8_t>& whole) {
        kept_ = {};
        now_ = {};
        half_.clear();
        facet_.clear();
        std::vector<std::uint8_t> seen(before_.size(), 0);
        for (std::size_t f = 0; f < whole.size(); ++f) {
            const auto ring = mesh_.facet(f);
            if (whole[f]) {
                kept_.add_facet(ring);
                continue;
            }
            if (const Index group = group_[f]; group != no_index) {
                if (seen[group]) continue;
                seen[group] = 1;
                now_.copy(before_, group, same_);
                now_.append_last(kept_);
                continue;
            }
            facet_.resize(facet_.size() + ring.size() - 2, static_cast<Index>(f));
            half_.resize(facet_.size(), ring.size() == 4);
        }
        std::vector<Index> corners(3 * facet_.size());
        for_chunks(facet_.size(), chunks::slow, [&](std::size_t begin, std::size_t end, std::size_t) {
            for (std::size_t t = begin; t < end; ++t)
                if (t == 0 || facet_[t - 1] != facet_[t]) cut(mesh_.facet(facet_[t]), &corners[3 * t]);
        });
        edges_.emplace(std::move(corners), kept_, mesh_.vertex_count());
    }

    /// Marks quads whose diagonal is also an edge of other facets; false if there is none.
    bool keep_whole(std::vector<std::uint8_t>& whole) const {
        bool any = false;
        for (Index s = 0; s < side_count(); s += 3) {
            if (!half_[s / 3] || (twin(s) != no_index && facet_[twin(s) / 3] == facet_[s / 3])) continue;
            whole[facet_[s / 3]] = 1;
            any = true;
        }
        return any;
    }

    /// Writes the three corners of a triangle, or the six of a quad's halves, with the diagonal as side 0 of
    /// each.
    void cut(std::span<const Index> f, Index* out) const {
        if (f.size() == 3) {
            std::copy(f.begin(), f.end(), out);
            return;
        }
        const double shape02 = std::min(triangle_shape(at(f[0]), at(f[1]), at(f[2])),
                                        triangle_shape(at(f[0]), at(f[2]), at(f[3])));
        const double shape13 = std::min(triangle_shape(at(f[0]), at(f[1]), at(f[3])),
                                        triangle_shape(at(f[1]), at(f[2]), at(f[3])));
        const std::array<Index, 6> halves = shape02 >= shape13
                                                ? std::array{f[2], f[0], f[1], f[0], f[2], f[3]}
                                                : std::array{f[1], f[3], f[0], f[3], f[1], f[2]};
        std::copy(halves.begin(), halves.end(), out);
    }

    /// Is it certain that two vertices share no edge? Looks at the fan of the first, at this corner, which
    /// must be closed.
    bool apart(Index corner, Index other) const {
        Index s = corner;
        do {
            if (end(s) == other || opposite(s) == other) return false;
            s = twin(s) == no_index ? no_index : next_side(twin(s));
        } while (s != no_index && s != corner);
        return s == corner;
    }

    /// What two triangles alone say about flipping the diagonal between them.
    struct Verdict {
        bool flips = false;       ///< is the other diagonal better?
        Look before = Look::none; ///< of this diagonal
        Look after = Look::none;  ///< of the other diagonal
    };

    /// Is this the half-edge by which its edge is judged, and has one of its triangles changed?
    bool is_due(Index s, const std::vector<std::uint8_t>& turned) const {
        return twin(s) != no_index && s < twin(s) && (turned[s / 3] || turned[twin(s) / 3]);
    }

    void judge_all(const std::vector<std::uint8_t>& turned) {
        verdicts_.resize(side_count());
        waits_.assign(half_.size(), 0);
        for_chunks(side_count(), 3 * chunks::slow, [&](std::size_t begin, std::size_t end, std::size_t) {
            Index hint = no_index;
            for (auto s = static_cast<Index>(begin); s < end; ++s) {
                if (!is_due(s, turned)) continue;
                verdicts_[s] = judge(s, hint);
                look_[s] = look_[twin(s)] = verdicts_[s].before;
                waits_[s / 3] |= verdicts_[s].flips;
            }
        });
    }

    Verdict judge(Index s, Index& hint) const {
        const Index t = twin(s), a = start(s), b = start(t), c = opposite(s), d = opposite(t);
        const Look before = look_[s];
        const Vec3 ab = at(b) - at(a), bc = at(c) - at(b), ca = at(a) - at(c), ad = at(d) - at(a),
                   db = at(b) - at(d), cd = at(d) - at(c);
        const Vec3 first = ca % cd, second = cd % db, sum = first + second;
        if ((first | sum) <= 0 || (second | sum) <= 0) return {false, before, Look::none};
        const Vec3 old1 = ca % ab, old2 = ab % db;
        const double first_norm = first.norm(), second_norm = second.norm(), old1_norm = old1.norm(),
                     old2_norm = old2.norm();
        const double ab2 = ab.sqrnorm(), bc2 = bc.sqrnorm(), ca2 = ca.sqrnorm(), ad2 = ad.sqrnorm(),
                     db2 = db.sqrnorm(), cd2 = cd.sqrnorm();
        const double old_shape =
            std::min(triangle_shape(old1_norm, ab2 + bc2 + ca2), triangle_shape(old2_norm, ab2 + ad2 + db2));
        const double new_shape = std::min(triangle_shape(first_norm, ca2 + ad2 + cd2),
                                          triangle_shape(second_norm, db2 + bc2 + cd2));
        if (new_shape < std::min(collapses::least_shape, old_shape)) return {false, before, Look::none};
        const bool gains = new_shape >= flips::better_shape * old_shape
                           && (first | second) >= angles::smooth * first_norm * second_norm
                           && (old_shape <= collapses::least_shape
                               || (old1 | old2) >= angles::smooth * old1_norm * old2_norm);
        if (warp(a, b, c, d) <= tolerance_) return {gains, before, before};
        return judge_bent({a, b, c, d}, before, gains, hint);
    }

    /// The verdict on edge a-b where the corners a, b and the opposite ones, c and d, are not in a plane.
    /// `gains`: would the flip improve the shape?
    Verdict judge_bent(const std::array<Index, 4>& corners, Look before, bool gains, Index& hint) const {
        const auto [a, b, c, d] = corners;
        if (before == Look::none) before = look(a, b, hint);
        if (before == Look::off) {
            const double was = fine_.surface.distance(middle(a, b), hint);
            const auto is_beyond = [&](const Vec3& place, double share) {
                return fine_.surface.is_beyond(place, share * was, hint);
            };
            return {!is_beyond(middle(c, d), flips::nearer_share)
                        && !is_beyond((at(a) + at(c) + at(d)) / 3, 1)
                        && !is_beyond((at(b) + at(c) + at(d)) / 3, 1),
                    before, Look::none};
        }
        if (!gains) return {false, before, Look::none};
        const Look after = look(c, d, hint);
        return {after == Look::on, before, after};
    }

    /// Flips the diagonal at side s if the verdict, judged again if a triangle has changed, says so and the
    /// topology allows it.
    bool flip(Index s) {
        const Index t = twin(s), c = opposite(s), d = opposite(t);
        if (c == d || !edges_->spares(start(s)) || !edges_->spares(start(t))) return false;
        const bool stale = turned_[s / 3] || turned_[t / 3];
        const Verdict verdict = stale ? judge(s, hint_) : verdicts_[s];
        look_[s] = look_[t] = verdict.before;
        if (!verdict.flips || (!apart(previous_side(s), d) && !apart(previous_side(t), c))) return false;
        turn(s, t, verdict.after);
        return true;
    }

    void turn(Index s, Index t, Look now) {
        turned_[s / 3] = turned_[t / 3] = 1;
        half_[s / 3] = half_[t / 3] = 0;
        united_->join(s / 3, t / 3);
        edges_->flip_edge(s);
        look_[s] = look_[previous_side(t)];
        look_[t] = look_[previous_side(s)];
        look_[previous_side(s)] = look_[previous_side(t)] = now;
        waits_[s / 3] = waits_[t / 3] = 1;
        for (const Index side : {s, t, next_side(s), next_side(t)})
            if (twin(side) != no_index) waits_[twin(side) / 3] = 1;
    }

    struct Quad {
        double score;
        Index side;
    };

    std::optional<Quad> quad_across(Index s) const {
        const Index t = twin(s), a = start(s), b = start(t), c = opposite(s), d = opposite(t);
        const Vec3 one = triangle_normal(at(a), at(b), at(c)), two = triangle_normal(at(b), at(a), at(d));
        if (c == d || (one | two) < angles::one_sheet * one.norm() * two.norm()) return std::nullopt;
        const std::array<Vec3, 4> along{at(d) - at(a), at(b) - at(d), at(c) - at(b), at(a) - at(c)};
        std::array<double, 4> length;
        for (std::size_t i = 0; i < 4; ++i) length[i] = along[i].norm();
        const Vec3 up = (one + two).normalized();
        double least = 1;
        for (std::size_t i = 0, before = 3; i < 4; before = i++) {
            const double sine = ((along[before] % along[i]) | up) / (length[before] * length[i]);
            if (!(sine >= quad_splitting::least_corner)) return std::nullopt; // NaN where corners coincide
            least = std::min(least, sine);
        }
        // triangulate() cuts a quad along its shorter diagonal: that must be this one, or be no farther off a
        // plane than the tolerance.
        const bool shorter = (at(b) - at(a)).sqrnorm() <= (at(d) - at(c)).sqrnorm();
        if (!shorter && warp(a, b, c, d) > tolerance_) return std::nullopt;
        const bool whole = half_[s / 3] && half_[t / 3] && s % 3 == 0 && t % 3 == 0;
        return Quad{least + (whole ? flips::was_quad : 0), s};
    }

    std::vector<Quad> possible_quads() const {
        const auto find = [&](std::size_t begin, std::size_t end, std::vector<Quad>& part) {
            for (auto s = static_cast<Index>(begin); s < end; ++s)
                if (twin(s) != no_index && s < twin(s))
                    if (const auto quad = quad_across(s)) part.push_back(*quad);
        };
        return collected<Quad>(side_count(), 3 * chunks::slow, find);
    }

    std::size_t join() {
        std::vector<Quad> quads = possible_quads();
        parallel_sort(quads, [](const Quad& p, const Quad& q) {
            return p.score != q.score ? p.score > q.score : p.side < q.side;
        });
        // per triangle, the side across which it is joined, or no_index
        std::vector<Index> partner(half_.size(), no_index);
        std::size_t joined = 0;
        for (const Quad& quad : quads) {
            const Index s = quad.side, t = twin(s);
            if (partner[s / 3] != no_index || partner[t / 3] != no_index) continue;
            if (!edges_->spares(start(s)) || !edges_->spares(start(t))) continue;
            edges_->count_as_one(s);
            partner[s / 3] = s;
            partner[t / 3] = t;
            united_->join(s / 3, t / 3);
            ++joined;
        }
        add_groups(partner);
        return joined;
    }

    /// Writes the remaining triangles and the quads, group by group.
    void add_groups(const std::vector<Index>& partner) {
        const auto [number, count] = number_groups();
        const Groups groups(number, count);
        std::vector<Index> facets;
        for (std::size_t g = 0; g < count; ++g) {
            const auto group = groups.of(g);
            facets.clear();
            for (Index t : group)
                if (t == 0 || facet_[t - 1] != facet_[t]) facets.push_back(facet_[t]);
            now_.begin(facets);
            for (Index t : group) {
                const Index s = partner[t];
                if (s == no_index)
                    now_.add_ring(edges_->triangle(t));
                else if (s < twin(s))
                    now_.add_ring(std::array{start(s), opposite(twin(s)), end(s), opposite(s)});
            }
            now_.append_last(kept_);
        }
    }

    /// Per triangle the group of those connected by flips or joins, halves of one quad among them; and how
    /// many there are.
    std::pair<std::vector<Index>, Index> number_groups() {
        std::vector<Index> number(half_.size());
        Index count = 0;
        for (Index t = 1; t < number.size(); ++t)
            if (facet_[t - 1] == facet_[t]) united_->join(t - 1, t);
        for (Index t = 0; t < number.size(); ++t) { // the least member represents its group
            const Index least = united_->find(t);
            number[t] = least == t ? count++ : number[least];
        }
        return {std::move(number), count};
    }

    PolygonMesh& mesh_;
    const ToleranceEnvelope& fine_;
    RemeshedGroups& before_;
    RemeshedGroups now_;
    double tolerance_;
    Unchanged same_;           // of the mesh of `before`
    std::vector<Index> group_; // per facet, its group in `before`, whose result it takes over, or no_index
    std::optional<DisjointSets> united_; // triangles connected by flips or joins
    PolygonMesh kept_;                   // facets of the result
    std::optional<EditableTriangles> edges_;
    std::vector<std::uint8_t> half_;   // per triangle, is it half of a former quad, the diagonal its side 0?
    std::vector<Index> facet_;         // per triangle, the facet it was cut from
    std::vector<Look> look_;           // per side
    std::vector<Verdict> verdicts_;    // per side, as of the start of the sweep
    std::vector<std::uint8_t> turned_; // per triangle, was it flipped in this sweep?
    std::vector<std::uint8_t> waits_;  // per triangle, has it sides to flip or to judge again?
    Index hint_ = no_index;
};

} // namespace

RemeshCounts remesh_by_flips(PolygonMesh& mesh, const ToleranceEnvelope& fine,
                             std::span<const std::uint8_t> fixed, Diagonals diagonals) {
    RemeshedGroups none;
    return remesh_by_flips(mesh, fine, fixed, diagonals, none);
}

RemeshCounts remesh_by_flips(PolygonMesh& mesh, const ToleranceEnvelope& fine,
                             std::span<const std::uint8_t> fixed, Diagonals diagonals,
                             RemeshedGroups& before) {
    const RemeshCounts counts = FlipRemeshing(mesh, fine, fixed, before).run(diagonals);
    cut_straight_corners(mesh, flips::reflex);
    return counts;
}

} // namespace hsdm
