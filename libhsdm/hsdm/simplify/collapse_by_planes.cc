#include "hsdm/simplify/collapse_by_planes.hh"

#include "hsdm/core/chunks.hh"
#include "hsdm/core/constants.hh"
#include "hsdm/core/parallel_sort.hh"
#include "hsdm/simplify/constants.hh"
#include "hsdm/simplify/remove_flat_vertices.hh"

#include <algorithm>
#include <optional>

namespace hsdm {
namespace {

class PlaneCollapsing {
public:
    PlaneCollapsing(CollapsingMesh mesh, std::vector<Quadric> planes, std::vector<double> tolerance)
        : mesh_(std::move(mesh)),
          planes_(std::move(planes)),
          tolerance_(std::move(tolerance)),
          moved_(mesh_.vertex_count(), 1) {
        for (Index v = 0; v < tolerance_.size(); ++v)
            if (mesh_.is_locked(v)) tolerance_[v] = 0;
    }

    CollapsedMesh run(std::vector<PlaneCollapse>& plane_collapses) {
        move_onto_planes();
        if (plane_collapses.empty())
            merge_all();
        else
            repeat(plane_collapses);
        move_onto_planes();
        plane_collapses = std::move(done_);
        for (double& tolerance : tolerance_) tolerance *= collapses::straight_share;
        remove_flat_vertices(mesh_, tolerance_);
        return mesh_.write();
    }

private:
    const Vec3& at(Index v) const { return mesh_.at(v); }

    /// Moves vertices with shared planes to where these meet, because only vertices that lie there line up
    /// with others; then undoes folds.
    void move_onto_planes() {
        std::vector<std::uint8_t> seen(mesh_.vertex_count(), 0);
        for (Index s = 0; s < mesh_.side_count(); ++s) {
            if (mesh_.is_gone(s)) continue;
            const Index v = mesh_.start(s);
            if (seen[v] || !planes_[v].has_shared() || !(tolerance_[v] > 0)) continue;
            seen[v] = 1;
            const double was = planes_[v].rms(at(v));
            if (was <= collapses::settled_share * tolerance_[v]) continue;
            const Vec3 place = planes_[v].minimum();
            if (planes_[v].rms(place) < was) mesh_.move(s, place, faces_of(v, v));
        }
        for (Index s = 0; s < mesh_.side_count(); ++s)
            if (!mesh_.is_gone(s) && mesh_.twin(s) != no_index && s < mesh_.twin(s)) unfold(s);
    }

    void unfold(Index side) {
        const Index a = mesh_.start(side), b = mesh_.end(side);
        if (planes_[a].has_shared() && planes_[b].has_shared() && tolerance_[a] > 0 && tolerance_[b] > 0)
            mesh_.unfold(side, faces_of(a, b));
    }

    /// The normals that facets round two vertices to be merged should have; empty if some of their planes are
    /// not shared.
    std::span<const Vec3> faces_of(Index a, Index b) {
        std::array<Vec3, Quadric::most_shared> of_a, of_b;
        const std::span<const Vec3> first = planes_[a].shared_normals(of_a);
        const std::span<const Vec3> second = planes_[b].shared_normals(of_b);
        faces_.clear();
        if (first.empty() || second.empty()) return faces_;
        faces_.assign(first.begin(), first.end());
        faces_.insert(faces_.end(), second.begin(), second.end());
        return faces_;
    }

    void merge_all() {
        for (const bool may_move : {false, true}) {
            may_move_ = may_move;
            is_first_ = true;
            missed_.assign(mesh_.side_count(), 0);
            sweep();
        }
    }

    /// Repeats collapses; looks for others only at vertices of those that cannot be repeated.
    void repeat(const std::vector<PlaneCollapse>& plane_collapses) {
        std::vector<std::uint8_t> refused(mesh_.vertex_count(), 0);
        for (const PlaneCollapse& m : plane_collapses)
            if (mesh_.start(m.side) != m.vertex || mesh_.end(m.side) != m.onto
                || !meet(m.vertex, m.onto, m.place) || !merge(m.side, m.place))
                refused[m.vertex] = refused[m.onto] = 1;
        may_move_ = true;
        moved_ = std::move(refused);
        missed_.assign(mesh_.side_count(), 1);
        sweep();
    }

    void sweep() {
        for (int sweep = 0; sweep < enough_rounds && merge_once() > 0; ++sweep) {
        }
    }

    /// A candidate: the start of a side merges into its end, which moves to a place.
    struct Candidate {
        double length;
        Index side;
        Vec3 place;
        bool either_way; ///< or else the end into the start, which stays where it is
    };

