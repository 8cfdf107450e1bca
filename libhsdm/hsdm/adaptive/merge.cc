#include "hsdm/adaptive/merge.hh"

#include "hsdm/adaptive/triangle_shape.hh"
#include "hsdm/adaptive/triangle_sides.hh"
#include "hsdm/chunks.hh"
#include "hsdm/facets/triangulate.hh"

#include <tbb/parallel_sort.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

namespace hsdm {
namespace {

constexpr int most_sweeps = 32; // each leaves two thirds at most of what can merge
constexpr std::size_t sides_per_chunk = 2048;
constexpr std::size_t most_facets = 24; // of a vertex: bounds the work
constexpr double free_share = 0.1;      // of the tolerance: "about as well"
constexpr double turn_cosine = 0.77;    // normals turn by less than 40 degrees

class Merging {
public:
    Merging(PolygonMesh& mesh, std::vector<Quadric> planes, std::vector<double> tolerance)
        : mesh_(mesh),
          planes_(std::move(planes)),
          tolerance_(std::move(tolerance)),
          stands_for_(mesh.vertex_count()),
          facets_(mesh.vertex_count(), 0),
          moved_(mesh.vertex_count(), 1) {
        std::iota(stands_for_.begin(), stands_for_.end(), Index{0});
        const Triangulation cut = triangulate(mesh);
        facet_ = facet_of_triangle(cut);
        corners_.reserve(3 * cut.size());
        for (const Triangle& t : cut.triangles) corners_.insert(corners_.end(), t.begin(), t.end());
        TriangleSides sides = link_triangles(corners_, {}, mesh.vertex_count());
        twin_ = std::move(sides.twin);
        border_ = std::move(sides.border);
        for (Index v : corners_) ++facets_[v];
        touched_.assign(mesh.facet_count(), 0);
        lock_facets();
    }

    std::vector<Index> run() {
        for (const bool may_move : {false, true}) {
            may_move_ = may_move;
            changed_.assign(mesh_.vertex_count(), 1);
            missed_.assign(corners_.size(), 0);
            for (int sweep = 0; sweep < most_sweeps && merge_once() > 0; ++sweep) {
            }
        }
        write();
        for (Index& v : stands_for_)
            while (stands_for_[v] != v) v = stands_for_[v];
        return std::move(stands_for_);
    }

private:
    const Vec3& at(Index v) const { return mesh_.positions[v]; }
    Index end(Index s) const { return corners_[next_side(s)]; }
    bool is_gone(Index s) const { return corners_[s] == no_index; }

    /// A diagonal may be an edge of other facets already: such facets stay whole.
    void lock_facets() {
        for (Index s = 0; s < corners_.size(); ++s) {
            const auto ring = mesh_.facet(facet_[s / 3]);
            if (ring.size() == 3 || (twin_[s] != no_index && facet_[twin_[s] / 3] == facet_[s / 3])) continue;
            const auto start = std::find(ring.begin(), ring.end(), corners_[s]);
            if (end(s) == (start + 1 == ring.end() ? ring.front() : start[1])) continue;
            for (Index v : ring) tolerance_[v] = 0;
        }
    }

    /// The start of a side may merge into its end, at a place.
    struct Merger {
        double length;
        Index side;
        Vec3 place;
        bool either_way; ///< or the end into the start, where that is
    };

    /// Vertices merge once in a sweep, those across short edges first: a few sweeps make large facets of
    /// even size.
    std::size_t merge_once() {
        std::vector<Merger> mergers = find_mergers();
        tbb::parallel_sort(mergers.begin(), mergers.end(), [](const Merger& a, const Merger& b) {
            return a.length != b.length ? a.length < b.length : a.side < b.side;
        });
        changed_.assign(changed_.size(), 0);
        moved_.assign(changed_.size(), 0);
        std::size_t merged = 0;
        for (const Merger& m : mergers) {
            if (is_gone(m.side) || moved_[corners_[m.side]] || moved_[end(m.side)]) continue;
            merged += merge(m.side, m.place) || (m.either_way && merge(twin_[m.side], at(corners_[m.side])));
        }
        return merged;
    }

