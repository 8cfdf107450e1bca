#include "hsdm/contour/odd_facets.hh"

#include "hsdm/contour/constants.hh"
#include "hsdm/core/chunks.hh"
#include "hsdm/core/constants.hh"
#include "hsdm/mesh/area_vector.hh"
#include "hsdm/mesh/constants.hh"
#include "hsdm/mesh/edge_set.hh"

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <tuple>

namespace hsdm {
namespace {

using Ring = std::vector<Index>;
using Edge = std::array<Index, 2>; // the lower vertex first
using Quad = std::array<Index, 4>;

Edge edge_of(Index a, Index b) {
    return {std::min(a, b), std::max(a, b)};
}

/// A few facets of which quads alone are to be made.
struct Recut {
    std::vector<Index> facets;
    Ring ring;               ///< of their union, from its lowest vertex towards the lower one beside it
    std::vector<Edge> going; ///< sides that two of the facets share
    std::vector<Edge> coming;
    std::vector<Quad> quads; ///< the way of the ring
    bool is_turned = false;  ///< the facets go round the other way
    double least_sine = 0;   ///< of the corners of the quads
    bool is_before(const Recut& other) const {
        return std::tie(other.least_sine, ring) < std::tie(least_sine, other.ring);
    }
};

/// From the lowest vertex towards the lower one beside it, so that what is computed along the ring is the
/// same whichever way facets face. Returns whether that is the other way round.
bool set_right(Ring& ring) {
    std::rotate(ring.begin(), std::ranges::min_element(ring), ring.end());
    if (ring[1] < ring.back()) return false;
    std::reverse(ring.begin() + 1, ring.end());
    return true;
}

/// The union of two facets that share the side; empty if it has a vertex twice.
Ring united_across(const Edge& side, std::span<const Index> f, std::span<const Index> g) {
    const auto ring_behind = [&](std::span<const Index> facet) {
        Ring ring(facet.begin(), facet.end());
        const auto at = std::ranges::find_if(ring, [&](const Index& v) {
            const Index next = &v == &ring.back() ? ring.front() : *(&v + 1);
            return edge_of(v, next) == side;
        });
        std::rotate(ring.begin(), at == ring.end() ? at : at + 1, ring.end());
        return ring; // the side leads from its last corner to its first
    };
    Ring whole = ring_behind(f);
    const Ring other = ring_behind(g);
    whole.insert(whole.end(), other.begin() + 1, other.end() - 1);
    Ring sorted = whole;
    std::ranges::sort(sorted);
    if (std::ranges::adjacent_find(sorted) != sorted.end()) return {};
    return whole;
}

/// The facets that may be recut, by the sides that they share.
class Neighbours {
public:
    explicit Neighbours(const PolygonMesh& mesh) : mesh_(mesh), at_odd_(mesh.vertex_count(), 0) {
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
        std::sort(sides_.begin(), sides_.end());
    }

    /// Unions whose facets are odd, odd with a quad between, or even and large.
    std::vector<Recut> unions() const {
        std::vector<Recut> result;
        std::vector<BesideQuad> beside;
        for (Index f = 0; f < mesh_.facet_count(); ++f)
            if (const auto facet = mesh_.facet(f); facet.size() > 4 && !is_odd(f))
                add({f}, {}, Ring(facet.begin(), facet.end()), result);
        for (std::size_t i = 1; i < sides_.size(); ++i) {
            const auto [edge, f] = sides_[i - 1];
            const Index g = sides_[i].facet;
            if (sides_[i].edge != edge) continue;
            if (is_odd(f) && is_odd(g))
                add({f, g}, {edge}, united_across(edge, mesh_.facet(f), mesh_.facet(g)), result);
            else if (is_odd(f) || is_odd(g))
                beside.push_back(is_odd(f) ? BesideQuad{g, f, edge} : BesideQuad{f, g, edge});
        }
        std::ranges::sort(beside);
        for (std::size_t i = 0; i < beside.size(); ++i)
            for (std::size_t j = i + 1; j < beside.size() && beside[j].quad == beside[i].quad; ++j)
                add_across(beside[i], beside[j], result);
        return result;
    }

private:
    static constexpr std::size_t most_corners = 10; // of two facets of five and a quad between

