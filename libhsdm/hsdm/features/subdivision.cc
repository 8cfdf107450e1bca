#include "hsdm/features/subdivision.hh"

#include "hsdm/core/check_option.hh"
#include "hsdm/core/chunks.hh"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

namespace hsdm {
namespace {

constexpr int most_subdivisions = 10;

/// Where the points of a refined mesh come to lie.
class Masks {
public:
    Masks(const HalfEdges& mesh, const std::vector<CurveRole>& roles, bool triangles)
        : mesh_(mesh), roles_(roles), triangles_(triangles) {}

    Vec3 of_facet(Index f) const {
        const Vec3 first = mesh_.positions[mesh_.to[mesh_.side[f]]];
        Vec3 sum(0, 0, 0);
        int corners = 0;
        mesh_.for_each_side(f, [&](Index h) {
            sum += mesh_.positions[mesh_.to[h]] - first;
            ++corners;
        });
        return first + sum / corners;
    }

    Vec3 of_edge(Index e, const std::vector<Vec3>& facet_points) const {
        const Vec3 a = mesh_.positions[mesh_.from(2 * e)];
        const Vec3 along = mesh_.positions[mesh_.to[2 * e]] - a;
        if (mesh_.is_curve(e)) return a + along * 0.5;
        Vec3 across(0, 0, 0);
        for (const Index h : {2 * e, 2 * e + 1})
            across +=
                (triangles_ ? mesh_.positions[mesh_.to[mesh_.next[h]]] : facet_points[mesh_.facet[h]]) - a;
        return triangles_ ? a + along * 0.375 + across * 0.125 : a + (along + across) * 0.25;
    }

    Vec3 of_vertex(Index v, const std::vector<Vec3>& facet_points) const {
        if (mesh_.out[v] == no_index || roles_[v] == CurveRole::corner) return mesh_.positions[v];
        if (roles_[v] == CurveRole::crease) return on_curve(v);
        return triangles_ ? inside_triangles(v) : inside_polygons(v, facet_points);
    }

private:
    Vec3 on_curve(Index v) const {
        const Vec3 place = mesh_.positions[v];
        Vec3 sum(0, 0, 0);
        mesh_.for_each_spoke(v, [&](Index h) {
            if (mesh_.is_curve(h / 2)) sum += mesh_.positions[mesh_.to[h]] - place;
        });
        return place + sum * 0.125;
    }

    Vec3 inside_triangles(Index v) const {
        const Vec3 place = mesh_.positions[v];
        Vec3 sum(0, 0, 0);
        int valence = 0;
        mesh_.for_each_spoke(v, [&](Index h) {
            sum += mesh_.positions[mesh_.to[h]] - place;
            ++valence;
        });
        const double ring = 0.375 + 0.25 * std::cos(2 * std::numbers::pi / valence);
        return place + sum * ((0.625 - ring * ring) / valence);
    }

    Vec3 inside_polygons(Index v, const std::vector<Vec3>& facet_points) const {
        const Vec3 place = mesh_.positions[v];
        Vec3 sum(0, 0, 0);
        int valence = 0;
        mesh_.for_each_spoke(v, [&](Index h) {
            sum += mesh_.positions[mesh_.to[h]] - place;
            sum += facet_points[mesh_.facet[h]] - place;
            ++valence;
        });
        return place + sum / (double(valence) * valence);
    }

    const HalfEdges& mesh_;
    const std::vector<CurveRole>& roles_;
    bool triangles_;
};

/// The links of a refined mesh, by arithmetic on the numbers of what there was.
class RefinedLinks {
public:
    RefinedLinks(const HalfEdges& old, bool triangles)
        : old_(old),
          vertices_(static_cast<Index>(old.vertex_count())),
          edges_(static_cast<Index>(old.edge_count())),
          facets_(static_cast<Index>(old.facet_count())),
          first_(old.facet_count() + 1, 0),
          triangles_(triangles) {
        for_each_index(facets_, chunks::usual,
                       [&](Index f) { old.for_each_side(f, [&](Index) { ++first_[f + 1]; }); });
        counts_to_first(first_);
    }

