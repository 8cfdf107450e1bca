#include "hsdm/contour/untangle.hh"

#include "hsdm/contour/untangle_rounds.hh"
#include "hsdm/core/check_option.hh"
#include "hsdm/core/chunks.hh"
#include "hsdm/mesh/collapse_edges.hh"
#include "hsdm/mesh/facet_unions.hh"
#include "hsdm/mesh/part_of.hh"
#include "hsdm/mesh/remove_facets.hh"
#include "hsdm/mesh/split_polygon.hh"
#include "hsdm/mesh/vertex_neighbors.hh"
#include "hsdm/quality/topology.hh"

#include <algorithm>
#include <numbers>
#include <tuple>
#include <utility>

namespace hsdm {
namespace {

/// Facets that may make up a disc, so that others over its border could take their place.
class FacetDisc {
public:
    FacetDisc(const PolygonMesh& mesh, Index facet) : mesh_(mesh), facets_{facet} {}

    /// Adds the facets that have a vertex in common with it.
    void grow(const FacetsAt& at) { facets_ = at.of_any(vertices()); }

    bool has(Index f) const { return std::ranges::binary_search(facets_, f); }
    std::size_t size() const { return facets_.size(); }

    /// The vertices of the border in order; `within` becomes the others. Empty if the facets are no disc.
    std::vector<Index> border(std::vector<Index>& within) const {
        const std::vector<Index> all = vertices();
        std::vector<Index> loop = border_of(mesh_, facets_);
        std::size_t sides = 0;
        for (const Index f : facets_) sides += mesh_.facet(f).size();
        const std::size_t edges = (sides + loop.size()) / 2;
        if (loop.empty() || all.size() + facets_.size() != edges + 1) return {};
        std::vector<Index> sorted = loop;
        std::ranges::sort(sorted);
        within.clear();
        std::ranges::set_difference(all, sorted, std::back_inserter(within));
        return loop;
    }

private:
    /// Ascending.
    std::vector<Index> vertices() const {
        std::vector<Index> result;
        for (const Index f : facets_) {
            const auto ring = mesh_.facet(f);
            result.insert(result.end(), ring.begin(), ring.end());
        }
        sort_unique(result);
        return result;
    }

    const PolygonMesh& mesh_;
    std::vector<Index> facets_; // ascending
};

/// Changes the part at one place after the other, as long as each change leaves fewer intersections.
class Mender {
public:
    explicit Mender(TangledPart& around) : around_(around), found_(find_self_intersections(around.part)) {}

    std::size_t run() {
        std::size_t changes = 0, before = 0;
        do {
            before = changes;
            while (unite_two()) ++changes;
            while (collapse_an_edge()) ++changes;
            while (cut_a_facet()) ++changes;
            while (refill_a_disc()) ++changes;
        } while (changes > before && found_.triangle_pairs > 0);
        return changes;
    }

    /// What still intersects.
    const SelfIntersections& found() const { return found_; }

private:
    /// Takes the changed part if fewer facets meet in it. `made`: facets at its end that are new.
    bool take(PolygonMesh&& changed, std::size_t made = 0) {
        for (std::size_t f = changed.facet_count() - made; f < changed.facet_count(); ++f)
            if (!is_sound(changed, f)) return false;
        SelfIntersections left = find_self_intersections(changed);
        if (left.triangle_pairs >= found_.triangle_pairs) return false;
        around_.part = std::move(changed);
        found_ = std::move(left);
        return true;
    }

    /// Has a new facet an area, and other vertices than any facet? Else it would be left out in the end.
    static bool is_sound(const PolygonMesh& mesh, std::size_t facet) {
        const auto ring = mesh.facet(facet);
        std::vector<Vec3> corners;
        for (const Index v : ring) corners.push_back(mesh.positions[v]);
        if (has_no_area(corners)) return false;
        for (std::size_t f = 0; f < mesh.facet_count(); ++f)
            if (f != facet && std::ranges::is_permutation(mesh.facet(f), ring)) return false;
        return true;
    }

    std::vector<Index> tangled_facets() const {
        std::vector<Index> facets;
        for (const auto& pair : found_.facet_pairs) facets.insert(facets.end(), pair.begin(), pair.end());
        sort_unique(facets);
        return facets;
    }

    std::vector<Index> tangled_vertices() const {
        std::vector<Index> vertices;
        for (const Index f : tangled_facets())
            for (const Index v : around_.part.facet(f)) vertices.push_back(v);
        sort_unique(vertices);
        return vertices;
    }

    /// Cuts a facet that meets others in two, along one diagonal or another.
    bool cut_a_facet() {
        for (const Index f : tangled_facets()) {
            const auto ring = around_.part.facet(f);
            const std::size_t n = ring.size();
            for (std::size_t from = 0; from + 2 < n; ++from)
                for (std::size_t to = from + 2; to < std::min(n, from + n - 1); ++to)
                    if (cut_along(f, from, to)) return true;
        }
        return false;
    }

    bool cut_along(Index f, std::size_t from, std::size_t to) {
        const auto ring = around_.part.facet(f);
        if (!may_join(ring[from], ring[to])) return false;
        const auto at = [&](std::size_t i) { return ring.begin() + static_cast<std::ptrdiff_t>(i); };
        const std::vector<Index> one(at(from), at(to + 1));
        std::vector<Index> other(at(to), ring.end());
        other.insert(other.end(), ring.begin(), at(from + 1));
        PolygonMesh changed = around_.part;
        remove_facets(changed, [&](std::size_t g) { return g == f; });
        changed.add_facet(one);
        changed.add_facet(other);
        return take(std::move(changed), 2);
    }