    std::vector<Merger> find_mergers() {
        std::vector<std::vector<Merger>> parts(chunk_count(corners_.size(), sides_per_chunk));
        for_chunks(corners_.size(), sides_per_chunk, [&](std::size_t begin, std::size_t end, std::size_t c) {
            for (auto s = static_cast<Index>(begin); s < end; ++s)
                if (!is_gone(s) && twin_[s] != no_index && s < twin_[s]) add_merger(s, parts[c]);
        });
        return joined(parts);
    }

    /// Looks again at edges near which something changed, but at those whose planes were missed only if one
    /// of the vertices did.
    void add_merger(Index s, std::vector<Merger>& mergers) {
        const Index a = corners_[s], b = end(s);
        if (!changed_[a] && !changed_[b]) return;
        if (missed_[s] && !moved_[a] && !moved_[b]) return;
        const double length = (at(b) - at(a)).sqrnorm();
        const bool there = holds(a, b), here = holds(b, a);
        missed_[s] = 0;
        if (there || here)
            mergers.push_back({length, there ? s : twin_[s], there ? at(b) : at(a), there && here});
        else if (const std::optional<Vec3> place = may_move_ ? place_for(a, b) : std::nullopt)
            mergers.push_back({length, s, *place, false});
        else
            missed_[s] = 1;
    }

    /// Can a second vertex stand for a first, where it is, about as well as that itself?
    bool holds(Index from, Index to) const {
        if (!(tolerance_[from] > 0 && tolerance_[to] > 0)) return false;
        const double most = std::min(tolerance_[from], tolerance_[to]);
        const double there = planes_[from].rms(at(to));
        return there <= most && there <= planes_[from].rms(at(from)) + free_share * most
               && planes_[to].rms(at(to)) <= most;
    }

    /// Where the planes of both are missed least, if that will do.
    std::optional<Vec3> place_for(Index a, Index b) const {
        if (!(tolerance_[a] > 0 && tolerance_[b] > 0)) return std::nullopt;
        Quadric both = planes_[a];
        both += planes_[b];
        const Vec3 place = both.minimum();
        const double reach = (at(b) - at(a)).sqrnorm(), most = std::min(tolerance_[a], tolerance_[b]);
        if ((place - at(a)).sqrnorm() > reach || (place - at(b)).sqrnorm() > reach) return std::nullopt;
        if (planes_[a].rms(place) > most || planes_[b].rms(place) > most) return std::nullopt;
        return place;
    }

    /// The neighbours of a side's start, its end first; false if its facets are not one whole fan.
    bool ring_of(Index side, std::vector<Index>& ring) const {
        ring.clear();
        Index s = side;
        do {
            ring.push_back(end(s));
            s = twin_[previous_side(s)];
        } while (s != no_index && s != side);
        return s == side && ring.size() == facets_[corners_[side]];
    }

    /// Merges the start of a side into its end, at a place, if the facets round them allow.
    bool merge(Index side, const Vec3& place) {
        const Index from = corners_[side], to = end(side);
        if (!ring_of(side, ring_) || !ring_of(twin_[side], ring_to_)) return false;
        if (!is_link(ring_, ring_to_) || !suits(place)) return false;
        if (place != at(to)) touch(twin_[side]);
        touch(side);
        mesh_.positions[to] = place;
        for (Index v : ring_) changed_[v] = 1;
        for (Index v : ring_to_) changed_[v] = 1;
        moved_[to] = 1;
        planes_[to] += planes_[from];
        tolerance_[to] = std::min(tolerance_[to], tolerance_[from]);
        stands_for_[from] = to;
        facets_[to] = facets_[to] + facets_[from] - 4;
        --facets_[ring_[1]];
        --facets_[ring_.back()];
        remove(side);
        return true;
    }

    /// No further vertex may be a neighbour of both, and those beside the edge must keep three facets.
    bool is_link(const std::vector<Index>& from, const std::vector<Index>& to) const {
        if (std::min(from.size(), to.size()) < 3 || from.size() + to.size() < 7) return false;
        if (from.size() + to.size() > most_facets + 4) return false;
        for (std::size_t i = 2; i + 1 < from.size(); ++i)
            if (std::find(to.begin(), to.end(), from[i]) != to.end()) return false;
        return spares(from[1]) && spares(from.back());
    }

