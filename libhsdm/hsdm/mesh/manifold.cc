#include "hsdm/mesh/manifold.hh"

#include "hsdm/core/chunks.hh"
#include "hsdm/core/constants.hh"
#include "hsdm/core/large_vector.hh"
#include "hsdm/core/radix_sort.hh"
#include "hsdm/mesh/area_vector.hh"
#include "hsdm/mesh/constants.hh"
#include "hsdm/mesh/copy_vertex.hh"
#include "hsdm/mesh/edge_table.hh"
#include "hsdm/mesh/remove_facets.hh"

#include <algorithm>
#include <array>
#include <atomic>
#include <cassert>
#include <cmath>
#include <numbers>
#include <tuple>

namespace hsdm {
namespace {

// ---- step 1: simple facets, each set of vertices once --------------------------------------------------

bool is_simple(std::span<const Index> facet) {
    if (facet.size() < 3) return false;
    for (std::size_t i = 1; i < facet.size(); ++i)
        for (std::size_t j = 0; j < i; ++j)
            if (facet[i] == facet[j]) return false;
    return true;
}

/// Cuts a facet into loops that visit no vertex twice; loops of fewer than three vertices vanish.
void add_simple_parts(std::span<const Index> facet, PolygonMesh& out, std::size_t& degenerate) {
    std::vector<Index> path;
    bool added = false;
    auto add = [&](std::span<const Index> loop) {
        if (loop.size() < 3) return;
        out.add_facet(loop);
        added = true;
    };
    for (Index v : facet) {
        const auto seen = std::find(path.begin(), path.end(), v);
        if (seen != path.end()) {
            add({seen, path.end()});
            path.erase(seen, path.end());
        }
        path.push_back(v);
    }
    add(path);
    degenerate += !added;
}

void keep_simple(PolygonMesh& mesh, ManifoldCounts& counts) {
    std::atomic<bool> all_simple{true};
    for_each_index(mesh.facet_count(), chunks::quick, [&](std::size_t f) {
        if (!is_simple(mesh.facet(f))) all_simple.store(false, std::memory_order_relaxed);
    });
    if (all_simple) return;
    PolygonMesh simple;
    simple.corners.reserve(mesh.corners.size());
    simple.first.reserve(mesh.first.size());
    for (std::size_t f = 0; f < mesh.facet_count(); ++f) {
        if (is_simple(mesh.facet(f)))
            simple.add_facet(mesh.facet(f));
        else
            add_simple_parts(mesh.facet(f), simple, counts.degenerate);
    }
    mesh.corners.swap(simple.corners);
    mesh.first.swap(simple.first);
}

/// Hash of the set of a facet's vertices, whatever their order.
std::uint64_t vertex_set_hash(std::span<const Index> facet) {
    std::uint64_t sum = facet.size();
    for (Index v : facet) {
        std::uint64_t x = (v + 0x9e3779b97f4a7c15ull) * 0xbf58476d1ce4e5b9ull;
        x ^= x >> 31;
        sum += x * 0x94d049bb133111ebull;
    }
    return sum >> 32;
}

/// 1 if b is a, -1 if b is a reversed, 0 if b visits the same vertices in another order.
int relative_orientation(std::span<const Index> a, std::span<const Index> b) {
    const std::size_t n = a.size();
    const auto at = static_cast<std::size_t>(std::find(b.begin(), b.end(), a[0]) - b.begin());
    bool same = true, reversed = true;
    for (std::size_t i = 0; i < n; ++i) {
        same &= b[(at + i) % n] == a[i];
        reversed &= b[(at + n - i) % n] == a[i];
    }
    return same ? 1 : reversed ? -1 : 0;
}

/// Thins out a group of facets over the same vertices: pairs of opposite orientation cancel, one of the rest
/// stays.
void thin_out(const PolygonMesh& mesh, std::span<const CodeIndex> group, std::vector<std::uint8_t>& removed,
              ManifoldCounts& counts) {
    std::vector<Index> same, reversed;
    for (const CodeIndex& key : group) {
        const int way = relative_orientation(mesh.facet(group[0].index), mesh.facet(key.index));
        (way < 0 ? reversed : same).push_back(key.index);
    }
    const std::size_t pairs = std::min(same.size(), reversed.size());
    std::vector<Index>& rest = same.size() > pairs ? same : reversed;
    for (const CodeIndex& key : group) removed[key.index] = 1;
    counts.cancelled += 2 * pairs;
    if (rest.size() == pairs) return;
    removed[rest.front()] = 0;
    counts.duplicates += rest.size() - pairs - 1;
}

void remove_duplicates(PolygonMesh& mesh, ManifoldCounts& counts) {
    std::vector<CodeIndex> keys = large_vector<CodeIndex>(mesh.facet_count());
    for_each_index(keys.size(), chunks::quick, [&](std::size_t f) {
        keys[f] = {vertex_set_hash(mesh.facet(f)), static_cast<Index>(f)};
    });
    radix_sort(keys, 32);
    std::vector<std::uint8_t> removed = large_vector<std::uint8_t>(keys.size());
    std::size_t begin = 0;
    for_each_in_order(keys.size(), [&](std::size_t last) {
        const std::size_t end = last + 1;
        if (end < keys.size() && keys[end].code == keys[begin].code) return;
        // Different vertex sets with the same hash are separated first; groups of more than one facet are
        // rare.
        for (std::size_t i = begin; end - i > 1;) {
            const auto first = keys.begin() + static_cast<std::ptrdiff_t>(i);
            const auto mid = std::stable_partition(first, keys.begin() + static_cast<std::ptrdiff_t>(end),
                                                   [&, leader = first->index](const CodeIndex& key) {
                                                       return have_same_vertices(mesh.facet(leader),
                                                                                 mesh.facet(key.index));
                                                   });
            if (mid - first > 1) thin_out(mesh, {first, mid}, removed, counts);
            i += static_cast<std::size_t>(mid - first);
        }
        begin = end;
    });
    if (counts.cancelled + counts.duplicates > 0)
        remove_facets(mesh, [&](std::size_t f) { return removed[f] != 0; });
}

// ---- steps 2 and 3 ---------------------------------------------------------------------------------------

/// The half-edge of a facet's corner runs from that corner to the next one. Half-edges are numbered like
/// corners.
class FanSplitter {
public:
    FanSplitter(PolygonMesh& mesh, ManifoldCounts& counts) : mesh_(mesh), counts_(counts) {}