    Refinement build() {
        HalfEdges& mesh = refined_.mesh;
        const Index corners = first_.back(), inner = 2 * edges_ + corners;
        const Index vertices = vertices_ + edges_ + (triangles_ ? 0 : facets_);
        const Index facets = triangles_ ? facets_ + corners : corners;
        mesh.positions.resize(vertices);
        mesh.pins.assign(vertices, Pin::none);
        mesh.out.assign(vertices, no_index);
        for (auto* array : {&mesh.to, &mesh.next, &mesh.facet})
            array->assign(2 * std::size_t{inner}, no_index);
        mesh.side.resize(facets);
        mesh.marked.assign(inner, 0);
        refined_.parent.resize(facets);
        for_each_index(edges_, chunks::usual, [&](Index e) { split_edge(e); });
        for_each_index(facets_, chunks::usual,
                       [&](Index f) { triangles_ ? cut_triangle(f) : cut_polygon(f); });
        for_each_index(vertices_, chunks::usual, [&](Index v) {
            mesh.pins[v] = old_.pins[v];
            if (old_.out[v] != no_index) mesh.out[v] = first_half(old_.out[v]);
        });
        return std::move(refined_);
    }

private:
    /// The halves of half-edge h, in its direction.
    Index first_half(Index h) const { return h % 2 == 0 ? h : 2 * edges_ + h; }
    Index second_half(Index h) const { return h % 2 == 0 ? 2 * edges_ + h : h; }
    Index middle(Index h) const { return vertices_ + h / 2; }

    void split_edge(Index e) {
        HalfEdges& mesh = refined_.mesh;
        mesh.marked[e] = mesh.marked[edges_ + e] = old_.marked[e];
        for (const Index h : {2 * e, 2 * e + 1}) {
            mesh.to[first_half(h)] = middle(h);
            mesh.to[second_half(h)] = old_.to[h];
            if (old_.facet[h] != no_index) continue;
            mesh.next[first_half(h)] = second_half(h);
            mesh.next[second_half(h)] = first_half(old_.next[h]);
        }
        // OpenMesh has a boundary vertex's half-edge on the boundary.
        mesh.out[middle(2 * e)] = second_half(old_.facet[2 * e] == no_index ? 2 * e : 2 * e + 1);
    }

    /// A facet from half-edges in order.
    template <std::size_t n>
    void close(Index facet, Index parent, const std::array<Index, n>& ring) {
        for (std::size_t i = 0; i < n; ++i) {
            refined_.mesh.next[ring[i]] = ring[(i + 1) % n];
            refined_.mesh.facet[ring[i]] = facet;
        }
        refined_.mesh.side[facet] = ring[0];
        refined_.parent[facet] = parent;
    }

    /// Three corners come off; what is left in the middle keeps the number.
    void cut_triangle(Index f) {
        std::array<Index, 3> inner{};
        Index before = old_.next[old_.next[old_.side[f]]], i = 0;
        old_.for_each_side(f, [&](Index h) {
            const Index cut = 2 * (2 * edges_ + first_[f] + i);
            refined_.mesh.to[cut] = middle(before);
            refined_.mesh.to[cut + 1] = middle(h);
            close<3>(facets_ + first_[f] + i, f, {second_half(before), first_half(h), cut});
            inner[i++] = cut + 1;
            before = h;
        });
        close(f, f, inner);
    }

    /// A quad at each corner, between the middles of its two sides and the facet's point.
    void cut_polygon(Index f) {
        const Index centre = vertices_ + edges_ + f, base = 2 * edges_ + first_[f];
        const Index corners = first_[f + 1] - first_[f];
        Index before = old_.side[f];
        while (old_.next[before] != old_.side[f]) before = old_.next[before];
        Index i = 0;
        old_.for_each_side(f, [&](Index h) {
            const Index spoke = 2 * (base + i), last = 2 * (base + (i + corners - 1) % corners);
            refined_.mesh.to[spoke] = centre;
            refined_.mesh.to[spoke + 1] = middle(h);
            const Index quad = i == 0 ? f : facets_ + (first_[f] - f) + i - 1;
            close<4>(quad, f, {second_half(before), first_half(h), spoke, last + 1});
            before = h;
            ++i;
        });
        refined_.mesh.out[centre] = 2 * base + 1;
    }

