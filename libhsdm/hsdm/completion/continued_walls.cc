#include "hsdm/completion/continued_walls.hh"

#include "hsdm/completion/constants.hh"
#include "hsdm/core/chunks.hh"
#include "hsdm/core/constants.hh"
#include "hsdm/core/groups.hh"
#include "hsdm/core/interruption.hh"
#include "hsdm/core/large_vector.hh"
#include "hsdm/mesh/area_vector.hh"
#include "hsdm/normals/plane_fit.hh"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <utility>

namespace hsdm {
namespace {

enum class Shape : std::uint8_t { bent, ruled, flat };

/// The mesh round a facet.
struct Surrounding {
    Shape shape = Shape::bent;
    Vec3 normal{0, 0, 0};
    Vec3 ruling{0, 0, 0}; ///< where it is ruled: unit, of either sign
};

/// How normals turn over a surface: the least squares of n(x) = n + turn x in the plane square to n.
class Turning {
public:
    explicit Turning(const Vec3& normal) : normal_(normal) {
        const Vec3 other = std::abs(normal[0]) < 0.7 ? Vec3(1, 0, 0) : Vec3(0, 1, 0);
        u_ = unit(normal % other), v_ = normal % u_;
    }
    void add(const Vec3& way, const Vec3& normal, double weight) {
        const double x = way | u_, y = way | v_, a = normal | u_, b = normal | v_;
        xx_ += weight * x * x, xy_ += weight * x * y, yy_ += weight * y * y;
        ax_ += weight * a * x, ay_ += weight * a * y, bx_ += weight * b * x, by_ += weight * b * y;
    }
    /// The bends along both directions of least and most, and the direction of least. In units of 1 / length.
    Surrounding shape(double most) const {
        Surrounding result{Shape::bent, normal_, {0, 0, 0}};
        const double det = xx_ * yy_ - xy_ * xy_;
        if (!(det > 0)) return result;
        const double p = (ax_ * yy_ - ay_ * xy_) / det, q = (ay_ * xx_ - ax_ * xy_) / det,
                     r = (bx_ * yy_ - by_ * xy_) / det, s = (by_ * xx_ - bx_ * xy_) / det;
        const double shear = 0.5 * (q + r), mean = 0.5 * (p + s), half = std::hypot(0.5 * (p - s), shear);
        const double greater = mean + half, less = mean - half;
        const bool greater_is_most = std::abs(greater) > std::abs(less);
        const double bend = greater_is_most ? greater : less, least = greater_is_most ? less : greater;
        if (std::abs(least) > most) return result;
        if (std::abs(bend) <= most) {
            result.shape = Shape::flat;
            return result;
        }
        const double turn = 0.5 * std::atan2(2 * shear, p - s); // of the direction of `greater`
        const double c = std::cos(turn), d = std::sin(turn);
        result.shape = Shape::ruled;
        result.ruling = greater_is_most ? v_ * c - u_ * d : u_ * c + v_ * d;
        return result;
    }

private:
    Vec3 normal_, u_, v_;
    double xx_ = 0, xy_ = 0, yy_ = 0, ax_ = 0, ay_ = 0, bx_ = 0, by_ = 0;
};

/// What a mesh is like round its facets, up to the creases around.
class Surroundings {
public:
    Surroundings(const PolygonMesh& mesh, double voxel_size)
        : mesh_(mesh), voxel_size_(voxel_size), seen_(mesh.facet_count(), no_index) {
        reserve_large(facet_, mesh.corners.size());
        for_each_in_order(mesh.facet_count(), [&](std::size_t f) {
            facet_.insert(facet_.end(), mesh.facet(f).size(), static_cast<Index>(f));
        });
        corners_ = Groups(mesh.corners, mesh.vertex_count());
    }