    void run() {
        link_corners();
        pair_edges();
        assign_vertices();
        for (int round = 0; round < enough_rounds && flip_crowded_edges(); ++round) assign_vertices();
        subdivide_crowded_edges();
        for (const ComplexEdge& edge : complex_)
            for (Index h : half_edges(edge)) counts_.opened_edges += twin_[h] == no_index;
        counts_.complex_edges = complex_.size();
        counts_.split_vertices = source_.size();
        write_back();
    }

private:
    /// An edge that is not simply shared by two facets that run along it in opposite directions.
    struct ComplexEdge {
        Index begin, end;    ///< its half-edges in by_edge_
        bool outside = true; ///< which of the two pairings: around the outside or the inside of the surface
    };

    Index start(Index h) const { return mesh_.corners[h]; }
    Index finish(Index h) const { return mesh_.corners[next_[h]]; }
    std::span<const Index> half_edges(const ComplexEdge& edge) const {
        return {by_edge_.data() + edge.begin, by_edge_.data() + edge.end};
    }

    void link_corners() {
        next_ = next_sides(mesh_);
        resize_large(facet_, mesh_.corners.size());
        for_each_index(mesh_.facet_count(), chunks::quick, [&](std::size_t f) {
            std::fill(facet_.begin() + mesh_.first[f], facet_.begin() + mesh_.first[f + 1],
                      static_cast<Index>(f));
        });
    }

    Index upper(Index h) const { return std::max(start(h), finish(h)); }