    const HalfEdges& old_;
    Index vertices_, edges_, facets_;
    std::vector<Index> first_; ///< per facet: where its corners begin among all
    bool triangles_;
    Refinement refined_;
};

bool all_triangles(const HalfEdges& mesh, Index& other) {
    const auto is_other = [&](Index f) {
        return mesh.side[f] != no_index && mesh.next[mesh.next[mesh.next[mesh.side[f]]]] != mesh.side[f];
    };
    const std::vector<Index> others = indices_where(mesh.facet_count(), chunks::quick, is_other);
    if (!others.empty()) other = others.front();
    return others.empty();
}

} // namespace

void validate(const SubdivisionOptions& options) {
    check_option(options.rounds >= 0 && options.rounds <= most_subdivisions, "rounds", options.rounds,
                 "lie in [0, " + std::to_string(most_subdivisions) + "]");
    check_option(options.corner_angle > 0 && options.corner_angle < std::numbers::pi, "corner_angle",
                 options.corner_angle, "lie in (0, pi), in radians");
}

std::string_view name_of(SubdivisionScheme scheme) {
    switch (scheme) {
    case SubdivisionScheme::loop:
        return "loop";
    case SubdivisionScheme::catmull_clark:
        return "catmull-clark";
    case SubdivisionScheme::automatic:
        break;
    }
    return "auto";
}

SubdivisionScheme scheme_for(const HalfEdges& mesh, SubdivisionScheme asked) {
    if (asked == SubdivisionScheme::catmull_clark) return asked;
    Index other = no_index;
    if (all_triangles(mesh, other)) return SubdivisionScheme::loop;
    if (asked == SubdivisionScheme::loop)
        throw OptionError("scheme loop: facet " + std::to_string(other)
                          + " is no triangle; triangulate first, or take catmull-clark");
    return SubdivisionScheme::catmull_clark;
}

void check_numbers(const HalfEdges& mesh, int rounds) {
    std::uint64_t edges = mesh.edge_count();
    auto corners =
        static_cast<std::uint64_t>(std::ranges::count_if(mesh.facet, [](Index f) { return f != no_index; }));
    for (int round = 0; round < rounds; ++round, corners *= 4) edges = 2 * edges + corners;
    if (2 * edges > static_cast<std::uint64_t>(std::numeric_limits<int>::max()))
        throw OptionError("rounds " + std::to_string(rounds) + ": the mesh would have "
                          + std::to_string(2 * edges)
                          + " half-edges, more than OpenMesh can number; ask for fewer");
}

Refinement refined(const HalfEdges& mesh, const std::vector<CurveRole>& roles, SubdivisionScheme scheme) {
    const bool triangles = scheme == SubdivisionScheme::loop;
    Refinement refinement = RefinedLinks(mesh, triangles).build();
    std::vector<Vec3>& points = refinement.mesh.positions;
    const Masks masks(mesh, roles, triangles);
    std::vector<Vec3> facet_points(triangles ? 0 : mesh.facet_count());
    for_each_index(facet_points.size(), chunks::usual, [&](Index f) { facet_points[f] = masks.of_facet(f); });
    for_each_index(mesh.edge_count(), chunks::usual,
                   [&](Index e) { points[mesh.vertex_count() + e] = masks.of_edge(e, facet_points); });
    for_each_index(mesh.vertex_count(), chunks::usual,
                   [&](Index v) { points[v] = masks.of_vertex(v, facet_points); });
    std::copy(facet_points.begin(), facet_points.end(),
              points.begin() + static_cast<std::ptrdiff_t>(mesh.vertex_count() + mesh.edge_count()));
    return refinement;
}

} // namespace hsdm
