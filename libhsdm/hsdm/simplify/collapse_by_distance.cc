#include "hsdm/simplify/collapse_by_distance.hh"

#include "hsdm/core/chunks.hh"
#include "hsdm/core/constants.hh"
#include "hsdm/core/hash.hh"
#include "hsdm/core/parallel_sort.hh"
#include "hsdm/simplify/constants.hh"
#include "hsdm/simplify/triangle_shape.hh"
#include "hsdm/spatial/point_triangle.hh"

#include <algorithm>

namespace hsdm {
namespace {

constexpr std::size_t collapses_per_chunk = 32;
// beside the middle, which is tested first
constexpr double along_edge[] = {0.125, 0.25, 0.375, 0.625, 0.75, 0.875};

/// Hash of the neighbours of a side's start, the side's end first; they are left in `ring`.
std::uint64_t hash_of_ring(const CollapsingMesh& mesh, Index side, std::vector<Index>& ring) {
    std::uint64_t hash = mesh.ring_of(side, ring);
    for (Index v : ring) hash = hash_index(hash ^ v);
    return hash;
}

class DistanceCollapsing {
public:
    DistanceCollapsing(CollapsingMesh mesh, const SurfaceWalk& fine, double tolerance)
        : mesh_(std::move(mesh)),
          fine_(fine),
          tolerance_(tolerance),
          waits_(mesh_.vertex_count(), 0),
          too_far_(mesh_.side_count(), 0),
          beside_(mesh_.vertex_count(), no_index) {
        find_beside();
    }

    std::vector<DistanceCollapse> run() {
        for (int sweep = 0; sweep < enough_rounds && drop_once(); ++sweep) {
        }
        return std::move(drops_);
    }

private:
    /// A candidate: the start of a side collapses onto its end.
    struct Collapse {
        double length;
        Index side;
        Index hint; ///< a triangle of the fine surface near the facets that replace its own
    };

    /// Buffers, reused from vertex to vertex.
    struct Scratch {
        std::vector<Index> ring, ring_to;
        std::vector<Collapse> sides;
        std::vector<Vec3> normals;
    };

    void find_beside() {
        for_chunks(beside_.size(), chunks::heavy, [&](std::size_t begin, std::size_t end, std::size_t) {
            Index hint = no_index;
            for (auto v = static_cast<Index>(begin); v < end; ++v) {
                fine_.triangle_within(mesh_.at(v), tolerance_, hint);
                beside_[v] = hint;
            }
        });
    }

    /// One sweep. The many sample places of measure() are tested only for collapses that keep_apart() has
    /// chosen: half of the candidates have to wait.
    bool drop_once() {
        std::vector<Collapse> collapses = find_collapses();
        parallel_sort(collapses, [](const Collapse& a, const Collapse& b) {
            return a.length != b.length ? a.length < b.length : a.side < b.side;
        });
        keep_apart(collapses);
        measure(collapses);
        mesh_.forget_changes();
        for (const Collapse& c : collapses) {
            if (too_far_[c.side]) continue;
            const DistanceCollapse drop{c.side, mesh_.start(c.side), mesh_.end(c.side),
                                        hash_of_ring(mesh_, c.side, ring_)};
            if (mesh_.collapse(drop.side, mesh_.at(drop.onto)))
                drops_.push_back(drop);
            else
                waits_[drop.vertex] = 1;
        }
        return !collapses.empty();
    }

    std::vector<Collapse> find_collapses() {
        const std::vector<Index> out = mesh_.sides_out();
        const auto find = [&](std::size_t begin, std::size_t end, std::vector<Collapse>& part) {
            Scratch scratch;
            for (auto v = static_cast<Index>(begin); v < end; ++v)
                if (out[v] != no_index && (mesh_.has_changed(v) || waits_[v]) && !mesh_.is_locked(v))
                    add_collapse(out[v], scratch, part);
        };
        return collected<Collapse>(out.size(), chunks::heavy, find);
    }

    /// Adds the shortest side that may collapse, judged by the middles of new edges alone.
    void add_collapse(Index first, Scratch& scratch, std::vector<Collapse>& found) {
        auto& [ring, ring_to, sides, normals] = scratch;
        if (!mesh_.ring_of(first, ring) || !is_smooth(mesh_.start(first), ring, normals)) return;
        sides.clear();
        Index s = first;
        do {
            if (mesh_.has_changed(mesh_.start(s))) too_far_[s] = 0;
            if (!mesh_.is_locked(mesh_.end(s)) && !too_far_[s])
                sides.push_back({(mesh_.at(mesh_.end(s)) - mesh_.at(mesh_.start(s))).sqrnorm(), s, no_index});
            s = mesh_.twin(previous_side(s));
        } while (s != first);
        std::sort(sides.begin(), sides.end(), [](const Collapse& a, const Collapse& b) {
            return a.length != b.length ? a.length < b.length : a.side < b.side;
        });
        for (const Collapse& c : sides) {
            Index hint = beside_[mesh_.start(c.side)];
            if (!mesh_.ring_of(c.side, ring) || !stays_near(mesh_.at(mesh_.start(c.side)), ring)) continue;
            if (!mesh_.ring_of(mesh_.twin(c.side), ring_to)) continue;
            if (!mesh_.may_collapse(ring, ring_to, mesh_.at(ring[0])) || !has_near_middles(ring, hint))
                continue;
            found.push_back({c.length, c.side, hint});
            return;
        }
    }