    /// Makes one facet of two that are folded onto each other round vertices that have no other.
    bool unite_two() {
        const VertexFacets at = facets_at_vertices(around_.part);
        for (const Index v : tangled_vertices()) {
            if (at.count[v] != 2 || !around_.inner(v)) continue;
            const UnitedFacets whole = united(around_.part, at, v);
            if (whole.ring.size() < 3
                || !std::ranges::all_of(whole.between, [&](Index w) { return around_.inner(w); }))
                continue;
            const Index f = at.facets[v][0], g = at.facets[v][1];
            PolygonMesh changed = around_.part;
            remove_facets(changed, [&](std::size_t k) { return k == f || k == g; });
            changed.add_facet(whole.ring);
            if (take(std::move(changed), 1)) return true;
        }
        return false;
    }

    /// Fills the border of a disc of facets round a tangle anew, over its vertices alone.
    bool refill_a_disc() {
        const PolygonMesh& mesh = around_.part;
        const FacetsAt at(mesh, std::vector<std::uint8_t>(mesh.vertex_count(), 1));
        std::vector<FacetDisc> discs;
        for (const Index f : tangled_facets()) discs.emplace_back(mesh, f);
        for (int ring = 0; ring < untangling::refilled_rings; ++ring)
            for (FacetDisc& disc : discs) {
                disc.grow(at);
                if (disc.size() <= untangling::most_refilled && refill(disc)) return true;
            }
        return false;
    }

    bool refill(const FacetDisc& disc) {
        std::vector<Index> within;
        const std::vector<Index> border = disc.border(within);
        if (border.size() < 3 || !std::ranges::all_of(within, [&](Index v) { return around_.inner(v); }))
            return false;
        PolygonMesh changed = around_.part;
        remove_facets(changed, [&](std::size_t f) { return disc.has(static_cast<Index>(f)); });
        std::vector<Index> twice = border; // so that edges may be added
        twice.insert(twice.end(), border.begin(), border.end());
        EdgeSet edges(changed, twice);
        for (const Index a : border)
            for (const Index b : border)
                if (a < b && !around_.inner(a) && !around_.inner(b)) edges.add(std::array{a, b});
        const std::vector<Vec3> no_normals(border.size(), Vec3(0, 0, 0));
        const Pieces pieces =
            split_polygon(changed, border, no_normals, edges, {.max_bend = std::numbers::pi});
        for (const std::vector<Index>& piece : pieces) changed.add_facet(piece);
        return !pieces.empty() && take(std::move(changed), pieces.size());
    }

    /// Would an edge between two vertices be a new one?
    bool may_join(Index a, Index b) const {
        if (!around_.inner(a) && !around_.inner(b)) return false; // there may be one outside
        for (std::size_t f = 0; f < around_.part.facet_count(); ++f) {
            const auto ring = around_.part.facet(f);
            for (std::size_t i = 0; i < ring.size(); ++i) {
                const Index c = ring[i], d = ring[(i + 1) % ring.size()];
                if ((a == c && b == d) || (a == d && b == c)) return false;
            }
        }
        return true;
    }

    /// Collapses an edge that ends at facets that meet others, the shortest first.
    bool collapse_an_edge() {
        for (const EdgeCollapse& edge : tangled_edges()) {
            PolygonMesh changed = around_.part;
            if (collapse_edges(changed, {{edge}})[0] && take(std::move(changed))) return true;
        }
        return false;
    }

    /// Either way round, if both ends may move.
    std::vector<EdgeCollapse> tangled_edges() const {
        const PolygonMesh& mesh = around_.part;
        std::vector<std::uint8_t> tangled(mesh.vertex_count(), 0);
        for (const Index v : tangled_vertices()) tangled[v] = 1;
        std::vector<std::tuple<double, Index, Index>> edges;
        for (std::size_t f = 0; f < mesh.facet_count(); ++f) {
            const auto ring = mesh.facet(f);
            for (std::size_t i = 0; i < ring.size(); ++i) {
                const Index a = ring[i], b = ring[(i + 1) % ring.size()];
                if (!(tangled[a] || tangled[b]) || !around_.inner(a) || !around_.inner(b)) continue;
                const double length = (mesh.positions[a] - mesh.positions[b]).sqrnorm();
                edges.emplace_back(length, a, b);
                edges.emplace_back(length, b, a);
            }
        }
        sort_unique(edges);
        std::vector<EdgeCollapse> collapses;
        collapses.reserve(edges.size());
        for (const auto& [length, from, to] : edges) collapses.push_back({from, to, mesh.positions[to]});
        return collapses;
    }

    TangledPart& around_;
    SelfIntersections found_;
};

} // namespace

std::size_t mend_part(TangledPart& around, SelfIntersections& left) {
    Mender mender(around);
    const std::size_t changes = mender.run();
    left = mender.found();
    return changes;
}

UntangleCounts mend_tangles(PolygonMesh& mesh, double nearby, std::size_t most_pairs) {
    check_option(nearby > 0, "nearby", nearby, "be positive");
    SelfIntersections found = find_self_intersections(mesh);
    UntangleCounts counts;
    counts.before = counts.after = found.triangle_pairs;
    if (found.triangle_pairs == 0) return counts;
    counts.first = mesh.positions[mesh.facet(found.facet_pairs[0][0])[0]];
    if (found.facet_pairs.size() > most_pairs) return counts;
    TangledPart around(mesh, found.facet_pairs, nearby);
    counts.moved = mend_part(around, found);
    if (counts.moved == 0) return counts;
    around.replace_facets(mesh);
    found = find_self_intersections(mesh); // what is filled anew may reach farther than the part
    counts.after = found.triangle_pairs;
    if (counts.after > 0) counts.first = mesh.positions[mesh.facet(found.facet_pairs[0][0])[0]];
    return counts;
}

} // namespace hsdm
