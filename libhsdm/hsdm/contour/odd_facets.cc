#include "hsdm/contour/odd_facets.hh"

#include "hsdm/contour/constants.hh"
#include "hsdm/core/chunks.hh"
#include "hsdm/core/constants.hh"
#include "hsdm/core/parallel_sort.hh"
#include "hsdm/mesh/area_vector.hh"
#include "hsdm/mesh/constants.hh"
#include "hsdm/mesh/corner_pairs.hh"
#include "hsdm/mesh/facet_normal.hh"
#include "hsdm/mesh/facet_unions.hh"

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <tuple>

namespace hsdm {
namespace {

constexpr std::size_t most_corners = 10; // of two facets of five and a quad between

using Ring = std::vector<Index>;
using Edge = VertexPair;
using Quad = std::array<Index, 4>;

bool has(std::span<const Index> ring, Index v) {
    return std::ranges::find(ring, v) != ring.end();
}

/// Turns a ring so that it begins at its lowest vertex and goes on to the lower one beside it: what is
/// computed along it is the same then whichever way facets face. Returns whether that is the other way round.
bool set_right(Ring& ring) {
    std::rotate(ring.begin(), std::ranges::min_element(ring), ring.end());
    if (ring[1] < ring.back()) return false;
    std::reverse(ring.begin() + 1, ring.end());
    return true;
}

/// A side of two facets: one runs along it from its lower vertex up, the other one back.
struct Shared {
    Edge edge;
    Index up, down;
    Index other(Index facet) const { return facet == up ? down : up; }
};

/// Facets whose union is to be cut, and the sides that go; `no_index` where there are fewer.
struct Union {
    std::array<Index, 3> facets{no_index, no_index, no_index};
    std::array<Shared, 2> going{};

    std::size_t count() const {
        return static_cast<std::size_t>(std::ranges::find(facets, no_index) - facets.begin());
    }
    std::span<const Index> all() const { return std::span(facets).first(count()); }
    std::span<const Shared> sides() const { return std::span(going).first(count() - 1); }
};

/// The facets that may be recut, by the sides that they share.
class Neighbours {
public:
    explicit Neighbours(const PolygonMesh& mesh)
        : mesh_(mesh), at_odd_(large_vector<std::uint8_t>(mesh.vertex_count())) {
        for_each_index(mesh.facet_count(), chunks::light, [&](Index f) {
            if (!is_odd(f)) return;
            for (const Index v : mesh.facet(f))
                std::atomic_ref(at_odd_[v]).store(1, std::memory_order_relaxed);
        });
        sides_ = collected<Side>(mesh.facet_count(), chunks::quick,
                                 [&](std::size_t begin, std::size_t end, std::vector<Side>& part) {
                                     for (auto f = static_cast<Index>(begin); f < end; ++f)
                                         add_sides(f, part);
                                 });
        parallel_sort(sides_);
    }

    /// Odd facets side by side or with a quad between, and large even ones alone.
    std::vector<Union> unions() const {
        std::vector<Union> result;
        for (const Index f : indices_where(mesh_.facet_count(), chunks::light,
                                           [&](Index f) { return mesh_.facet(f).size() > 4 && !is_odd(f); }))
            result.push_back({{f, no_index, no_index}, {}});
        std::vector<BesideQuad> beside;
        for (std::size_t i = 1; i < sides_.size(); ++i) {
            const Side &one = sides_[i - 1], &other = sides_[i];
            if (one.edge != other.edge || one.goes_up == other.goes_up) continue;
            const Shared side{one.edge, one.goes_up ? one.facet : other.facet,
                              one.goes_up ? other.facet : one.facet};
            if (is_odd(side.up) && is_odd(side.down))
                result.push_back({{side.up, side.down, no_index}, {side, {}}});
            else if (is_odd(side.up) || is_odd(side.down))
                beside.push_back({is_odd(side.up) ? side.down : side.up, side});
        }
        parallel_sort(beside, [](const BesideQuad& a, const BesideQuad& b) {
            return std::tie(a.quad, a.side.edge) < std::tie(b.quad, b.side.edge);
        });
        for (std::size_t i = 0; i < beside.size(); ++i)
            for (std::size_t j = i + 1; j < beside.size() && beside[j].quad == beside[i].quad; ++j) {
                const Index quad = beside[i].quad;
                const Shared &one = beside[i].side, &other = beside[j].side;
                if (one.other(quad) != other.other(quad))
                    result.push_back({{one.other(quad), quad, other.other(quad)}, {one, other}});
            }
        return result;
    }

private:
    struct Side {
        Edge edge;
        Index facet;
        bool goes_up; ///< from the lower vertex
        auto operator<=>(const Side&) const = default;
    };
    struct BesideQuad {
        Index quad;
        Shared side; ///< with an odd facet
    };