    /// Postpones collapses whose facets an earlier one of the list changes.
    void keep_apart(std::vector<Collapse>& collapses) {
        std::vector<std::uint8_t> taken(mesh_.vertex_count(), 0);
        waits_.assign(waits_.size(), 0);
        std::erase_if(collapses, [&](const Collapse& c) {
            const Index start = mesh_.start(c.side);
            waits_[start] = taken[start];
            if (taken[start]) return true;
            mesh_.ring_of(c.side, ring_);
            for (Index v : ring_) taken[v] = 1;
            return false;
        });
    }

    /// Marks collapses whose new facets are too far off; their vertices are tried again with other sides.
    void measure(const std::vector<Collapse>& collapses) {
        for_chunks(collapses.size(), collapses_per_chunk,
                   [&](std::size_t begin, std::size_t end, std::size_t) {
                       std::vector<Index> ring;
                       for (std::size_t i = begin; i < end; ++i) {
                           const Index side = collapses[i].side;
                           mesh_.ring_of(side, ring);
                           too_far_[side] = waits_[mesh_.start(side)] = !is_near(ring, collapses[i].hint);
                       }
                   });
    }

    bool is_smooth(Index v, const std::vector<Index>& ring, std::vector<Vec3>& normals) const {
        normals.clear();
        Vec3 sum(0, 0, 0);
        for (std::size_t i = 0; i < ring.size(); ++i) {
            const Vec3 n =
                triangle_normal(mesh_.at(v), mesh_.at(ring[i]), mesh_.at(ring[(i + 1) % ring.size()]));
            normals.push_back(n.sqrnorm() > 0 ? n.normalized() : n);
            sum += normals.back();
        }
        const double least = angles::smooth * sum.norm();
        return std::all_of(normals.begin(), normals.end(),
                           [&](const Vec3& normal) { return (normal | sum) >= least; });
    }

    /// Is a vertex near the facets that replace its own, fanned out from the ring's first vertex?
    bool stays_near(const Vec3& vertex, const std::vector<Index>& ring) const {
        for (std::size_t i = 1; i + 1 < ring.size(); ++i)
            if (PreparedTriangle(mesh_.at(ring[0]), mesh_.at(ring[i]), mesh_.at(ring[i + 1]))
                    .nearest(vertex)
                    .squared_distance
                <= tolerance_ * tolerance_)
                return true;
        return false;
    }

    /// Are the middles of the new edges, from the ring's first vertex, near the fine surface? Most candidates
    /// that fail do so here.
    bool has_near_middles(const std::vector<Index>& ring, Index& hint) const {
        const Vec3& to = mesh_.at(ring[0]);
        for (std::size_t i = 2; i + 1 < ring.size(); ++i)
            if (is_off(to + (mesh_.at(ring[i]) - to) * 0.5, hint)) return false;
        return true;
    }

    /// Are the new facets near the fine surface? Each sample place lies beside the one before, for the hint's
    /// sake.
    bool is_near(const std::vector<Index>& ring, Index hint) const {
        const Vec3& to = mesh_.at(ring[0]);
        for (std::size_t i = 2; i + 1 < ring.size(); ++i)
            for (const double share : along_edge)
                if (is_off(to + (mesh_.at(ring[i]) - to) * share, hint)) return false;
        for (std::size_t i = 1; i + 1 < ring.size(); ++i) {
            const Vec3 &p = mesh_.at(ring[i]), &q = mesh_.at(ring[i + 1]), middle = (to + p + q) / 3;
            if (is_off(middle, hint)) return false;
            for (const Vec3& corner : {to, p, q})
                if (is_off(0.5 * (middle + corner), hint)) return false;
        }
        return true;
    }

    /// Measured by walking from the surface beside the vertex, so that being near another sheet does not
    /// count.
    bool is_off(const Vec3& place, Index& hint) const { return !fine_.leads_within(place, tolerance_, hint); }

    CollapsingMesh mesh_;
    const SurfaceWalk& fine_;
    double tolerance_;
    std::vector<DistanceCollapse> drops_;
    std::vector<std::uint8_t> waits_;   // per vertex, look at it again even if nothing changed there
    std::vector<std::uint8_t> too_far_; // per side, measured as too far off since its start last changed
    std::vector<Index> beside_;         // per vertex, a triangle of the fine surface near it
    std::vector<Index> ring_;
};

} // namespace

std::vector<DistanceCollapse> find_distance_collapses(CollapsingMesh mesh, const SurfaceWalk& fine,
                                                      double tolerance) {
    return DistanceCollapsing(std::move(mesh), fine, tolerance).run();
}

CollapsedMesh collapse_by_distance(CollapsingMesh mesh, std::span<const DistanceCollapse> drops,
                                   const std::vector<std::uint8_t>& may_go) {
    std::vector<Index> ring;
    for (const DistanceCollapse& drop : drops)
        if (may_go[drop.vertex] && may_go[drop.onto] && mesh.start(drop.side) == drop.vertex
            && hash_of_ring(mesh, drop.side, ring) == drop.ring)
            mesh.collapse(drop.side, mesh.at(drop.onto));
    return mesh.write();
}

} // namespace hsdm