    /// One sweep: each vertex merges at most once, over short edges first, so that a few sweeps make large
    /// facets of even size.
    std::size_t merge_once() {
        std::vector<Candidate> candidates = find_candidates();
        parallel_sort(candidates, [](const Candidate& a, const Candidate& b) {
            return a.length != b.length ? a.length < b.length : a.side < b.side;
        });
        is_first_ = false;
        mesh_.forget_changes();
        moved_.assign(moved_.size(), 0);
        std::size_t merged = 0;
        for (const Candidate& m : candidates) {
            if (mesh_.is_gone(m.side) || moved_[mesh_.start(m.side)] || moved_[mesh_.end(m.side)]) continue;
            merged += merge(m.side, m.place)
                      || (m.either_way && merge(mesh_.twin(m.side), at(mesh_.start(m.side))));
        }
        return merged;
    }

    std::vector<Candidate> find_candidates() {
        const auto find = [&](std::size_t begin, std::size_t end, std::vector<Candidate>& part) {
            for (auto s = static_cast<Index>(begin); s < end; ++s)
                if (!mesh_.is_gone(s) && mesh_.twin(s) != no_index && s < mesh_.twin(s))
                    add_candidate(s, part);
        };
        return collected<Candidate>(mesh_.side_count(), chunks::usual, find);
    }

    /// Adds an edge if it may collapse. Edges near which nothing changed are skipped, and so are those whose
    /// planes were missed everywhere unless one of their vertices itself moved.
    void add_candidate(Index s, std::vector<Candidate>& candidates) {
        const Index a = mesh_.start(s), b = mesh_.end(s);
        if (!is_first_ && !mesh_.has_changed(a) && !mesh_.has_changed(b)) return;
        if (missed_[s] && !moved_[a] && !moved_[b]) return;
        const double length = (at(b) - at(a)).sqrnorm();
        const bool there = holds(a, b), here = holds(b, a);
        missed_[s] = 0;
        if (there || here)
            candidates.push_back({length, there ? s : mesh_.twin(s), there ? at(b) : at(a), there && here});
        else if (const std::optional<Vec3> place = may_move_ ? place_for(a, b) : std::nullopt)
            candidates.push_back({length, s, *place, false});
        else
            missed_[s] = 1;
    }

    /// Can `to`, where it is, stand for `from` about as well as `from` does itself?
    bool holds(Index from, Index to) const {
        if (!(tolerance_[from] > 0 && tolerance_[to] > 0)) return false;
        const double most = std::min(tolerance_[from], tolerance_[to]);
        const double there = planes_[from].rms(at(to));
        return there <= most && there <= planes_[from].rms(at(from)) + collapses::straight_share * most
               && planes_[to].rms(at(to)) <= most;
    }

    /// The place where the planes of both are missed least, if they are met there and it is near enough.
    std::optional<Vec3> place_for(Index a, Index b) const {
        if (!(tolerance_[a] > 0 && tolerance_[b] > 0)) return std::nullopt;
        Quadric both = planes_[a];
        both += planes_[b];
        const Vec3 place = both.minimum();
        const double reach = (at(b) - at(a)).sqrnorm();
        if ((place - at(a)).sqrnorm() > reach || (place - at(b)).sqrnorm() > reach) return std::nullopt;
        return meet(a, b, place) ? std::optional(place) : std::nullopt;
    }

    /// Does a place meet the planes of both within their tolerances?
    bool meet(Index a, Index b, const Vec3& place) const {
        const double most = std::min(tolerance_[a], tolerance_[b]);
        return most > 0 && planes_[a].rms(place) <= most && planes_[b].rms(place) <= most;
    }

    /// Merges the start of a side into its end, at a place, if the facets round them allow.
    bool merge(Index side, const Vec3& place) {
        const Index from = mesh_.start(side), to = mesh_.end(side);
        if (!mesh_.collapse(side, place, faces_of(from, to))) return false;
        done_.push_back({side, from, to, place});
        moved_[to] = 1;
        planes_[to] += planes_[from];
        tolerance_[to] = std::min(tolerance_[to], tolerance_[from]);
        return true;
    }

    CollapsingMesh mesh_;
    std::vector<Quadric> planes_;
    std::vector<double> tolerance_;
    std::vector<PlaneCollapse> done_;
    std::vector<Vec3> faces_; // result of faces_of()
    bool may_move_ = false, is_first_ = true;
    std::vector<std::uint8_t> moved_;  // per vertex, merged into in the last sweep
    std::vector<std::uint8_t> missed_; // per side, does no place meet the planes of both ends?
};

} // namespace

CollapsedMesh collapse_by_planes(CollapsingMesh mesh, std::vector<Quadric> planes,
                                 std::vector<double> tolerance, std::vector<PlaneCollapse>& plane_collapses) {
    return PlaneCollapsing(std::move(mesh), std::move(planes), std::move(tolerance)).run(plane_collapses);
}

} // namespace hsdm
