#include "hsdm/contour/flat_corners.hh"

#include "hsdm/core/chunks.hh"
#include "hsdm/core/constants.hh"
#include "hsdm/mesh/area_vector.hh"
#include "hsdm/mesh/collapse_edges.hh"
#include "hsdm/mesh/constants.hh"
#include "hsdm/mesh/manifold.hh"

#include <algorithm>
#include <cstdint>
#include <tuple>

namespace hsdm {
namespace {

/// An edge with a triangle on either side, or the diagonal of a quad, that is to collapse.
struct FlatCorner {
    double length = 0; ///< squared
    Index from = no_index, to = no_index;
    std::array<Index, 2> facets{}; ///< that go; twice the same is a quad
    bool is_before(const FlatCorner& other) const {
        return std::tie(length, from, to) < std::tie(other.length, other.from, other.to);
    }
};

class FlatCornerSearch {
public:
    FlatCornerSearch(const PolygonMesh& mesh, std::span<const VertexClass> classes)
        : mesh_(mesh), classes_(classes) {}

    std::vector<FlatCorner> find() const {
        std::vector<FlatCorner> result = of_quads();
        const std::vector<TriangleSide> sides = triangle_sides();
        for (std::size_t i = 1; i < sides.size(); ++i) {
            const auto [a, b, f] = sides[i - 1];
            if (sides[i].lower == a && sides[i].upper == b) result.push_back(corner(a, b, f, sides[i].facet));
        }
        return result;
    }

private:
    /// A side of a triangle.
    struct TriangleSide {
        Index lower, upper, facet;
        auto operator<=>(const TriangleSide&) const = default;
    };

    VertexClass class_of(Index v) const { return classes_[mesh_.origin[v]]; }

    FlatCorner corner(Index a, Index b, Index f, Index g) const {
        const auto [from, to] = class_of(a) < class_of(b) ? std::pair(a, b) : std::pair(b, a);
        return {(mesh_.positions[a] - mesh_.positions[b]).sqrnorm(), from, to, {f, g}};
    }

    std::vector<FlatCorner> of_quads() const {
        return collected<FlatCorner>(
            mesh_.facet_count(), chunks::quick,
            [&](std::size_t begin, std::size_t end, std::vector<FlatCorner>& part) {
                for (std::size_t f = begin; f < end; ++f) {
                    const auto quad = mesh_.facet(f);
                    const auto number = static_cast<Index>(f);
                    for (std::size_t i = 0; i < 4 && quad.size() == 4; ++i)
                        if (class_of(quad[i]) > class_of(quad[(i + 2) % 4]) && is_flat_at(quad, i))
                            part.push_back(corner(quad[i], quad[(i + 2) % 4], number, number));
                }
            });
    }

    bool is_flat_at(std::span<const Index> quad, std::size_t corner) const {
        std::array<Vec3, 4> ring;
        for (std::size_t i = 0; i < 4; ++i) ring[i] = mesh_.positions[quad[i]];
        return corner_sine(ring, corner, unit(area_vector(ring))) < quad_splitting::least_corner;
    }

    /// Those whose ends are of different classes.
    std::vector<TriangleSide> triangle_sides() const {
        auto sides = collected<TriangleSide>(
            mesh_.facet_count(), chunks::quick,
            [&](std::size_t begin, std::size_t end, std::vector<TriangleSide>& part) {
                for (std::size_t f = begin; f < end; ++f) {
                    const auto facet = mesh_.facet(f);
                    for (std::size_t i = 0; i < 3 && facet.size() == 3; ++i) {
                        const Index a = facet[i], b = facet[(i + 1) % 3];
                        if (class_of(a) != class_of(b))
                            part.push_back({std::min(a, b), std::max(a, b), static_cast<Index>(f)});
                    }
                }
            });
        std::sort(sides.begin(), sides.end());
        return sides;
    }