    /// `number` tells this call from all others. O(facets within the reach).
    Surrounding of(Index facet, Index number) {
        reach(facet, number);
        Vec3 sum(0, 0, 0);
        for (const Index f : reached_) sum += area_of(f);
        const double area = 0.5 * sum.norm();
        if (!(area > continuing::least_area * voxel_size_ * voxel_size_))
            return {Shape::bent, unit(area_of(facet)), {0, 0, 0}};
        Turning turning(unit(sum));
        Vec3 centre(0, 0, 0);
        for (const Index f : reached_) centre += middle_of(f) / static_cast<double>(reached_.size());
        for (const Index f : reached_)
            turning.add(middle_of(f) - centre, unit(area_of(f)), area_of(f).norm());
        return turning.shape(continuing::most_bend / voxel_size_);
    }

private:
    Vec3 area_of(Index f) const { return area_vector(mesh_, mesh_.facet(f)); }
    Vec3 middle_of(Index f) const { return centroid(mesh_, mesh_.facet(f)); }
    /// Facets within the reach that none of the edges between turns by more than one sheet does.
    void reach(Index facet, Index number) {
        reached_ = {facet};
        seen_[facet] = number;
        const Vec3 from = middle_of(facet);
        const double far = continuing::reach * voxel_size_;
        for (std::size_t i = 0; i < reached_.size(); ++i) {
            const Vec3 area = area_of(reached_[i]);
            for (const Index v : mesh_.facet(reached_[i]))
                for (const Index corner : corners_.of(v)) {
                    const Index f = facet_[corner];
                    if (seen_[f] == number || (middle_of(f) - from).sqrnorm() > far * far) continue;
                    if ((unit(area) | unit(area_of(f))) < angles::smooth) continue;
                    seen_[f] = number;
                    reached_.push_back(f);
                }
        }
    }

    const PolygonMesh& mesh_;
    double voxel_size_;
    std::vector<Index> seen_, facet_, reached_; // per facet, per corner
    Groups corners_{{}, 0};                     // of vertices
};

/// Directions of lines, those that are about the same taken together.
struct Directions {
    std::vector<std::pair<Vec3, double>> sums; ///< and their weights

    /// `lines`: of either sign.
    void add(const Vec3& direction, double weight, bool lines) {
        for (auto& [sum, all] : sums) {
            const double cosine = unit(sum) | direction;
            if ((lines ? std::abs(cosine) : cosine) < continuing::one_direction) continue;
            sum += direction * std::copysign(weight, cosine);
            all += weight;
            return;
        }
        sums.emplace_back(direction * weight, weight);
    }
};

struct SweptSide {
    Vec3 from, to, normal;