    bool is_odd(Index f) const { return mesh_.facet(f).size() % 2 == 1; }

    void add_sides(Index f, std::vector<Side>& part) const {
        const auto facet = mesh_.facet(f);
        if (!is_odd(f) && facet.size() != 4) return;
        for (std::size_t i = 0; i < facet.size(); ++i) {
            const Index a = facet[i], b = facet[(i + 1) % facet.size()];
            if (at_odd_[a] && at_odd_[b]) part.push_back({pair_of(a, b), f, a < b});
        }
    }

    const PolygonMesh& mesh_;
    std::vector<std::uint8_t> at_odd_; // per vertex
    std::vector<Side> sides_;
};

std::vector<Index> vertices_of(std::span<const Union> unions, const PolygonMesh& mesh) {
    std::vector<Index> result;
    for (const Union& u : unions)
        for (const Index f : u.all()) result.insert(result.end(), mesh.facet(f).begin(), mesh.facet(f).end());
    return result;
}

/// A union and its quads.
struct Recut {
    Union of;
    Ring ring;              ///< of the union, set right
    bool is_turned = false; ///< its facets go round the other way
    std::vector<Quad> quads;
    std::vector<Edge> coming;
    double least_sine = 0; ///< of the corners of the quads

    bool is_before(const Recut& other) const {
        const Index lowest = std::ranges::min(of.facets), others = std::ranges::min(other.of.facets);
        return std::tie(other.least_sine, ring, lowest) < std::tie(least_sine, other.ring, others);
    }
    std::array<Edge, 2> diagonals(std::size_t quad) const {
        const Quad& q = quads[quad];
        return {pair_of(q[0], q[2]), pair_of(q[1], q[3])};
    }
};

/// Finds out how to cut unions, and which of them may be.
class Cutter {
public:
    Cutter(double tolerance, std::span<const VertexClass> classes, const PolygonMesh& mesh,
           std::span<const Union> unions)
        : tolerance_(tolerance),
          classes_(classes),
          mesh_(mesh),
          pairs_(mesh, vertices_of(unions, mesh)),
          facets_at_(large_vector<Index>(mesh.vertex_count())) {
        for_each_index(mesh.facet_count(), chunks::light, [&](Index f) {
            for (const Index v : mesh.facet(f))
                std::atomic_ref(facets_at_[v]).fetch_add(1, std::memory_order_relaxed);
        });
    }

    /// The best quads; none if the union may not be cut.
    Recut cut(const Union& of) const {
        Recut best{of, ring_of(of), false, {}, {}, 0};
        if (best.ring.empty() || best.ring.size() > most_corners) return best;
        for (const Shared& side : of.sides())
            if (may_be_crease(side)) return best;
        best.is_turned = set_right(best.ring);
        Recut way = best;
        try_all({best.ring}, area_vector(mesh_, best.ring), way, best);
        return best;
    }

private:
    Ring ring_of(const Union& of) const {
        const auto first = mesh_.facet(of.facets[0]);
        Ring ring(first.begin(), first.end());
        for (std::size_t i = 0; i + 1 < of.count() && !ring.empty(); ++i) {
            const auto [edge, up, down] = of.going[i];
            const auto next = mesh_.facet(of.facets[i + 1]);
            ring = up == of.facets[i + 1] ? united_across(next, ring, edge[0], edge[1])
                                          : united_across(ring, next, edge[0], edge[1]);
        }
        return ring;
    }

    double cosine(std::span<const Index> one, std::span<const Index> other) const {
        const auto normal = [&](std::span<const Index> facet) {
            Ring ring(facet.begin(), facet.end());
            const bool turned = set_right(ring);
            const Vec3 n = unit(area_vector(mesh_, ring));
            return turned ? -n : n;
        };
        return normal(one) | normal(other);
    }

    /// Do two facets bend as at a crease?
    bool is_fold(std::span<const Index> one, std::span<const Index> other) const {
        return cosine(one, other) < angles::smooth;
    }