    struct Side {
        Edge edge;
        Index facet;
        auto operator<=>(const Side&) const = default;
    };
    struct BesideQuad {
        Index quad, odd;
        Edge edge;
        auto operator<=>(const BesideQuad&) const = default;
    };

    bool is_odd(Index f) const { return mesh_.facet(f).size() % 2 == 1; }

    void add_sides(Index f, std::vector<Side>& part) const {
        const auto facet = mesh_.facet(f);
        if (!is_odd(f) && facet.size() != 4) return;
        for (std::size_t i = 0; i < facet.size(); ++i) {
            const Index a = facet[i], b = facet[(i + 1) % facet.size()];
            if (at_odd_[a] && at_odd_[b]) part.push_back({edge_of(a, b), f});
        }
    }

    void add_across(const BesideQuad& one, const BesideQuad& other, std::vector<Recut>& result) const {
        if (one.odd == other.odd) return;
        const Ring half = united_across(one.edge, mesh_.facet(one.odd), mesh_.facet(one.quad));
        if (half.empty()) return;
        add({one.odd, one.quad, other.odd}, {one.edge, other.edge},
            united_across(other.edge, half, mesh_.facet(other.odd)), result);
    }

    static void add(std::vector<Index> facets, std::vector<Edge> going, Ring ring,
                    std::vector<Recut>& result) {
        if (ring.empty() || ring.size() > most_corners) return;
        Recut recut;
        recut.is_turned = set_right(ring);
        recut.facets = std::move(facets), recut.going = std::move(going), recut.ring = std::move(ring);
        result.push_back(std::move(recut));
    }

    const PolygonMesh& mesh_;
    std::vector<std::uint8_t> at_odd_; // per vertex
    std::vector<Side> sides_;
};

/// Finds out how to cut unions, and which of them may be.
class Cutter {
public:
    Cutter(double tolerance, std::span<const VertexClass> classes, const PolygonMesh& mesh,
           std::span<const Recut> unions)
        : tolerance_(tolerance),
          classes_(classes),
          mesh_(mesh),
          edges_(mesh, vertices_of(unions)),
          facets_at_(mesh.vertex_count(), 0) {
        for_each_index(mesh.facet_count(), chunks::light, [&](Index f) {
            for (const Index v : mesh.facet(f))
                std::atomic_ref(facets_at_[v]).fetch_add(1, std::memory_order_relaxed);
        });
    }

    /// Fills in the best quads; returns whether there are any.
    bool cut(Recut& recut) const {
        for (const Edge& side : recut.going)
            if (is_fold(side, recut.facets)) return false;
        Recut way = recut;
        try_all({recut.ring}, way, recut);
        return !recut.quads.empty();
    }

private:
    static std::vector<Index> vertices_of(std::span<const Recut> unions) {
        std::vector<Index> result;
        for (const Recut& recut : unions) result.insert(result.end(), recut.ring.begin(), recut.ring.end());
        return result;
    }

    /// Do the two facets of the side bend as they do at creases?
    bool is_fold(const Edge& side, std::span<const Index> facets) const {
        std::vector<Vec3> normals;
        for (const Index f : facets) {
            Ring ring(mesh_.facet(f).begin(), mesh_.facet(f).end());
            if (std::ranges::find(ring, side[0]) == ring.end()
                || std::ranges::find(ring, side[1]) == ring.end())
                continue;
            const bool turned = set_right(ring);
            const Vec3 normal = unit(area_vector(mesh_, ring));
            normals.push_back(turned ? -normal : normal);
        }
        const bool on_crease =
            class_of(side[0]) != VertexClass::smooth && class_of(side[1]) != VertexClass::smooth;
        return (normals[0] | normals[1]) < (on_crease ? blunt_creases::bluntest_cosine : angles::smooth);
    }

    VertexClass class_of(Index v) const { return classes_[mesh_.origin[v]]; }