    const PolygonMesh& mesh_;
    std::span<const VertexClass> classes_;
};

/// The facets round the vertices that are to go.
class FacetsRound {
public:
    FacetsRound(const PolygonMesh& mesh, std::span<const FlatCorner> corners) {
        std::vector<std::uint8_t> goes(mesh.vertex_count(), 0);
        for (const FlatCorner& c : corners) goes[c.from] = 1;
        pairs_ = collected<Pair>(mesh.facet_count(), chunks::quick,
                                 [&](std::size_t begin, std::size_t end, std::vector<Pair>& part) {
                                     for (std::size_t f = begin; f < end; ++f)
                                         for (const Index v : mesh.facet(f))
                                             if (goes[v]) part.push_back({v, static_cast<Index>(f)});
                                 });
        std::sort(pairs_.begin(), pairs_.end());
    }

    /// Pairs of the vertex and a facet, by ascending facets.
    std::span<const std::pair<Index, Index>> of(Index v) const {
        const auto [first, last] =
            std::equal_range(pairs_.begin(), pairs_.end(), Pair{v, 0},
                             [](const Pair& one, const Pair& other) { return one.first < other.first; });
        return {first, last};
    }

private:
    using Pair = std::pair<Index, Index>; // vertex, facet
    std::vector<Pair> pairs_;
};

/// Does the vertex move in the planes of the facets round it, and is none left with a corner too sharp or
/// blunt? One of a border stays: what is between the border and the crease would be lost.
bool may_go(const FlatCorner& c, const FacetsRound& facets, double tolerance, const PolygonMesh& mesh) {
    const Vec3 way = mesh.positions[c.to] - mesh.positions[c.from];
    std::vector<Vec3> ring;
    std::int64_t open = 0; // vertices before it less those after it: all of them go out if facets go round
    for (const auto& [v, f] : facets.of(c.from)) {
        const auto facet = mesh.facet(f);
        ring.clear();
        for (const Index u : facet) ring.push_back(mesh.positions[u]);
        if (std::abs(unit(area_vector(ring)) | way) > tolerance) return false;
        const auto at = static_cast<std::size_t>(std::ranges::find(facet, c.from) - facet.begin());
        open += std::int64_t{facet[(at + facet.size() - 1) % facet.size()]} - facet[(at + 1) % facet.size()];
        if (f == c.facets[0] || f == c.facets[1]) continue;
        ring[at] = mesh.positions[c.to];
        if (least_corner_sine(ring) <= quad_splitting::least_corner) return false;
    }
    return open == 0;
}

/// Those of which no shorter one has one of their facets.
std::vector<EdgeCollapse> first_ones(std::vector<FlatCorner>& corners, const FacetsRound& facets,
                                     const PolygonMesh& mesh) {
    std::ranges::sort(corners, [](const FlatCorner& a, const FlatCorner& b) { return a.is_before(b); });
    std::vector<std::pair<Index, Index>> of_facet; // facet, corner
    for (Index i = 0; i < corners.size(); ++i)
        for (const auto& [v, f] : facets.of(corners[i].from)) of_facet.push_back({f, i});
    std::ranges::sort(of_facet);
    std::vector<std::uint8_t> is_later(corners.size(), 0);
    for (std::size_t i = 1; i < of_facet.size(); ++i)
        if (of_facet[i].first == of_facet[i - 1].first) is_later[of_facet[i].second] = 1;
    std::vector<EdgeCollapse> result;
    for (std::size_t i = 0; i < corners.size(); ++i)
        if (!is_later[i]) result.push_back({corners[i].from, corners[i].to, mesh.positions[corners[i].to]});
    return result;
}

} // namespace

std::size_t collapse_flat_corners(double tolerance, std::span<const VertexClass> classes, PolygonMesh& mesh) {
    std::size_t count = 0;
    for (int round = 0; round < repeats::few; ++round) {
        std::vector<FlatCorner> corners = FlatCornerSearch(mesh, classes).find();
        if (corners.empty()) break;
        const FacetsRound facets(mesh, corners);
        std::erase_if(corners, [&](const FlatCorner& c) { return !may_go(c, facets, tolerance, mesh); });
        const std::vector<std::uint8_t> collapsed = collapse_edges(mesh, first_ones(corners, facets, mesh));
        const auto more = static_cast<std::size_t>(std::ranges::count(collapsed, 1));
        if (more == 0) break;
        count += more;
    }
    if (count > 0) remove_isolated_vertices(mesh);
    return count;
}

} // namespace hsdm
