#include "hsdm/mesh/straight_corners.hh"

#include "hsdm/core/chunks.hh"
#include "hsdm/mesh/area_vector.hh"
#include "hsdm/mesh/constants.hh"
#include "hsdm/mesh/corner_pairs.hh"
#include "hsdm/mesh/edge_set.hh"
#include "hsdm/mesh/facet_unions.hh"

#include <algorithm>
#include <array>
#include <cmath>

namespace hsdm {
namespace {

/// The corner of a quad with the least sine, and that sine.
std::pair<std::size_t, double> straightest(const PolygonMesh& mesh, std::span<const Index> quad) {
    std::array<Vec3, 4> p;
    for (std::size_t i = 0; i < 4; ++i) p[i] = mesh.positions[quad[i]];
    const Vec3 up = unit(area_vector(p));
    std::pair<std::size_t, double> result{0, 1};
    for (std::size_t i = 0; i < 4; ++i) {
        if (((p[(i + 1) % 4] - p[i]) | (p[(i + 3) % 4] - p[i])) >= 0)
            continue; // sharp ones are not cut in two
        const double sine = corner_sine(p, i, up);
        if (sine < result.second) result = {i, sine};
    }
    return result;
}

/// A quad to be cut at a corner.
struct Cut {
    VertexPair diagonal;
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
                cuts.push_back({pair_of(quad[corner], quad[(corner + 2) % 4]), f, corner});
        }
    };
    return collected<Cut>(mesh.facet_count(), chunks::usual, find);
}

std::vector<Index> ends_of(std::span<const Cut> cuts) {
    std::vector<Index> ends;
    ends.reserve(2 * cuts.size());
    for (const Cut& cut : cuts) ends.insert(ends.end(), cut.diagonal.begin(), cut.diagonal.end());
    return ends;
}

/// Makes the cuts; returns how many.
std::size_t make(std::span<const Cut> cuts, PolygonMesh& mesh) {
    FacetUnions made(mesh);
    for (const Cut& cut : cuts) {
        const auto ring = mesh.facet(cut.facet);
        const auto at = [&](std::size_t i) { return ring[(cut.corner + i) % 4]; };
        made.replace(std::array{static_cast<Index>(cut.facet)},
                     {{at(0), at(1), at(2)}, {at(0), at(2), at(3)}});
    }
    return made.apply(mesh);
}

/// Removes the cuts whose diagonal is an edge already or that of a facet before; leaves them by facet.
void keep_allowed(const PolygonMesh& mesh, std::vector<Cut>& due) {
    if (due.empty()) return;
    const EdgeSet edges(mesh, ends_of(due));
    std::sort(due.begin(), due.end(), [](const Cut& a, const Cut& b) {
        return a.diagonal != b.diagonal ? a.diagonal < b.diagonal : a.facet < b.facet;
    });
    const auto same = [](const Cut& a, const Cut& b) { return a.diagonal == b.diagonal; };
    due.erase(std::unique(due.begin(), due.end(), same), due.end());
    std::erase_if(due, [&](const Cut& cut) { return edges.contains(cut.diagonal[0], cut.diagonal[1]); });
    std::sort(due.begin(), due.end(), [](const Cut& a, const Cut& b) { return a.facet < b.facet; });
}

} // namespace

std::size_t cut_straight_corners(PolygonMesh& mesh, double least_sine) {
    const auto is_due = [&](std::span<const Index>, std::size_t, double sine) { return sine < least_sine; };
    std::vector<Cut> due = possible_cuts(mesh, is_due);
    keep_allowed(mesh, due);
    return make(due, mesh);
}

std::size_t cut_doubtful_quads(PolygonMesh& mesh) {
    const auto is_doubtful = [&](std::span<const Index> quad, std::size_t corner, double sine) {
        const auto diagonal = [&](std::size_t from) {
            return (mesh.positions[quad[(from + 2) % 4]] - mesh.positions[quad[from % 4]]).sqrnorm();
        };
        return std::abs(sine) < quad_splitting::straight
               && diagonal(corner + 1) < (1 + quad_splitting::straight) * diagonal(corner);
    };
    std::vector<Cut> due = possible_cuts(mesh, is_doubtful);
    if (due.empty()) return 0;
    const CornerPairs pairs(mesh, ends_of(due));
    std::erase_if(due, [&](const Cut& cut) {
        return pairs.are_together(cut.diagonal, std::array{static_cast<Index>(cut.facet)});
    });
    return make(due, mesh);
}

} // namespace hsdm