    /// Cuts a quad off the last of the rings at its first side, in all ways, until none is left.
    void try_all(std::vector<Ring> rings, Recut& way, Recut& best) const {
        if (rings.empty()) {
            judge(way, best);
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
                    way.coming.push_back(edge_of(ring[from], ring[to % n]));
                    Ring cut_off(ring.begin() + static_cast<std::ptrdiff_t>(from),
                                 ring.begin() + static_cast<std::ptrdiff_t>(std::min(to + 1, n)));
                    if (to == n) cut_off.push_back(ring[0]);
                    rest.push_back(std::move(cut_off));
                }
                try_all(std::move(rest), way, best);
                way.quads.resize(quads);
                way.coming.resize(coming);
            }
    }

    void judge(Recut& way, Recut& best) const {
        way.least_sine = 1;
        const Vec3 upward = area_vector(mesh_, way.ring);
        for (const Quad& quad : way.quads)
            way.least_sine = std::min(way.least_sine, least_sine(quad, upward));
        std::vector<Edge> coming = way.coming;
        std::ranges::sort(coming);
        if (way.least_sine <= quad_splitting::least_corner || !keeps_surface(way) || !keeps_manifold(way))
            return;
        if (!best.quads.empty()
            && std::tie(best.least_sine, coming) >= std::tie(way.least_sine, best.coming)) // ties: lower ones
            return;
        best.quads = way.quads;
        best.coming = std::move(coming);
        best.least_sine = way.least_sine;
    }

    /// The least sine of its corners; negative if one is reflex, or the quad faces down.
    double least_sine(const Quad& quad, const Vec3& upward) const {
        Ring ring(quad.begin(), quad.end());
        const bool turned = set_right(ring);
        const Vec3 normal = unit(area_vector(mesh_, ring));
        double least = ((normal | upward) > 0) != turned ? 1 : -1;
        for (std::size_t i = 0; i < 4; ++i) {
            const Vec3 on = position(ring[(i + 1) % 4]) - position(ring[i]);
            const Vec3 back = position(ring[(i + 3) % 4]) - position(ring[i]);
            const double lengths = on.norm() * back.norm();
            least = std::min(least, lengths > 0 ? (normal | (on % back)) / lengths : 0);
        }
        return least;
    }

    const Vec3& position(Index v) const { return mesh_.positions[v]; }

    /// How far apart the lines through two edges pass, if these cross within the ring; 0 if not.
    double gap(const Ring& ring, const Edge& one, const Edge& other) const {
        std::array<std::ptrdiff_t, 4> at;
        for (std::size_t i = 0; i < 4; ++i)
            at[i] = std::ranges::find(ring, i < 2 ? one[i] : other[i - 2]) - ring.begin();
        const auto [low, high] = std::minmax(at[0], at[1]);
        const auto is_between = [low = low, high = high](std::ptrdiff_t i) { return low < i && i < high; };
        const auto is_end = [&](std::ptrdiff_t i) { return i == at[0] || i == at[1]; };
        if (is_end(at[2]) || is_end(at[3]) || is_between(at[2]) == is_between(at[3])) return 0;
        const Vec3 across = (position(one[1]) - position(one[0])) % (position(other[1]) - position(other[0]));
        const double area = across.norm();
        return area > 0 ? std::abs(across | (position(other[0]) - position(one[0]))) / area : 0;
    }

    /// Are the edges that go near those that come, and the diagonals of each quad near each other?
    bool keeps_surface(const Recut& way) const {
        const auto is_near = [&](const Edge& one, const Edge& other) {
            return gap(way.ring, one, other) <= 2 * tolerance_; // what lies midway is as near to both
        };
        for (const Edge& going : way.going)
            for (const Edge& coming : way.coming)
                if (!is_near(going, coming)) return false;
        return std::ranges::all_of(
            way.quads, [&](const Quad& q) { return is_near(edge_of(q[0], q[2]), edge_of(q[1], q[3])); });
    }