    /// Pairs the two half-edges of simple edges; gathers complex edges and pairs their half-edges by angle.
    void pair_edges() {
        assign_large(twin_, mesh_.corners.size(), no_index);
        const EdgeTable edges(mesh_);
        std::vector<std::vector<Index>> sizes(edges.chunks()), half_edges(edges.chunks());
        edges.for_edges([&](Index, std::span<const EdgeSide> edge, std::size_t c) {
            if (edge.size() == 1) return;
            const Index a = edge[0].side, b = edge[1].side;
            if (edge.size() == 2 && start(a) != start(b)) {
                twin_[a] = b;
                twin_[b] = a;
                return;
            }
            sizes[c].push_back(static_cast<Index>(edge.size()));
            for (const EdgeSide& side : edge) half_edges[c].push_back(side.side);
        });
        by_edge_ = joined(half_edges);
        Index begin = 0;
        for (Index size : joined(sizes)) {
            complex_.push_back({begin, begin + size});
            begin += size;
        }
        if (!complex_.empty()) resize_large(angle_, mesh_.corners.size());
        for (ComplexEdge& edge : complex_) order_by_angle(edge);
        for (ComplexEdge& edge : complex_) {
            edge.outside = bend(edge, true) < bend(edge, false) - 1e-6;
            pair(edge, edge.outside);
        }
    }

    /// Sorts an edge's half-edges counterclockwise around the direction from its lower to its upper vertex.
    void order_by_angle(const ComplexEdge& edge) {
        const Index h0 = by_edge_[edge.begin];
        const Vec3 origin = mesh_.positions[std::min(start(h0), finish(h0))];
        const Vec3 axis = mesh_.positions[upper(h0)] - origin;
        const double length2 = std::max(axis.sqrnorm(), std::numeric_limits<double>::min());
        auto across = [&](Index h) {
            const Vec3 d = centroid(mesh_, mesh_.facet(facet_[h])) - origin;
            return d - axis * ((d | axis) / length2);
        };
        const Vec3 x = across(h0), y = (axis % x) / std::sqrt(length2);
        std::vector<std::pair<double, Index>> order;
        for (Index h : half_edges(edge)) {
            const Vec3 d = across(h);
            double a = std::atan2(d | y, d | x);
            if (a < 0) a += 2 * std::numbers::pi;
            angle_[h] = a;
            order.emplace_back(a, h);
        }
        std::sort(order.begin(), order.end());
        for (std::size_t i = 0; i < order.size(); ++i) by_edge_[edge.begin + i] = order[i].second;
    }

    bool forward(Index h) const { return start(h) < finish(h); }

    // A facet that runs along the edge forward has its outside counterclockwise of it, one that runs backward
    // clockwise. So a forward facet and the next backward one bound a wedge of outside, a backward facet and
    // the next forward one a wedge of inside. Matching openers with closers like brackets never crosses.
    template <class Match>
    void match(const ComplexEdge& edge, bool outside, const Match& visit) const {
        std::vector<Index> open;
        const std::size_t n = edge.end - edge.begin;
        std::vector<std::uint8_t> taken(n, 0);
        for (std::size_t i = 0; i < 2 * n; ++i) { // twice round, because the first opener may lie anywhere
            const auto k = static_cast<Index>(i % n);
            if (taken[k]) continue;
            const bool opens = forward(by_edge_[edge.begin + k]) == outside;
            if (opens) {
                if (i < n) open.push_back(k);
            } else if (!open.empty()) {
                const Index o = open.back();
                open.pop_back();
                taken[k] = taken[o] = 1;
                visit(by_edge_[edge.begin + o], by_edge_[edge.begin + k]);
            }
        }
    }

    /// How far from flat the facets of a pairing meet, summed over its pairs, in radians.
    double bend(const ComplexEdge& edge, bool outside) const {
        double sum = 0;
        match(edge, outside, [&](Index opener, Index closer) {
            double wedge = angle_[closer] - angle_[opener];
            if (wedge < 0) wedge += 2 * std::numbers::pi;
            sum += std::abs(std::numbers::pi - wedge);
        });
        return sum;
    }