    /// Can the vertex do with a facet less?
    bool spares(Index v) const { return facets_[v] > (border_[v] ? 1u : 3u); }

    bool suits(const Vec3& place) const {
        double thinnest = least_shape, thinnest_new = 1;
        const Index to = ring_[0];
        return suits_ring(place, ring_, ring_to_[0], thinnest, thinnest_new)
               && (place == at(to) || suits_ring(place, ring_to_, to, thinnest, thinnest_new))
               && thinnest_new >= thinnest;
    }

    /// The facets round a vertex that keep an area.
    bool suits_ring(const Vec3& place, const std::vector<Index>& ring, Index centre, double& thinnest,
                    double& thinnest_new) const {
        for (std::size_t i = 0; i < ring.size(); ++i)
            thinnest =
                std::min(thinnest, triangle_shape(at(centre), at(ring[i]), at(ring[(i + 1) % ring.size()])));
        for (std::size_t i = 1; i + 1 < ring.size(); ++i) {
            const Vec3 &p = at(ring[i]), &q = at(ring[i + 1]);
            const Vec3 before = triangle_normal(at(centre), p, q), after = triangle_normal(place, p, q);
            if (!((before | after) > turn_cosine * before.norm() * after.norm())) return false;
            thinnest_new = std::min(thinnest_new, triangle_shape(place, p, q));
        }
        return true;
    }

    /// The facets round the start of a side are not what they were.
    void touch(Index side) {
        sides_.clear();
        Index s = side;
        do {
            sides_.push_back(s);
            touched_[facet_[s / 3]] = 1;
            s = twin_[previous_side(s)];
        } while (s != side);
    }

    /// Takes out the two triangles at a side, whose start becomes its end; its fan was touched last.
    void remove(Index side) {
        const Index other = twin_[side], to = end(side);
        for (Index out : sides_) corners_[out] = to;
        for (const Index gone : {side, other}) {
            const Index p = twin_[next_side(gone)], q = twin_[previous_side(gone)];
            twin_[p] = q;
            twin_[q] = p;
        }
        for (const Index gone : {side, other})
            for (const Index corner : {gone, next_side(gone), previous_side(gone)})
                corners_[corner] = no_index;
    }

    /// Facets that nothing touched stay whole.
    void write() {
        PolygonMesh kept;
        Index t = 0;
        for (std::size_t f = 0; f < mesh_.facet_count(); ++f) {
            if (!touched_[f]) kept.add_facet(mesh_.facet(f));
            for (; t < facet_.size() && facet_[t] == f; ++t)
                if (touched_[f] && !is_gone(3 * t)) kept.add_facet({&corners_[3 * t], 3});
        }
        mesh_.corners = std::move(kept.corners);
        mesh_.first = std::move(kept.first);
    }

    PolygonMesh& mesh_;
    std::vector<Quadric> planes_;
    std::vector<double> tolerance_;
    bool may_move_ = false;
    std::vector<Index> stands_for_;
    std::vector<Index> corners_, twin_;         // per side of a triangle; no_index: it is gone
    std::vector<Index> facet_;                  // per triangle
    std::vector<Index> facets_;                 // per vertex, how many
    std::vector<std::uint8_t> border_;          // per vertex
    std::vector<std::uint8_t> moved_, changed_; // per vertex in the last sweep, itself or a facet
    std::vector<std::uint8_t> missed_;          // per side, are the planes of both ends missed everywhere?
    std::vector<std::uint8_t> touched_;         // per facet
    std::vector<Index> ring_, ring_to_, sides_; // of one merger
};

} // namespace

std::vector<Index> merge_vertices(PolygonMesh& mesh, std::vector<Quadric> planes,
                                  std::vector<double> tolerance) {
    return Merging(mesh, std::move(planes), std::move(tolerance)).run();
}

} // namespace hsdm
