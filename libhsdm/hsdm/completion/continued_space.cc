#include "hsdm/completion/continued_space.hh"

#include "hsdm/completion/constants.hh"
#include "hsdm/completion/continued_walls.hh"
#include "hsdm/contour/minimum_cut.hh"
#include "hsdm/core/chunks.hh"
#include "hsdm/core/disjoint_sets.hh"
#include "hsdm/core/parallel_sort.hh"

#include <algorithm>
#include <cmath>
#include <utility>

namespace hsdm {
namespace {

/// Walls that pass an edge of the lattice facing up its axis, or down.
enum Facing : std::uint8_t { up = 1, down = 2 };

LatticePlace place_for(const PolygonMesh& mesh, double voxel_size) {
    Box box;
    for (const Vec3& p : mesh.positions) box.add(p);
    LatticePlace place;
    place.spacing = std::max(voxel_size, box.extent() / continuing::most_cells);
    for (unsigned k = 0; k < 3; ++k) {
        const double cells = std::ceil(box.size()[k] / place.spacing) + 3;
        place.last[k] = static_cast<int>(cells);
        // No plane of the lattice passes the box's own faces, where those of a part often lie.
        place.origin[k] = 0.5 * (box.lo[k] + box.hi[k]) - 0.5 * (cells - 0.1236) * place.spacing;
    }
    return place;
}

/// How the surface between an edge's lower point and its upper one faces, of which one lies outside.
Facing facing_between(bool lower_is_outside) {
    return lower_is_outside ? down : up;
}

/// Per edge, which walls pass there of which others that come from the far end pass it or one beside it.
std::vector<std::uint8_t> confirmed_walls(const Lattice& lattice, const PolygonMesh& mesh,
                                          const BoundaryLoops& border, double voxel_size) {
    std::vector<std::uint8_t> along(3 * lattice.size()), against(along.size()), result(along.size());
    for_each_continued_wall(mesh, border, voxel_size, [&](const PolygonMesh& walls, bool is_along) {
        for (const LatticeHit& hit : find_hits(lattice, walls))
            if (const double d = hit.normal[hit.edge % 3]; d != 0)
                (is_along ? along : against)[hit.edge] |= facing_between(d < 0);
    });
    for_each_index(result.size(), chunks::light, [&](std::size_t e) {
        if ((along[e] | against[e]) == 0) return;
        unsigned one = along[e], other = against[e];
        for (const Index k : lattice.next[e / 3]) {
            if (k == no_index) continue;
            one |= along[3 * std::size_t{k} + e % 3];
            other |= against[3 * std::size_t{k} + e % 3];
        }
        result[e] = static_cast<std::uint8_t>(one & other & (along[e] | against[e]));
    });
    return result;
}

/// Which side grid points are known to lie on: 1 outside, -1 inside, 0 unknown.
std::vector<std::int8_t> known_sides(const Lattice& lattice) {
    std::vector<std::int8_t> side(lattice.size());
    std::vector<double> nearest(lattice.size(), Box::inf);
    for_each_index(lattice.size(), chunks::light, [&](Index i) {
        side[i] = std::ranges::find(lattice.next[i], no_index) != lattice.next[i].end() ? 1 : 0;
    });
    for_each_beside(lattice, [&](Index point, double distance) {
        if (std::abs(distance) >= nearest[point]) return;
        nearest[point] = std::abs(distance);
        side[point] = distance < 0 ? -1 : 1;
    });
    return side;
}

/// Visits the edges that the mesh does not pass: visit(edge, lower point, upper point).
template <class Visit>
void for_each_free_edge(const Lattice& lattice, const Visit& visit) {
    for (std::size_t e = 0; e < 3 * lattice.size(); ++e) {
        const Index lower = static_cast<Index>(e / 3), upper = lattice.next[lower][e % 3];
        if (upper != no_index && lattice.on_edge(e).empty()) visit(e, lower, upper);
    }
}

/// The least surface between what is known to be inside and outside: per grid point, is it outside? Surfaces
/// along walls cost `continuing::wall_cost` of their area.
std::vector<std::uint8_t> least_surface(const Lattice& lattice, const std::vector<std::int8_t>& side,
                                        const std::vector<std::uint8_t>& walls) {
    const std::vector<Index> unknown =
        indices_where(lattice.size(), chunks::light, [&](Index i) { return side[i] == 0; });
    std::vector<Index> number(lattice.size(), no_index);
    for (std::size_t i = 0; i < unknown.size(); ++i) number[unknown[i]] = static_cast<Index>(i);
    LabelCosts costs(unknown.size()); // label 1: outside
    for_each_free_edge(lattice, [&](std::size_t e, Index a, Index b) {
        const auto cost = [&](Facing facing) { return (walls[e] & facing) != 0 ? continuing::wall_cost : 1; };
        if (side[a] == 0 && side[b] == 0)
            costs.add(number[a], number[b], {{{0, cost(up)}, {cost(down), 0}}});
        else if (side[a] == 0)
            costs.add(number[a], side[b] > 0 ? cost(up) : 0, side[b] < 0 ? cost(down) : 0);
        else if (side[b] == 0)
            costs.add(number[b], side[a] > 0 ? cost(down) : 0, side[a] < 0 ? cost(up) : 0);
    });
    const std::vector<std::uint8_t> labels = cheapest_labels(costs);
    std::vector<std::uint8_t> outside(lattice.size());
    for_each_index(outside.size(), chunks::light,
                   [&](Index i) { outside[i] = side[i] == 0 ? labels[number[i]] : side[i] > 0; });
    return outside;
}

/// A connected part of what opens, in grid points and edges.
struct OpenedPart {
    double points = 0;
    double lids = 0;              ///< of the least surface without walls, which it takes away
    double walls = 0, others = 0; ///< what bounds it in their place

