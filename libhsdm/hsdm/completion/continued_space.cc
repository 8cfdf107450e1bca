#include "hsdm/completion/continued_space.hh"

#include "hsdm/completion/constants.hh"
#include "hsdm/completion/continued_walls.hh"
#include "hsdm/contour/minimum_cut.hh"
#include "hsdm/core/chunks.hh"
#include "hsdm/core/disjoint_sets.hh"
#include "hsdm/core/parallel_sort.hh"

#include <algorithm>
#include <cmath>
#include <ranges>

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

std::vector<std::uint8_t> facing_on_edges(const Lattice& lattice, const PolygonMesh& walls) {
    const Lattice across = build_lattice(lattice.place, lattice.codes, walls);
    std::vector<std::uint8_t> facing(3 * lattice.size());
    for (const LatticeHit& hit : across.hits)
        if (const double d = hit.normal[hit.edge % 3]; d != 0) facing[hit.edge] |= d > 0 ? up : down;
    return facing;
}

/// Per edge, which walls pass there of which others that come from the far end pass it or one beside it.
std::vector<std::uint8_t> confirmed(const Lattice& lattice, const ContinuedWalls& walls) {
    const std::vector<std::uint8_t> along = facing_on_edges(lattice, walls.along),
                                    against = facing_on_edges(lattice, walls.against);
    std::vector<std::uint8_t> result(along.size());
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
        side[i] = std::ranges::find(lattice.next[i], no_index) != lattice.next[i].end();
    });
    for_each_beside(lattice, [&](Index point, double distance) {
        if (std::abs(distance) >= nearest[point]) return;
        nearest[point] = std::abs(distance);
        side[point] = distance < 0 ? -1 : 1;
    });
    return side;
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
    for (std::size_t e = 0; e < 3 * lattice.size(); ++e) {
        const Index a = static_cast<Index>(e / 3), b = lattice.next[a][e % 3];
        if (b == no_index || (side[a] != 0 && side[b] != 0) || !lattice.on_edge(e).empty()) continue;
        const auto cost = [&](Facing facing) { return (walls[e] & facing) != 0 ? continuing::wall_cost : 1; };
        if (side[a] == 0 && side[b] == 0)
            costs.add(number[a], number[b], {{{0, cost(up)}, {cost(down), 0}}});
        else if (side[a] == 0)
            costs.add(number[a], side[b] > 0 ? cost(up) : 0, side[b] < 0 ? cost(down) : 0);
        else
            costs.add(number[b], side[a] > 0 ? cost(down) : 0, side[a] < 0 ? cost(up) : 0);
    }
    const std::vector<std::uint8_t> labels = cheapest_labels(costs);
    std::vector<std::uint8_t> outside(lattice.size());
    for_each_index(outside.size(), chunks::light,
                   [&](Index i) { outside[i] = side[i] == 0 ? labels[number[i]] : side[i] > 0; });
    return outside;
}

/// Leaves open what is as deep as `continuing::least_depth` beyond the least surface without walls, in the
/// mean of each connected part.
void keep_deep(const Lattice& lattice, const std::vector<std::uint8_t>& closed,
               std::vector<std::uint8_t>& open) {
    DisjointSets parts(lattice.size());
    std::vector<double> size(lattice.size()), lid(lattice.size());
    const auto opens = [&](Index i) { return open[i] > closed[i]; };
    const auto for_each_edge = [&](const auto& visit) {
        for (Index i = 0; i < lattice.size(); ++i)
            for (unsigned k = 0; k < 3; ++k)
                if (const Index other = lattice.next[i][k];
                    other != no_index && lattice.on_edge(3 * std::size_t{i} + k).empty())
                    visit(i, other);
    };
    for_each_edge([&](Index i, Index k) {
        if (opens(i) && opens(k)) parts.join(i, k);
    });
    for_each_edge([&](Index i, Index k) {
        if (open[i] != 0 && open[k] != 0 && opens(i) != opens(k)) ++lid[parts.find(opens(i) ? i : k)];
    });
    for (Index i = 0; i < lattice.size(); ++i) size[parts.find(i)] += opens(i);
    for (Index i = 0; i < lattice.size(); ++i)
        if (const Index part = parts.find(i); opens(i) && size[part] < continuing::least_depth * lid[part])
            open[i] = 0; // parts stay as they were found
}

std::size_t number_of(const LatticePlace& place, const VoxelCoord& c) {
    const auto size = [&](unsigned k) { return static_cast<std::size_t>(place.last[k]); };
    return static_cast<std::size_t>(c[0])
           + size(0) * (static_cast<std::size_t>(c[1]) + size(1) * static_cast<std::size_t>(c[2]));
}

} // namespace

ContinuedSpace::ContinuedSpace(const PolygonMesh& mesh, const BoundaryLoops& border, double voxel_size)
    : place_(place_for(mesh, voxel_size)) {
    const ContinuedWalls walls = continued_walls(mesh, border, voxel_size);
    if (walls.along.facet_count() == 0 || walls.against.facet_count() == 0) return;
    const Lattice lattice = build_lattice(place_, all_points(place_), mesh);
    const std::vector<std::uint8_t> along_walls = confirmed(lattice, walls);
    if (std::ranges::count(along_walls, 0) == std::ssize(along_walls)) return;
    const std::vector<std::int8_t> side = known_sides(lattice);
    const std::vector<std::uint8_t> none(along_walls.size()), closed = least_surface(lattice, side, none);
    std::vector<std::uint8_t> open = least_surface(lattice, side, along_walls);
    keep_deep(lattice, closed, open);
    if (!std::ranges::any_of(std::views::iota(std::size_t{0}, open.size()),
                             [&](std::size_t i) { return open[i] > closed[i]; }))
        return;
    take_cells(lattice, open, closed);
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