    /// The same where a blunt one may run along their side.
    bool may_be_crease(const Shared& side) const {
        const auto is_smooth = [&](Index v) { return classes_[mesh_.origin[v]] == VertexClass::smooth; };
        const bool may_be_blunt = !is_smooth(side.edge[0]) && !is_smooth(side.edge[1]);
        return cosine(mesh_.facet(side.up), mesh_.facet(side.down))
               < (may_be_blunt ? blunt_creases::bluntest_cosine : angles::smooth);
    }

    /// Cuts a quad off the last of the rings at its first side, in all ways, until none is left.
    void try_all(std::vector<Ring> rings, const Vec3& up, Recut& way, Recut& best) const {
        if (rings.empty()) {
            judge(up, way, best);
            return;
        }
        const Ring ring = std::move(rings.back());
        rings.pop_back();
        const std::size_t n = ring.size(), quads = way.quads.size(), coming = way.coming.size();
        for (std::size_t j = 2; j + 1 < n; j += 2)
            for (std::size_t k = j + 1; k < n; k += 2) {
                way.quads.push_back({ring[0], ring[1], ring[j], ring[k]});
                std::vector<Ring> rest = rings;
                // what each side of the quad but the first cuts off, if it is none of the ring
                for (const auto& [from, to] :
                     {std::pair{std::size_t{1}, j}, std::pair{j, k}, std::pair{k, n}}) {
                    if (to - from == 1) continue;
                    way.coming.push_back(pair_of(ring[from], ring[to % n]));
                    Ring cut_off;
                    for (std::size_t i = from; i <= to; ++i) cut_off.push_back(ring[i % n]);
                    rest.push_back(std::move(cut_off));
                }
                try_all(std::move(rest), up, way, best);
                way.quads.resize(quads);
                way.coming.resize(coming);
            }
    }

    void judge(const Vec3& up, Recut& way, Recut& best) const {
        way.least_sine = 1;
        for (const Quad& quad : way.quads) way.least_sine = std::min(way.least_sine, sine_of(quad, up));
        std::vector<Edge> coming = way.coming;
        std::ranges::sort(coming);
        const bool is_better = best.quads.empty() // of equal ones that of the lower edges
                               || std::tie(best.least_sine, coming) < std::tie(way.least_sine, best.coming);
        if (!is_better || way.least_sine <= quad_splitting::least_corner || !keeps_surface(way)
            || !keeps_manifold(way))
            return;
        best.quads = way.quads;
        best.coming = std::move(coming);
        best.least_sine = way.least_sine;
    }

    /// The least sine of its corners; negative if one is reflex, or the quad faces down.
    double sine_of(const Quad& quad, const Vec3& up) const {
        Ring ring(quad.begin(), quad.end());
        const bool turned = set_right(ring);
        std::array<Vec3, 4> corners;
        for (std::size_t i = 0; i < 4; ++i) corners[i] = mesh_.positions[ring[i]];
        return ((area_vector(corners) | up) > 0) != turned ? least_corner_sine(corners) : -1;
    }

    /// How far apart the lines through two edges pass, if these cross within the ring; 0 if not.
    double gap(const Ring& ring, const Edge& one, const Edge& other) const {
        const auto place = [&](Index v) { return std::ranges::find(ring, v) - ring.begin(); };
        const auto [a, b] = std::minmax({place(one[0]), place(one[1])});
        const auto side = [&, a = a, b = b](Index v) { // of the first edge
            const std::ptrdiff_t i = place(v);
            return i == a || i == b ? 0 : a < i && i < b ? 1 : -1;
        };
        if (side(other[0]) * side(other[1]) >= 0) return 0;
        const auto& p = mesh_.positions;
        return line_distance(p[one[0]], p[one[1]], p[other[0]], p[other[1]]);
    }

    /// Does no new edge or quad bend as at a crease, and are edges that go near those that come, and the two
    /// diagonals of quads near each other?
    bool keeps_surface(const Recut& way) const {
        const auto is_near = [&](const Edge& one, const Edge& other) {
            return gap(way.ring, one, other) <= 2 * tolerance_; // what lies midway is as near to both
        };
        for (const Shared& going : way.of.sides())
            for (const Edge& coming : way.coming)
                if (!is_near(going.edge, coming)) return false;
        for (const Edge& edge : way.coming) {
            std::vector<Quad> beside;
            for (const Quad& q : way.quads)
                if (has(q, edge[0]) && has(q, edge[1])) beside.push_back(q);
            if (is_fold(beside[0], beside[1])) return false;
        }
        return std::ranges::all_of(way.quads, [&](const Quad& q) {
            const auto [a, b, c, d] = q;
            return is_near(pair_of(a, c), pair_of(b, d))
                   && (!is_fold(std::array{a, b, c}, std::array{a, c, d})
                       || !is_fold(std::array{b, c, d}, std::array{b, d, a}));
        });
    }