    void pair(const ComplexEdge& edge, bool outside) {
        for (Index h : half_edges(edge)) twin_[h] = no_index;
        match(edge, outside, [&](Index a, Index b) {
            twin_[a] = b;
            twin_[b] = a;
        });
    }

    /// One vertex per fan: corners that follow each other around a vertex through paired half-edges share
    /// one. The first fan keeps the vertex; the others get new ones, numbered from vertex_count() on.
    void assign_vertices() {
        assign_large(vertex_of_, mesh_.corners.size(), no_index);
        source_.clear();
        std::vector<std::uint8_t> claimed(mesh_.vertex_count(), 0);
        for (Index h = 0; h < mesh_.corners.size(); ++h) {
            if (vertex_of_[h] != no_index) continue;
            const Index v = start(h);
            // Around the vertex to the end of the fan, to this corner again, or to a part seen before.
            Index c = h;
            while (twin_[c] != no_index) {
                c = next_[twin_[c]];
                if (c == h || vertex_of_[c] != no_index) break;
            }
            Index id = vertex_of_[c];
            if (id == no_index) {
                id = claimed[v] ? static_cast<Index>(mesh_.vertex_count() + source_.size()) : v;
                if (claimed[v]) source_.push_back(v);
                claimed[v] = 1;
            }
            for (c = h; vertex_of_[c] == no_index; c = next_[twin_[c]]) {
                vertex_of_[c] = id;
                if (twin_[c] == no_index) break;
            }
        }
    }

    std::pair<Index, Index> new_edge(Index h) const {
        return std::minmax({vertex_of_[h], vertex_of_[next_[h]]});
    }

    /// Half-edges of a complex edge beyond the two opposite ones that an edge of the new mesh may have, one
    /// of each pair.
    std::vector<Index> crowded(const ComplexEdge& edge) const {
        std::vector<Index> surplus, seen;
        for (Index h : half_edges(edge)) {
            if (twin_[h] != no_index && twin_[h] < h) continue;
            const bool taken =
                std::any_of(seen.begin(), seen.end(), [&](Index s) { return new_edge(s) == new_edge(h); });
            (taken ? surplus : seen).push_back(h);
        }
        return surplus;
    }

    /// Pairs crowded edges the other way: two pairs of facets that still share both ends of an edge often
    /// part then.
    bool flip_crowded_edges() {
        bool flipped = false;
        for (ComplexEdge& edge : complex_) {
            if (crowded(edge).empty()) continue;
            edge.outside = !edge.outside;
            pair(edge, edge.outside);
            flipped = true;
        }
        return flipped;
    }

    /// The last resort: each surplus pair gets a vertex in the middle of the edge, which parts it from the
    /// others.
    void subdivide_crowded_edges() {
        for (const ComplexEdge& edge : complex_)
            for (Index h : crowded(edge)) middle_.emplace_back(h, twin_[h]);
        counts_.subdivided_edges = middle_.size();
    }

    void write_back();
    void cut_halved_facets();

