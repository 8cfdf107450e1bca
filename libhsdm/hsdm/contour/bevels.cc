#include "hsdm/contour/bevels.hh"

#include "hsdm/contour/blunt_creases.hh"
#include "hsdm/contour/constants.hh"
#include "hsdm/contour/dual_vertices.hh"
#include "hsdm/core/chunks.hh"
#include "hsdm/core/constants.hh"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace hsdm {
namespace {

/// A plane, in voxels.
struct Plane {
    Vec3 normal;
    double offset;

    Plane(const Vec3& n, const Vec3& point) : normal(n), offset(n | point) {}
    double above(const Vec3& p) const { return (normal | p) - offset; }
};

/// The grid face that a link passes through: across an axis, at a height.
struct LinkFace {
    unsigned axis = 0;
    double height;

    LinkFace(const GridPoints& grid, const Crossings& crossings, FacetSide side) {
        const VoxelCoord one = CornerVoxel(grid, crossings, side).coord;
        const VoxelCoord other = CornerVoxel(grid, crossings, side.next()).coord;
        while (one[axis] == other[axis]) ++axis;
        height = std::max(one[axis], other[axis]);
    }
    /// Where two planes meet in it, or beside it; none if they are parallel there.
    std::optional<Vec3> meeting(const Plane& k, const Plane& l) const {
        const unsigned a = (axis + 1) % 3, b = (axis + 2) % 3;
        const double determinant = k.normal[a] * l.normal[b] - k.normal[b] * l.normal[a];
        if (determinant * determinant < relations::least_sine_squared) return std::nullopt;
        const double kd = k.offset - k.normal[axis] * height, ld = l.offset - l.normal[axis] * height;
        Vec3 point;
        point[axis] = height;
        point[a] = (kd * l.normal[b] - ld * k.normal[b]) / determinant;
        point[b] = (k.normal[a] * ld - l.normal[a] * kd) / determinant;
        return point;
    }
};

class BevelFinder {
public:
    BevelFinder(const GridPoints& grid, const Crossings& crossings, const NormalSets& sets, double voxel_size)
        : grid_(grid), crossings_(crossings), sets_(sets), voxel_size_(voxel_size) {}

    bool leads_over_one(FacetSide side, FacetSide twin) const {
        const Crossing &x = crossings_.of(side), &y = crossings_.of(twin);
        if ((x.normal | y.normal) > angles::halfway) return false;
        if (crossings_.is_moved(x.edge) || crossings_.is_moved(y.edge))
            return false; // their face is not flat
        const LinkFace face(grid_, crossings_, side);
        return is_cut_off_round(x.edge, x, y, face) || is_cut_off_round(y.edge, x, y, face);
    }

private:
    /// ... by a set of the voxels round an edge's two ends?
    bool is_cut_off_round(Index edge, const Crossing& x, const Crossing& y, const LinkFace& face) const {
        const std::array ends{edge / 3, grid_.next[edge / 3][edge % 3]};
        return std::ranges::any_of(ends, [&](Index grid_point) {
            return std::ranges::any_of(grid_.voxels[grid_point], [&](Index voxel) {
                return voxel != no_index
                       && std::ranges::any_of(sets_.of_voxel(voxel), [&](const NormalSet& set) {
                              return set.count >= points_of_plane && is_cut_off(x, y, face, set);
                          });
            });
        });
    }
    /// Does a set lie near a face, and its plane between two crossings and the tip where their planes meet
    /// there?
    bool is_cut_off(const Crossing& x, const Crossing& y, const LinkFace& face, const NormalSet& set) const {
        if (!lies_between(x.normal, set.normal, y.normal) || !is_flat_between(grid_, x, set, y, voxel_size_))
            return false;
        const Vec3 from = crossing_position(grid_, x, 1), to = crossing_position(grid_, y, 1);
        const Vec3 centroid = set.centroid / voxel_size_;
        const Plane one(x.normal, from), other(y.normal, to), bevel(set.normal, centroid);
        const double k = one.above(to), l = other.above(from);
        if (!(k * l > 0)) return false;
        const double inward = k < 0 ? 1 : -1; // in a convex crease, or a concave one
        const auto tip = face.meeting(one, other), begin = face.meeting(one, bevel),
                   end = face.meeting(bevel, other);
        if (!tip || !begin || !end || inward * bevel.above(*tip) < 0) return false;
        if (inward * bevel.above(from) > 0 || inward * bevel.above(to) > 0) return false;
        return (*end - *begin).norm() > sheets::plane_error
               && (0.5 * (*begin + *end) - centroid).norm() < sheets::beside;
    }

    const GridPoints& grid_;
    const Crossings& crossings_;
    const NormalSets& sets_;
    double voxel_size_;
};

} // namespace

bool lies_between(const Vec3& a, const Vec3& c, const Vec3& b) {
    const double one = a | c, other = b | c;
    if (std::max(one, other) > angles::smooth || std::min(one, other) < (a | b)) return false;
    const Vec3 crease = a % b;
    const double along = crease | c; // as long as the crease's sine, if c were along it
    return along * along < (1 - angles::smooth * angles::smooth) * crease.sqrnorm();
}

bool is_flat_between(const GridPoints& grid, const Crossing& a, const NormalSet& set, const Crossing& b,
                     double voxel_size) {
    const Vec3 bend = b.normal - a.normal;
    const Vec3 way = crossing_position(grid, b, voxel_size) - crossing_position(grid, a, voxel_size);
    return is_nearer_to_flat(set.turn, set.spread.along(bend), way | bend);
}

std::size_t mark_bevels(const GridPoints& grid, const Crossings& crossings, const NormalSets& sets,
                        double voxel_size, Links& links) {
    const BevelFinder finder(grid, crossings, sets, voxel_size);
    const auto sides = 4 * crossings.crossings.size();
    const auto side_of = [](Index i) { return FacetSide(i / 4, i % 4); };
    const std::vector<Index> found = indices_where(sides, chunks::usual, [&](Index i) {
        const Link& link = links.of(side_of(i));
        return !link.open() && !link.rim && side_of(i) < link.twin
               && finder.leads_over_one(side_of(i), link.twin);
    });
    for (const Index i : found) {
        Link& link = links.of(side_of(i));
        link.bevel = links.of(link.twin).bevel = true;
    }
    return found.size();
}

} // namespace hsdm
