#include "hsdm/facets/straight_corners.hh"

#include "hsdm/facets/area_vector.hh"

#include <algorithm>
#include <array>

namespace hsdm {
namespace {

using Edge = std::array<Index, 2>; // the lower vertex first

Edge edge(Index a, Index b) {
    return {std::min(a, b), std::max(a, b)};
}

/// The corner of a quad with the least sine, and that sine.
std::pair<std::size_t, double> straightest(const PolygonMesh& mesh, std::span<const Index> quad) {
    const Vec3 up = unit(area_vector(mesh, quad));
    std::pair<std::size_t, double> result{0, 1};
    for (std::size_t i = 0; i < 4; ++i) {
        const Vec3& p = mesh.positions[quad[i]];
        const Vec3 a = mesh.positions[quad[(i + 1) % 4]] - p, b = mesh.positions[quad[(i + 3) % 4]] - p;
        const double sides = a.norm() * b.norm();
        const double sine = sides > 0 ? ((a % b) | up) / sides : 1;
        if (sine < result.second && (a | b) < 0) result = {i, sine}; // a sharp corner is not cut in two
    }
    return result;
}

/// Of some possible new edges, those that facets have already, in order.
std::vector<Edge> taken(const PolygonMesh& mesh, const std::vector<Edge>& possible) {
    std::vector<std::uint8_t> met(mesh.vertex_count(), 0);
    for (const Edge& e : possible) met[e[0]] = met[e[1]] = 1;
    std::vector<Edge> edges;
    for (std::size_t f = 0; f < mesh.facet_count(); ++f) {
        const auto ring = mesh.facet(f);
        for (std::size_t i = 0; i < ring.size(); ++i) {
            const Index a = ring[i], b = ring[(i + 1) % ring.size()];
            if (met[a] && met[b]) edges.push_back(edge(a, b));
        }
    }
    std::sort(edges.begin(), edges.end());
    return edges;
}

} // namespace

std::size_t cut_straight_corners(PolygonMesh& mesh, double least_sine) {
    std::vector<std::pair<std::size_t, std::size_t>> due; // facet, corner
    std::vector<Edge> diagonals;
    for (std::size_t f = 0; f < mesh.facet_count(); ++f) {
        const auto quad = mesh.facet(f);
        if (quad.size() != 4) continue;
        const auto [corner, sine] = straightest(mesh, quad);
        if (sine >= least_sine) continue;
        due.emplace_back(f, corner);
        diagonals.push_back(edge(quad[corner], quad[(corner + 2) % 4]));
    }
    if (due.empty()) return 0;
    std::vector<Edge> edges = taken(mesh, diagonals);
    PolygonMesh cut;
    std::size_t next = 0, count = 0;
    for (std::size_t f = 0; f < mesh.facet_count(); ++f) {
        const auto ring = mesh.facet(f);
        const std::size_t d = next;
        if (d == due.size() || due[d].first != f) {
            cut.add_facet(ring);
            continue;
        }
        ++next;
        const auto at = std::lower_bound(edges.begin(), edges.end(), diagonals[d]);
        if (at != edges.end() && *at == diagonals[d]) {
            cut.add_facet(ring);
            continue;
        }
        edges.insert(at, diagonals[d]);
        const std::size_t i = due[d].second;
        cut.add_facet(std::array{ring[i], ring[(i + 1) % 4], ring[(i + 2) % 4]});
        cut.add_facet(std::array{ring[i], ring[(i + 2) % 4], ring[(i + 3) % 4]});
        ++count;
    }
    mesh.corners = std::move(cut.corners);
    mesh.first = std::move(cut.first);
    return count;
}

} // namespace hsdm