    PolygonMesh& mesh_;
    ManifoldCounts& counts_;
    std::vector<Index> next_, facet_, twin_;
    std::vector<Index> by_edge_; ///< half-edges of complex edges
    std::vector<ComplexEdge> complex_;
    std::vector<double> angle_;
    std::vector<Index> vertex_of_;                ///< per corner, its vertex in the new mesh
    std::vector<Index> source_;                   ///< per new vertex, the one it copies
    std::vector<std::pair<Index, Index>> middle_; ///< edges to halve, by their half-edges
};

void FanSplitter::write_back() {
    mesh_.corners.swap(vertex_of_);
    for (Index source : source_) copy_vertex(mesh_, source);
    if (!middle_.empty()) cut_halved_facets();
}

/// Facets on a halved edge become fans of triangles around their centroid: no triangle is flat, as one with
/// the middle of the edge for a corner of the polygon would be.
void FanSplitter::cut_halved_facets() {
    std::vector<std::pair<Index, Index>> vertex_at; // half-edge, the vertex in its middle
    for (auto [h, twin] : middle_) {
        const Index a = start(h), b = finish(h);
        const Index m = copy_vertex(mesh_, a);
        mesh_.positions[m] = (mesh_.positions[a] + mesh_.positions[b]) * 0.5;
        vertex_at.emplace_back(h, m);
        if (twin != no_index) vertex_at.emplace_back(twin, m);
    }
    std::sort(vertex_at.begin(), vertex_at.end());
    std::vector<std::uint8_t> cut(mesh_.facet_count(), 0);
    for (std::size_t begin = 0, end = 0; begin < vertex_at.size(); begin = end) {
        const Index f = facet_[vertex_at[begin].first];
        while (end < vertex_at.size() && facet_[vertex_at[end].first] == f) ++end;
        std::vector<Index> ring;
        std::size_t next = begin;
        for (Index h = mesh_.first[f]; h < mesh_.first[f + 1]; ++h) {
            ring.push_back(mesh_.corners[h]);
            if (next < end && vertex_at[next].first == h) ring.push_back(vertex_at[next++].second);
        }
        const Index center = copy_vertex(mesh_, ring[0]);
        mesh_.positions[center] = centroid(mesh_, mesh_.facet(f));
        for (std::size_t i = 0; i < ring.size(); ++i)
            mesh_.add_facet(std::array{ring[i], ring[(i + 1) % ring.size()], center});
        cut[f] = 1;
    }
    cut.resize(mesh_.facet_count(), 0);
    remove_facets(mesh_, [&](std::size_t f) { return cut[f] != 0; });
}

} // namespace

std::size_t remove_isolated_vertices(PolygonMesh& mesh) {
    std::vector<Index> renumbered = large_vector<Index>(mesh.vertex_count(), no_index);
    for_each_in_order(mesh.corners.size(), [&](std::size_t c) { renumbered[mesh.corners[c]] = 0; });
    Index count = 0;
    for_each_in_order(renumbered.size(), [&](std::size_t v) {
        if (renumbered[v] != no_index) renumbered[v] = count++;
    });
    const std::size_t removed = mesh.vertex_count() - count;
    if (removed == 0) return 0;
    const auto compact = [&](auto& values) {
        for_each_in_order(renumbered.size(), [&](std::size_t v) {
            if (renumbered[v] != no_index) values[renumbered[v]] = values[v];
        });
        values.resize(count);
    };
    compact(mesh.positions);
    if (!mesh.normals.empty()) compact(mesh.normals);
    if (!mesh.origin.empty()) compact(mesh.origin);
    for (VertexProperty& property : mesh.properties) compact(property.values);
    for_each_index(mesh.corners.size(), chunks::light,
                   [&](Index c) { mesh.corners[c] = renumbered[mesh.corners[c]]; });
    for (auto& ends : mesh.sharp_edges)
        for (Index& v : ends) v = renumbered[v];
    std::erase_if(mesh.sharp_edges,
                  [](const auto& ends) { return ends[0] == no_index || ends[1] == no_index; });
    return removed;
}

bool is_manifold(const PolygonMesh& mesh, const FacetLinks& links) {
    if (links.rejected > 0 || links.split_vertices > 0 || links.source.size() != mesh.vertex_count())
        return false;
    std::atomic<bool> doubled{
        false}; // does another facet, round any one of its vertices, have the same ones?
    for_each_index(mesh.facet_count(), chunks::quick, [&](Index f) {
        const Index begin = links.side_out[links.vertex[mesh.first[f]]];
        Index side = begin;
        do {
            const Index g = links.facet[side];
            if (g != f && have_same_vertices(mesh.facet(f), mesh.facet(g), 2))
                doubled.store(true, std::memory_order_relaxed);
            side = links.twin[previous_side(mesh, g, side)];
        } while (side != no_index && side != begin);
    });
    return !doubled;
}

ManifoldCounts make_manifold(PolygonMesh& mesh) {
    ManifoldCounts counts;
    keep_simple(mesh, counts);
    remove_duplicates(mesh, counts);
    FanSplitter(mesh, counts).run();
    counts.isolated_vertices = remove_isolated_vertices(mesh);
    return counts;
}

} // namespace hsdm