    /// Are its new edges, and the diagonals that its quads may be cut along, those of no other facet, and
    /// does no vertex lose its third facet?
    bool keeps_manifold(const Recut& way) const {
        const auto is_free = [&](const Edge& edge) { return !pairs_.are_together(edge, way.of.all()); };
        if (!std::ranges::all_of(way.coming, is_free)) return false;
        for (std::size_t q = 0; q < way.quads.size(); ++q)
            if (!std::ranges::all_of(way.diagonals(q), is_free)) return false;
        return std::ranges::all_of(way.ring, [&](Index v) {
            const std::ptrdiff_t more =
                std::ranges::count_if(way.coming, [&](const Edge& e) { return has(e, v); });
            const std::ptrdiff_t less =
                std::ranges::count_if(way.of.sides(), [&](const Shared& s) { return has(s.edge, v); });
            return more >= less || facets_at_[v] + more - less >= 3;
        });
    }

    double tolerance_;
    std::span<const VertexClass> classes_;
    const PolygonMesh& mesh_;
    CornerPairs pairs_;
    std::vector<Index> facets_at_; // per vertex, how many
};

/// Leaves those of which no better one has a facet, an end of an edge that comes or goes, or a new edge or
/// diagonal.
std::vector<Recut> first_ones(std::vector<Recut> recuts) {
    parallel_sort(recuts, [](const Recut& a, const Recut& b) { return a.is_before(b); });
    std::vector<std::tuple<Index, Index, std::size_t>>
        claims; // an edge, or twice a vertex; a facet; the recut
    for (std::size_t i = 0; i < recuts.size(); ++i) {
        const auto claim = [&](const Edge& edge) { claims.emplace_back(edge[0], edge[1], i); };
        const auto claim_ends = [&](const Edge& edge) {
            for (const Index v : edge) claim({v, v});
        };
        for (const Index f : recuts[i].of.all()) claim({no_index, f});
        for (const Shared& side : recuts[i].of.sides()) claim_ends(side.edge);
        for (const Edge& edge : recuts[i].coming) claim_ends(edge), claim(edge);
        for (std::size_t q = 0; q < recuts[i].quads.size(); ++q)
            for (const Edge& diagonal : recuts[i].diagonals(q)) claim(diagonal);
    }
    parallel_sort(claims);
    std::vector<std::uint8_t> is_later(recuts.size(), 0);
    for (std::size_t i = 1; i < claims.size(); ++i) {
        const auto& [a, b, recut] = claims[i];
        const auto& [last_a, last_b, last] = claims[i - 1];
        if (a == last_a && b == last_b && recut != last) is_later[recut] = 1;
    }
    std::vector<Recut> first;
    for (std::size_t i = 0; i < recuts.size(); ++i)
        if (!is_later[i]) first.push_back(std::move(recuts[i]));
    return first;
}

} // namespace

std::size_t recut_odd_facets(double tolerance, std::span<const VertexClass> classes, PolygonMesh& mesh) {
    std::size_t count = 0;
    for (int round = 0; round < repeats::few; ++round) {
        const std::vector<Union> unions = Neighbours(mesh).unions();
        if (unions.empty()) break;
        const Cutter cutter(tolerance, classes, mesh, unions);
        auto recuts = collected<Recut>(unions.size(), chunks::heavy,
                                       [&](std::size_t begin, std::size_t end, std::vector<Recut>& part) {
                                           for (; begin < end; ++begin)
                                               if (Recut r = cutter.cut(unions[begin]); !r.quads.empty())
                                                   part.push_back(std::move(r));
                                       });
        if (recuts.empty()) break;
        FacetUnions replaced(mesh);
        for (Recut& recut : first_ones(std::move(recuts))) {
            std::vector<Ring> quads;
            quads.reserve(recut.quads.size());
            for (const Quad& q : recut.quads) {
                quads.emplace_back(q.begin(), q.end());
                if (recut.is_turned) std::reverse(quads.back().begin() + 1, quads.back().end());
            }
            count += recut.of.count();
            std::ranges::sort(recut.of.facets); // the quads stand where the lowest was
            replaced.replace(recut.of.all(), std::move(quads));
        }
        replaced.apply(mesh);
    }
    return count;
}

} // namespace hsdm