    double length() const { return (to - from).norm(); }
    /// Does it go on along an axis, on a wall of it or on a face that it enters?
    bool goes_on(const Vec3& axis) const {
        const double slope = normal | axis;
        const Vec3 beyond = normal % (to - from);
        return slope < -angles::halfway
               || (std::abs(slope) < continuing::wall
                   && (beyond | axis) > continuing::least_lead * beyond.norm());
    }
};

/// What a loop's sides say of an axis that walls stand round.
struct WallsRound {
    Vec3 axis{0, 0, 0};
    double length = 0; ///< of the sides that lie on walls of it
    double spread = 0; ///< of their normals round it: 0 if all are parallel, 0.5 if none is preferred
};

void add_both_ways(const SweptSide& side, PlaneSums& normals) {
    normals.add(side.normal, 0.5 * side.length());
    normals.add(-side.normal, 0.5 * side.length());
}

/// The mean square of unit normals along the second of the axes along which they are least, and most.
double spread_of(const PlaneSums& normals) {
    if (!(normals.weight > 0)) return 0;
    const double least = fit_plane(normals).variance, others = 1 - least;
    double squares = -least * least;
    for (unsigned k = 0; k < 6; ++k) {
        const double mean = normals.second[k] / normals.weight;
        squares += (k < 3 ? 1 : 2) * mean * mean;
    }
    return 0.5 * (others - std::sqrt(std::max(2 * squares - others * others, 0.0)));
}

/// The axis is the one least along the normals of what stands straight about it, up to rounded edges.
WallsRound walls_round(const std::vector<SweptSide>& sides, const Vec3& about) {
    WallsRound walls{about};
    PlaneSums normals, straight;
    for (const SweptSide& side : sides) {
        const double slope = std::abs(side.normal | about);
        if (slope < continuing::wall) add_both_ways(side, normals);
        if (slope < continuing::straight_wall) add_both_ways(side, straight);
    }
    walls.length = normals.weight;
    walls.spread = spread_of(normals);
    const Vec3 axis = fit_plane(straight).normal;
    if (axis.sqrnorm() > 0 && 2 * straight.weight >= walls.length) walls.axis = axis;
    return walls;
}

/// Axes that a loop's surroundings may have: the rulings of walls, and what two planes have in common.
Directions supposed_axes(const std::vector<SweptSide>& sides, const std::vector<Surrounding>& around,
                         double voxel_size) {
    Directions normals, axes;
    for (std::size_t i = 0; i < sides.size(); ++i) {
        if (around[i].shape == Shape::flat) normals.add(around[i].normal, sides[i].length(), false);
        if (around[i].shape == Shape::ruled) axes.add(around[i].ruling, sides[i].length(), true);
    }
    std::erase_if(normals.sums,
                  [&](const auto& n) { return n.second < continuing::least_length * voxel_size; });
    for (std::size_t i = 0; i < normals.sums.size(); ++i)
        for (std::size_t k = 0; k < i; ++k) {
            const auto& [one, weight] = normals.sums[i];
            const auto& [other, other_weight] = normals.sums[k];
            const Vec3 common = unit(one) % unit(other);
            if (common.norm() > continuing::least_sine)
                axes.add(unit(common), std::min(weight, other_weight), true);
        }
    return axes;
}

/// Adds those of a loop round which many of its sides lie on walls that are not all parallel; each once.
void add_axes(const std::vector<SweptSide>& sides, const Directions& supposed, Directions& axes) {
    double length = 0;
    for (const SweptSide& side : sides) length += side.length();
    Directions own;
    for (const auto& [sum, weight] : supposed.sums) {
        // Once more about where the first leads, as what stands straight about that is more.
        const WallsRound walls = walls_round(sides, walls_round(sides, unit(sum)).axis);
        if (walls.length < continuing::least_walls * length || walls.spread < continuing::least_spread)
            continue;
        const std::size_t before = own.sums.size();
        own.add(walls.axis, walls.length, true);
        if (own.sums.size() > before) axes.add(walls.axis, walls.length, true);
    }
}

void add_swept(const SweptSide& side, const Vec3& way, PolygonMesh& walls) {
    const auto first = static_cast<Index>(walls.vertex_count());
    for (const Vec3& p : {side.from, side.to, side.to + way, side.from + way}) walls.positions.push_back(p);
    walls.add_facet(std::array{first, first + 1, first + 2});
    walls.add_facet(std::array{first, first + 2, first + 3});
}

/// The sides of a loop; `axes` take its own.
std::vector<SweptSide> sides_of(const PolygonMesh& mesh, const BoundaryLoops& border, std::size_t l,
                                double voxel_size, Surroundings& surroundings, Directions& axes) {
    std::vector<SweptSide> sides;
    std::vector<Surrounding> around;
    for (Index i = border.begin[l]; i < border.begin[l + 1]; ++i) {
        Interruption::poll();
        const Index next = i + 1 < border.begin[l + 1] ? i + 1 : border.begin[l];
        around.push_back(surroundings.of(border.facets[i], i));
        sides.push_back({mesh.positions[border.vertices[i]], mesh.positions[border.vertices[next]],
                         around.back().normal});
    }
    add_axes(sides, supposed_axes(sides, around, voxel_size), axes);
    return sides;
}

} // namespace

void for_each_continued_wall(const PolygonMesh& mesh, const BoundaryLoops& border, double voxel_size,
                             const std::function<void(const PolygonMesh&, const PolygonMesh&)>& visit) {
    Surroundings surroundings(mesh, voxel_size);
    Box box;
    for (const Vec3& p : mesh.positions) box.add(p);
    const double far = box.size().norm();
    std::vector<SweptSide> sides; // of all loops
    Directions axes;
    for (std::size_t l = 0; l < border.size(); ++l)
        append_large(sides, sides_of(mesh, border, l, voxel_size, surroundings, axes));
    std::ranges::stable_sort(axes.sums, std::ranges::greater(), [](const auto& axis) { return axis.second; });
    if (axes.sums.size() > continuing::most_axes) axes.sums.resize(continuing::most_axes);
    const auto swept = [&](const Vec3& way) {
        PolygonMesh walls;
        for (const SweptSide& side : sides)
            if (side.goes_on(way)) add_swept(side, way * far, walls);
        return walls;
    };
    for (const auto& [sum, weight] : axes.sums) {
        Interruption::poll();
        visit(swept(unit(sum)), swept(-unit(sum)));
    }
}

} // namespace hsdm
