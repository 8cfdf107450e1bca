#include "hsdm/completion/continued_space.hh"

#include "hsdm/completion/constants.hh"
#include "hsdm/completion/continued_walls.hh"
#include "hsdm/contour/minimum_cut.hh"
#include "hsdm/core/chunks.hh"
#include "hsdm/core/disjoint_sets.hh"
#include "hsdm/core/interruption.hh"
#include "hsdm/core/parallel_sort.hh"

#include <algorithm>
#include <cmath>
#include <utility>

namespace hsdm {
namespace {

/// Walls that pass an edge of the lattice facing up its axis, or down.
enum Facing : std::uint8_t { up = 1, down = 2 };

/// Bits of `Facing` per edge of the lattice.
using FacingWalls = std::vector<std::uint8_t>;

/// Walls that pass the edges of a lattice.
struct ContinuedWalls {
    FacingWalls confirmed; ///< others that come from the far end along the same axis pass there or beside it
    FacingWalls all;
};

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

void mark_passed(const Lattice& lattice, const PolygonMesh& walls, FacingWalls& passed) {
    for (const LatticeHit& hit : find_hits(lattice, walls))
        if (const double d = hit.normal[hit.edge % 3]; d != 0) passed[hit.edge] |= facing_between(d < 0);
}

ContinuedWalls continued_walls(const Lattice& lattice, const PolygonMesh& mesh, const BoundaryLoops& border,
                               double voxel_size) {
    const FacingWalls none(3 * lattice.size());
    ContinuedWalls result{none, none};
    for_each_continued_wall(mesh, border, voxel_size,
                            [&](const PolygonMesh& along_axis, const PolygonMesh& against_axis) {
                                FacingWalls along = none, against = none;
                                mark_passed(lattice, along_axis, along);
                                mark_passed(lattice, against_axis, against);
                                for_each_index(none.size(), chunks::light, [&](std::size_t e) {
                                    const unsigned here = along[e] | against[e];
                                    if (here == 0) return;
                                    unsigned one = along[e], other = against[e];
                                    for (const Index k : lattice.next[e / 3]) {
                                        if (k == no_index) continue;
                                        one |= along[3 * std::size_t{k} + e % 3];
                                        other |= against[3 * std::size_t{k} + e % 3];
                                    }
                                    result.all[e] |= static_cast<std::uint8_t>(here);
                                    result.confirmed[e] |= static_cast<std::uint8_t>(here & one & other);
                                });
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
/// along confirmed walls cost `continuing::wall_cost` of their area, along others `continuing::guess_cost`.
std::vector<std::uint8_t> least_surface(const Lattice& lattice, const std::vector<std::int8_t>& side,
                                        const ContinuedWalls& walls) {
    const std::vector<Index> unknown =
        indices_where(lattice.size(), chunks::light, [&](Index i) { return side[i] == 0; });
    std::vector<Index> number(lattice.size(), no_index);
    for (std::size_t i = 0; i < unknown.size(); ++i) number[unknown[i]] = static_cast<Index>(i);
    LabelCosts costs(unknown.size()); // label 1: outside
    for_each_free_edge(lattice, [&](std::size_t e, Index a, Index b) {
        const auto cost = [&](Facing facing) {
            if ((walls.all[e] & facing) == 0) return 1.0;
            return (walls.confirmed[e] & facing) != 0 ? continuing::wall_cost : continuing::guess_cost;
        };
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
    double lids = 0;              ///< of the least surface without walls, which it takes away
    double depth = 0;             ///< behind all of its lids: points straight in from each
    double walls = 0, others = 0; ///< what bounds it in their place: confirmed walls, and what is not

    bool is_evident() const { return depth >= continuing::least_depth * lids && walls > others; }
};

/// From a grid point on along an axis (up, or down: 3 and more), how many lie in a row, with no mesh between,
/// of those that open?
template <class Opens>
int straight_in(const Lattice& lattice, Index point, unsigned way, const Opens& opens) {
    for (int count = 1;; ++count) {
        const Index next = lattice.next[point][way];
        if (next == no_index || !opens(next)) return count;
        if (!lattice.on_edge(3 * std::size_t{way < 3 ? point : next} + way % 3).empty()) return count;
        point = next;
    }
}

/// Leaves open what is deep behind its lids and bounded by walls, most of it, in each connected part; is
/// there any?
bool keep_evident(const Lattice& lattice, const std::vector<std::uint8_t>& closed, const FacingWalls& walls,
                  std::vector<std::uint8_t>& open) {
    const std::vector<std::uint8_t> all = open;
    const auto opens = [&](Index i) { return all[i] > closed[i]; };
    DisjointSets sets(lattice.size());
    std::vector<OpenedPart> parts(lattice.size());
    for_each_free_edge(lattice, [&](std::size_t, Index a, Index b) {
        if (opens(a) && opens(b)) sets.join(a, b);
    });
    for_each_free_edge(lattice, [&](std::size_t e, Index a, Index b) {
        if (opens(a) == opens(b)) return;
        const bool is_up = opens(b); // from outside into the part
        OpenedPart& part = parts[sets.find(is_up ? b : a)];
        if (all[is_up ? a : b] != 0) {
            ++part.lids;
            const auto axis = static_cast<unsigned>(e % 3);
            part.depth += straight_in(lattice, is_up ? b : a, is_up ? axis : axis + 3, opens);
        } else
            ++((walls[e] & facing_between(!is_up)) != 0 ? part.walls : part.others);
    });
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
    const ContinuedWalls walls = continued_walls(lattice, mesh, border, voxel_size);
    if (std::ranges::count(walls.confirmed, 0) == std::ssize(walls.confirmed)) return;
    const std::vector<std::int8_t> side = known_sides(lattice);
    const FacingWalls none(walls.all.size());
    const std::vector<std::uint8_t> closed = least_surface(lattice, side, {none, none});
    Interruption::poll();
    std::vector<std::uint8_t> open = least_surface(lattice, side, walls);
    if (keep_evident(lattice, closed, walls.confirmed, open)) take_cells(lattice, open, closed);
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