    bool is_evident() const { return points >= continuing::least_depth * lids && walls > others; }
};

/// Leaves open what is deep behind its lids and bounded by walls, most of it, in each connected part; is
/// there any?
bool keep_evident(const Lattice& lattice, const std::vector<std::uint8_t>& closed,
                  const std::vector<std::uint8_t>& walls, std::vector<std::uint8_t>& open) {
    const std::vector<std::uint8_t> all = open;
    const auto opens = [&](Index i) { return all[i] > closed[i]; };
    DisjointSets sets(lattice.size());
    std::vector<OpenedPart> parts(lattice.size());
    for_each_free_edge(lattice, [&](std::size_t, Index a, Index b) {
        if (opens(a) && opens(b)) sets.join(a, b);
    });
    for_each_free_edge(lattice, [&](std::size_t e, Index a, Index b) {
        if (opens(a) == opens(b)) return;
        const auto [inner, other] = opens(a) ? std::pair(a, b) : std::pair(b, a);
        OpenedPart& part = parts[sets.find(inner)];
        const bool on_wall = (walls[e] & facing_between(inner == a)) != 0;
        ++(all[other] != 0 ? part.lids : on_wall ? part.walls : part.others);
    });
    for (Index i = 0; i < lattice.size(); ++i) parts[sets.find(i)].points += opens(i);
    bool any = false;
    for (Index i = 0; i < lattice.size(); ++i) {
        if (!opens(i)) continue;
        open[i] = parts[sets.find(i)].is_evident();
        any = any || open[i] != 0;
    }
    return any;
}

std::size_t number_of(const LatticePlace& place, const VoxelCoord& c) {
    const auto size = [&](unsigned k) { return static_cast<std::size_t>(place.last[k]); };
    return static_cast<std::size_t>(c[0])
           + size(0) * (static_cast<std::size_t>(c[1]) + size(1) * static_cast<std::size_t>(c[2]));
}

} // namespace

ContinuedSpace::ContinuedSpace(const PolygonMesh& mesh, const BoundaryLoops& border, double voxel_size)
    : place_(place_for(mesh, voxel_size)) {
    const Lattice lattice = build_lattice(place_, all_points(place_), mesh);
    const std::vector<std::uint8_t> walls = confirmed_walls(lattice, mesh, border, voxel_size);
    if (std::ranges::count(walls, 0) == std::ssize(walls)) return;
    const std::vector<std::int8_t> side = known_sides(lattice);
    const std::vector<std::uint8_t> none(walls.size()), closed = least_surface(lattice, side, none);
    std::vector<std::uint8_t> open = least_surface(lattice, side, walls);
    if (keep_evident(lattice, closed, walls, open)) take_cells(lattice, open, closed);
}

void ContinuedSpace::take_cells(const Lattice& lattice, const std::vector<std::uint8_t>& open,
                                const std::vector<std::uint8_t>& closed) {
    const VoxelCoord& last = place_.last;
    outside_.assign(number_of(place_, {0, 0, last[2]}), 1);
    continued_.assign(outside_.size(), 0);
    const auto around = [&](Index point, unsigned but, const auto& visit) {
        for (unsigned corner = 0; corner < 8; ++corner) {
            if (but < 3 && (corner >> but & 1) != 0) continue;
            VoxelCoord cell = lattice.coord(point);
            bool is_cell = true;
            for (unsigned k = 0; k < 3; ++k) {
                cell[k] -= static_cast<int>(corner >> k & 1);
                is_cell = is_cell && cell[k] >= 0 && cell[k] < last[k];
            }
            if (is_cell) visit(number_of(place_, cell));
        }
    };
    for (Index i = 0; i < lattice.size(); ++i)
        around(i, 3, [&](std::size_t cell) {
            outside_[cell] &= open[i];
            continued_[cell] |= open[i] > closed[i];
        });
    // A wall thinner than a cell has all corners outside.
    for (const LatticeHit& hit : lattice.hits)
        around(hit.edge / 3, hit.edge % 3, [&](std::size_t cell) { outside_[cell] = 0; });
}

bool ContinuedSpace::holds(const Vec3& place) const {
    if (empty()) return false;
    const Vec3 x = place_.local(place);
    VoxelCoord cell;
    for (unsigned k = 0; k < 3; ++k) {
        if (!(x[k] >= 0 && x[k] < place_.last[k])) return false;
        cell[k] = static_cast<int>(x[k]);
    }
    const std::size_t at = number_of(place_, cell);
    return outside_[at] != 0 && continued_[at] != 0;
}

} // namespace hsdm
