#include "hsdm/mesh/straight_corners.hh"

#include "hsdm/core/chunks.hh"
#include "hsdm/mesh/area_vector.hh"
#include "hsdm/mesh/constants.hh"
#include "hsdm/mesh/edge_set.hh"

#include <algorithm>
#include <array>
#include <cmath>

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

/// A quad to be cut at a corner.
struct Cut {
    Edge diagonal;
    std::size_t facet, corner;
};

/// is_due(quad, corner, sine): of its straightest corner.
template <class Test>
std::vector<Cut> possible_cuts(const PolygonMesh& mesh, const Test& is_due) {
    const auto find = [&](std::size_t f, std::size_t end, std::vector<Cut>& cuts) {
        for (; f < end; ++f) {
            const auto quad = mesh.facet(f);
            if (quad.size() != 4) continue;
            const auto [corner, sine] = straightest(mesh, quad);
            if (is_due(quad, corner, sine))
                cuts.push_back({edge(quad[corner], quad[(corner + 2) % 4]), f, corner});
        }
    };
    return collected<Cut>(mesh.facet_count(), chunks::usual, find);
}

/// Removes the cuts whose diagonal is an edge already or that of a facet before; leaves them by facet.
void keep_allowed(const PolygonMesh& mesh, std::vector<Cut>& due) {
    if (due.empty()) return;
    std::vector<Index> ends;
    for (const Cut& cut : due) ends.insert(ends.end(), cut.diagonal.begin(), cut.diagonal.end());
    const EdgeSet edges(mesh, ends);
    std::sort(due.begin(), due.end(), [](const Cut& a, const Cut& b) {
        return a.diagonal != b.diagonal ? a.diagonal < b.diagonal : a.facet < b.facet;
    });
    const auto same = [](const Cut& a, const Cut& b) { return a.diagonal == b.diagonal; };
    due.erase(std::unique(due.begin(), due.end(), same), due.end());
    std::erase_if(due, [&](const Cut& cut) { return edges.contains(cut.diagonal[0], cut.diagonal[1]); });
    std::sort(due.begin(), due.end(), [](const Cut& a, const Cut& b) { return a.facet < b.facet; });
}

/// Makes those that are allowed; returns how many.
std::size_t make(std::vector<Cut> due, PolygonMesh& mesh) {
    keep_allowed(mesh, due);
    if (due.empty()) return 0;
    PolygonMesh cut;
    auto next = due.begin();
    for (std::size_t f = 0; f < mesh.facet_count(); ++f) {
        const auto ring = mesh.facet(f);
        if (next == due.end() || next->facet != f) {
            cut.add_facet(ring);
            continue;
        }
        const std::size_t i = next++->corner;
        cut.add_facet(std::array{ring[i], ring[(i + 1) % 4], ring[(i + 2) % 4]});
        cut.add_facet(std::array{ring[i], ring[(i + 2) % 4], ring[(i + 3) % 4]});
    }
    mesh.corners = std::move(cut.corners);
    mesh.first = std::move(cut.first);
    return due.size();
}

} // namespace

std::size_t cut_straight_corners(PolygonMesh& mesh, double least_sine) {
    return make(possible_cuts(mesh, [&](std::span<const Index>, std::size_t,
                                        double sine) { return sine < least_sine; }),
                mesh);
}

std::size_t cut_doubtful_quads(PolygonMesh& mesh) {
    const auto is_doubtful = [&](std::span<const Index> quad, std::size_t corner, double sine) {
        const auto diagonal = [&](std::size_t from) {
            return (mesh.positions[quad[(from + 2) % 4]] - mesh.positions[quad[from % 4]]).sqrnorm();
        };
        return std::abs(sine) < quad_splitting::straight
               && diagonal(corner + 1) < (1 + quad_splitting::straight) * diagonal(corner);
    };
    return make(possible_cuts(mesh, is_doubtful), mesh);
}

} // namespace hsdm