    bool keeps_manifold(const Recut& way) const {
        for (const Edge& edge : way.coming)
            if (edges_.contains(edge[0], edge[1])) return false;
        const auto ends = [](std::span<const Edge> edges, Index v) {
            return std::ranges::count_if(edges, [&](const Edge& e) { return e[0] == v || e[1] == v; });
        };
        return std::ranges::all_of(way.ring, [&](Index v) {
            const std::ptrdiff_t before = facets_at_[v],
                                 after = before + ends(way.coming, v) - ends(way.going, v);
            return after >= std::min<std::ptrdiff_t>(before, 3);
        });
    }

    double tolerance_;
    std::span<const VertexClass> classes_;
    const PolygonMesh& mesh_;
    EdgeSet edges_;
    std::vector<Index> facets_at_; // per vertex, how many
};

/// Leaves those of which no better one has a facet or an end of a changed edge.
void keep_first_ones(std::vector<Recut>& recuts) {
    std::ranges::sort(recuts, [](const Recut& a, const Recut& b) { return a.is_before(b); });
    std::vector<std::tuple<bool, Index, std::size_t>> claims; // of a facet or a vertex, its number, the recut
    for (std::size_t i = 0; i < recuts.size(); ++i) {
        for (const Index f : recuts[i].facets) claims.emplace_back(true, f, i);
        for (const auto* edges : {&recuts[i].going, &recuts[i].coming})
            for (const Edge& edge : *edges)
                for (const Index v : edge) claims.emplace_back(false, v, i);
    }
    std::ranges::sort(claims);
    std::vector<std::uint8_t> is_later(recuts.size(), 0);
    for (std::size_t i = 1; i < claims.size(); ++i) {
        const auto& [kind, number, recut] = claims[i];
        const auto& [last_kind, last_number, last] = claims[i - 1];
        if (kind == last_kind && number == last_number && recut != last) is_later[recut] = 1;
    }
    std::size_t i = 0;
    std::erase_if(recuts, [&](const Recut&) { return is_later[i++] != 0; });
}

/// The quads of each stand where its first facet was.
std::size_t replace_facets(std::span<const Recut> recuts, PolygonMesh& mesh) {
    constexpr Index stays = no_index, goes = no_index - 1;
    std::vector<Index> fate(mesh.facet_count(), stays);
    std::size_t count = 0;
    for (std::size_t i = 0; i < recuts.size(); ++i) {
        for (const Index f : recuts[i].facets) fate[f] = goes;
        fate[std::ranges::min(recuts[i].facets)] = static_cast<Index>(i);
        count += recuts[i].facets.size();
    }
    PolygonMesh kept;
    reserve_large(kept.corners, mesh.corners.size());
    reserve_large(kept.first, mesh.first.size() + count);
    for_each_in_order(mesh.facet_count(), [&](std::size_t f) {
        if (fate[f] == stays) kept.add_facet(mesh.facet(f));
        if (fate[f] == stays || fate[f] == goes) return;
        for (Quad quad : recuts[fate[f]].quads) {
            if (recuts[fate[f]].is_turned) std::reverse(quad.begin() + 1, quad.end());
            kept.add_facet(quad);
        }
    });
    mesh.corners = std::move(kept.corners);
    mesh.first = std::move(kept.first);
    return count;
}

} // namespace

std::size_t recut_odd_facets(double tolerance, std::span<const VertexClass> classes, PolygonMesh& mesh) {
    std::size_t count = 0;
    for (int round = 0; round < repeats::few; ++round) {
        std::vector<Recut> recuts = Neighbours(mesh).unions();
        if (recuts.empty()) break;
        const Cutter cutter(tolerance, classes, mesh, recuts);
        std::vector<std::uint8_t> is_cut(recuts.size());
        for_each_index(recuts.size(), chunks::heavy,
                       [&](Index i) { is_cut[i] = static_cast<std::uint8_t>(cutter.cut(recuts[i])); });
        std::size_t i = 0;
        std::erase_if(recuts, [&](const Recut&) { return is_cut[i++] == 0; });
        if (recuts.empty()) break;
        keep_first_ones(recuts);
        count += replace_facets(recuts, mesh);
    }
    return count;
}

} // namespace hsdm
