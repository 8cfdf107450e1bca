#include "hsdm/contour/bar_lines.hh"

#include "hsdm/contour/surrounding.hh"
#include "hsdm/core/chunks.hh"
#include "hsdm/core/constants.hh"
#include "hsdm/core/large_vector.hh"
#include "hsdm/mesh/area_vector.hh"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <optional>
#include <tuple>
#include <utility>

namespace hsdm {
namespace {

/// Of the grid.
struct PassedFace {
    Index grid_point; ///< its lowest corner
    unsigned axis;    ///< across it
    std::array<Index, 2> voxels;
};

/// Where a bar or bore passes a face.
struct Passage {
    Vec3 middle;   ///< in voxels
    Vec3 along;    ///< unit, of either sign
    double radius; ///< of the middle from the sets, by least squares, in voxels
};

std::array<Index, 4> corners_of(const GridPoints& grid, const PassedFace& face) {
    const unsigned u = (face.axis + 1) % 3, w = (face.axis + 2) % 3;
    const Index c = face.grid_point, up = grid.next[c][u];
    return {c, up, grid.next[c][w], grid.next[up][w]};
}

/// What passes a face, by the sets around it. Reused from face to face.
class FaceSection {
public:
    FaceSection(const GridPoints& grid, const NormalSets& sets, const RelationTest& related,
                double voxel_size)
        : grid_(grid), sets_(sets), related_(related), h_(voxel_size) {}

    std::optional<Passage> find(const PassedFace& face) {
        gather(face);
        if (through_.empty()) return {};
        const Eigen::Matrix3d directions = find_directions();
        for (const int k : {0, 1}) { // two bars may meet there
            const Vec3 along(directions(0, k), directions(1, k), directions(2, k));
            if (std::abs(along[face.axis]) < angles::half_of_sheet) continue; // it runs beside the face
            if (const auto passage = find_along(face, along)) return passage;
        }
        return {};
    }

private:
    using Sets = std::vector<const NormalSet*>;

    /// The sets of the two voxels that go on on the other side, their others, and those of the other voxels
    /// that touch the face.
    void gather(const PassedFace& face) {
        through_.clear(), others_.clear(), around_.clear(), voxels_.clear();
        for (const unsigned side : {0u, 1u})
            for (const NormalSet& s : sets_.of_voxel(face.voxels[side])) {
                const bool goes_on =
                    std::ranges::any_of(sets_.of_voxel(face.voxels[1 - side]),
                                        [&](const NormalSet& t) { return related_.smooth(s, t); });
                (goes_on ? through_ : others_).push_back(&s);
            }
        if (through_.empty()) return;
        for (const Index corner : corners_of(grid_, face))
            for (const Index v : grid_.voxels[corner])
                if (v != no_index && v != face.voxels[0] && v != face.voxels[1]) voxels_.push_back(v);
        sort_unique(voxels_);
        for (const Index v : voxels_)
            for (const NormalSet& s : sets_.of_voxel(v)) around_.push_back(&s);
    }

    /// The ones that normals lie across come first; of all sets of the two voxels if those that go on leave
    /// it open.
    Eigen::Matrix3d find_directions() const {
        Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
        const auto add = [&](const Sets& sets) {
            for (const NormalSet* s : sets) {
                const Eigen::Vector3d n(s->normal[0], s->normal[1], s->normal[2]);
                sum += s->count * n * n.transpose();
            }
        };
        add(through_);
        Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen;
        eigen.computeDirect(sum);
        if (eigen.eigenvalues()[1] < placement::least_singular * eigen.eigenvalues()[2]) {
            add(others_);
            eigen.computeDirect(sum);
        }
        return eigen.eigenvectors();
    }

    /// By the sets that go on, else with the others, else with those around. A bore in a bar counts for both:
    /// of the two the narrower.
    std::optional<Passage> find_along(const PassedFace& face, const Vec3& along) {
        const Frame across(along);
        along_.clear();
        for (const Sets* sets : {&through_, &others_, &around_}) {
            std::ranges::copy_if(*sets, std::back_inserter(along_), [&](const NormalSet* s) {
                return std::abs(s->normal | along) < angles::half_of_sheet;
            });
            angles_.clear();
            for (const NormalSet* s : along_) angles_.push_back(across.angle_of(s->normal));
            if (wide_gaps(angles_) > 0) continue; // nothing goes all round, as in a wall
            const auto bar = find_round(face, along, true), bore = find_round(face, along, false);
            if (bar && bore) return narrower(*bar, *bore);
            if (bar || bore) return bar ? bar : bore;
        }
        return {};
    }

    static const Passage& narrower(const Passage& one, const Passage& other) {
        const auto order = [](const Passage& p) {
            return std::tuple(p.radius, p.middle[0], p.middle[1], p.middle[2]);
        };
        return order(one) < order(other) ? one : other; // turned normals swap them
    }

    /// Of the sets with a partner: do they lie all round a place of the face, and all face away from it, or
    /// all towards it?
    std::optional<Passage> find_round(const PassedFace& face, const Vec3& along, bool is_bar) {
        const Frame across(along);
        used_.clear(), angles_.clear();
        for (const NormalSet* s : along_)
            if (has_partner(*s, is_bar)) {
                used_.push_back(s);
                angles_.push_back(across.angle_of(s->normal));
            }
        if (wide_gaps(angles_) > 0) return {};
        const auto passage = equally_far(face, along);
        const auto is_beside = [&](const NormalSet* s) {
            const double above = s->normal | (passage->middle - s->centroid / h_);
            return is_bar ? above < 0 : above > 0;
        };
        if (!passage || !std::ranges::all_of(used_, is_beside)) return {};
        angles_.clear();
        for (const NormalSet* s : used_)
            if (lies_before(*s, *passage)) angles_.push_back(across.angle_of(s->normal));
        return wide_gaps(angles_) == 0 ? passage : std::nullopt;
    }

    /// Does the middle lie above or below what a set covers across the bar, if its points lie there evenly?
    /// The sides of walls that meet begin beside the middle.
    bool lies_before(const NormalSet& s, const Passage& passage) const {
        const Vec3 way = unit(passage.along % s.normal), off = passage.middle - s.centroid / h_;
        const double along_it = (way | off) * h_;
        return along_it * along_it <= s.spread.reach_squared(way);
    }

    /// Is there a set opposite that this one faces away from, as on the other side of a bar, or that it
    /// faces?
    bool has_partner(const NormalSet& s, bool is_bar) const {
        return std::ranges::any_of(along_, [&](const NormalSet* t) {
            const Vec3 way = t->centroid - s.centroid;
            const double above = s.normal | way, below = t->normal | way;
            return (s.normal | t->normal) < 0 && (is_bar ? above < 0 && below > 0 : above > 0 && below < 0);
        });
    }

    /// The place that is equally far from all sets, as well as may be, if it lies in the face.
    std::optional<Passage> equally_far(const PassedFace& face, const Vec3& along) const {
        const VoxelCoord corner = grid_.coord(face.grid_point);
        const Vec3 lowest(corner[0], corner[1], corner[2]);
        const unsigned u = (face.axis + 1) % 3, w = (face.axis + 2) % 3;
        Eigen::Matrix3d a = Eigen::Matrix3d::Zero();
        Eigen::Vector3d b = Eigen::Vector3d::Zero();
        for (const NormalSet* s : used_) {
            const Eigen::Vector3d row(s->normal[u], s->normal[w], 1);
            const double weight = std::min(s->count, points_of_plane);
            a += weight * row * row.transpose();
            b += weight * (s->normal | (s->centroid / h_ - lowest)) * row;
        }
        const Eigen::Vector3d x = a.ldlt().solve(b);
        const double slack = placement::margin; // on an edge of the grid rounding must not leave it out
        for (const int k : {0, 1})
            if (!(x[k] > -slack && x[k] < 1 + slack)) return {};
        Vec3 middle = lowest;
        middle[u] += std::clamp(x[0], 0.0, 1.0), middle[w] += std::clamp(x[1], 0.0, 1.0);
        return Passage{middle, along, std::abs(x[2])};
    }

    const GridPoints& grid_;
    const NormalSets& sets_;
    const RelationTest& related_;
    double h_;
    Sets through_, others_, around_, along_, used_;
    std::vector<Index> voxels_;
    std::vector<double> angles_;
};

double squared_distance(const Vec3& place, const VoxelCoord& c) {
    return (place - Vec3(c[0], c[1], c[2])).sqrnorm();
}

/// The two grid points nearest to a place of a grid plane, the nearest first.
std::array<VoxelCoord, 2> nearest_two(const Vec3& place, unsigned axis) {
    const unsigned u = (axis + 1) % 3, w = (axis + 2) % 3;
    VoxelCoord lowest;
    for (unsigned k = 0; k < 3; ++k) lowest[k] = static_cast<int>(std::floor(place[k]));
    lowest[axis] = static_cast<int>(std::lround(place[axis]));
    std::array<VoxelCoord, 4> corners{lowest, lowest, lowest, lowest};
    ++corners[1][u], ++corners[2][w], ++corners[3][u], ++corners[3][w];
    std::ranges::stable_sort(corners, {}, [&](const VoxelCoord& c) { return squared_distance(place, c); });
    return {corners[0], corners[1]};
}

/// A place on the line of a bar that wants a grid point.
struct Claim {
    enum Kind : std::uint8_t { in_face, between, beyond }; ///< the sooner, the earlier
    Vec3 place;
    Kind kind;
    std::array<VoxelCoord, 2> grid_points; ///< the one that it wants, and the one else

    std::size_t choices() const { return kind == in_face ? 2 : 1; }
};

/// The line from one place to another wants the grid points of a way of edges between their two.
void claim_between(const Vec3& from, VoxelCoord at, const Vec3& to, const VoxelCoord& last,
                   std::vector<Claim>& claims) {
    const auto left = [&] { return (at[0] != last[0]) + (at[1] != last[1]) + (at[2] != last[2]); };
    const int steps = left();
    for (int step = 1; step < steps; ++step) {
        const Vec3 place = from + (static_cast<double>(step) / steps) * (to - from);
        std::optional<VoxelCoord> nearest;
        for (unsigned k = 0; k < 3; ++k) {
            VoxelCoord next = at;
            next[k] = last[k];
            if (next != at && (!nearest || squared_distance(place, next) < squared_distance(place, *nearest)))
                nearest = next;
        }
        at = *nearest;
        claims.push_back({place, Claim::between, {at, at}});
    }
}

/// The line of a bar that passes a face wants grid points there, in the planes next to it, and between.
void claim_line(const Passage& passage, unsigned axis, std::vector<Claim>& claims) {
    const auto here = nearest_two(passage.middle, axis);
    claims.push_back({passage.middle, Claim::in_face, here});
    for (unsigned k = 0; k < 3; ++k) { // it goes on to planes of the axis that it is steepest to
        const double other = std::abs(passage.along[k]), own = std::abs(passage.along[axis]);
        if (other > own || (other == own && k < axis)) return;
    }
    const Vec3 step = passage.along / passage.along[axis];
    for (const double way : {-1.0, 1.0}) {
        const Vec3 place = passage.middle + way * step;
        const VoxelCoord next = nearest_two(place, axis)[0];
        claims.push_back({place, Claim::beyond, {next, next}});
        claim_between(passage.middle, here[0], place, next, claims);
    }
}

/// The voxels of a face, if they have as many sets as something needs that passes it.
std::optional<PassedFace> passed_face(const GridPoints& grid, const NormalSets& sets, Index grid_point,
                                      unsigned axis) {
    const auto& around = grid.voxels[grid_point];
    const PassedFace face{grid_point, axis, {around[7u ^ 1u << axis], around[7]}};
    std::size_t count = 0;
    for (const Index v : face.voxels) {
        if (v == no_index || sets.first[v] == sets.first[v + 1]) return {};
        count += sets.first[v + 1] - sets.first[v];
    }
    return count >= 2 * two_agree ? std::optional(face) : std::nullopt; // two sides of it, on either side
}

/// Moves grid points to the places that want them; those that go without then ask for what is left.
std::size_t move_to(std::vector<Claim> claims, GridPoints& grid) {
    struct Wanted {
        Index point;
        double distance; // squared
        Claim claim;
        auto order() const {
            const Vec3& p = claim.place;
            return std::tuple(point, claim.kind, distance, p[0], p[1], p[2]);
        }
    };
    std::vector<Index> taken; // ascending
    for (int round = 0; round < repeats::twice; ++round) {
        std::vector<Wanted> wanted;
        for (const Claim& claim : claims)
            for (std::size_t k = 0; k < claim.choices(); ++k) {
                const Index point = grid.find(GridPoints::code(claim.grid_points[k]));
                const double distance = squared_distance(claim.place, claim.grid_points[k]);
                if (point == no_index || distance > 1 || std::ranges::binary_search(taken, point)) continue;
                wanted.push_back({point, distance, claim});
                break;
            }
        std::ranges::sort(wanted, {}, &Wanted::order);
        claims.clear();
        if (!wanted.empty() && taken.empty()) resize_large(grid.moved_by, grid.size(), Vec3(0, 0, 0));
        Index last = no_index;
        Vec3 there;
        for (const Wanted& w : wanted) {
            if (std::exchange(last, w.point) == w.point) { // the same place needs no second one
                if ((w.claim.place - there).norm() > placement::margin) claims.push_back(w.claim);
                continue;
            }
            there = w.claim.place;
            const VoxelCoord at = grid.coord(w.point);
            grid.moved_by[w.point] = w.claim.place - Vec3(at[0], at[1], at[2]);
            taken.push_back(w.point);
        }
        std::ranges::sort(taken);
    }
    return taken.size();
}

} // namespace

std::size_t move_to_bar_lines(GridPoints& grid, const NormalSets& sets, const RelationTest& related,
                              double voxel_size) {
    const auto claim = [&](std::size_t begin, std::size_t end, std::vector<Claim>& claims) {
        FaceSection section(grid, sets, related, voxel_size);
        for (auto c = static_cast<Index>(begin); c < end; ++c)
            for (unsigned axis = 0; axis < 3; ++axis)
                if (const auto face = passed_face(grid, sets, c, axis))
                    if (const auto passage = section.find(*face)) claim_line(*passage, axis, claims);
    };
    return move_to(collected<Claim>(grid.size(), chunks::usual, claim), grid);
}

namespace {

/// Measured and completed points of some voxels, asked about a place on a sheet.
class PointsAround {
public:
    PointsAround(const Octree& octree, const OctreeLevel& level, std::span<const Index> voxels)
        : octree_(octree), level_(level), voxels_(voxels) {
        for (const Index v : voxels) count_ += level.first_point[v + 1] - level.first_point[v];
    }

    bool are_none() const { return count_ == 0; }

    /// Has the sheet a point there?
    bool have(const Vec3& at, const Vec3& normal) const {
        const double h = level_.voxel_size;
        const double reach = handles::beside_place * handles::beside_place * h * h
                             * static_cast<double>(voxels_.size()) / static_cast<double>(count_); // squared
        for (const Index v : voxels_)
            for (Index p = level_.first_point[v]; p < level_.first_point[v + 1]; ++p)
                if ((octree_.normals[p] | normal) > angles::facing
                    && (octree_.positions[p] - at).sqrnorm() < reach)
                    return true;
        return false;
    }

    /// Does a bar that stands on the sheet pass there, or a bore that enters it? Measured points stand round
    /// the normal through the place, in front of the sheet and facing away from it, or behind and facing it;
    /// nearer than any that face the other way, and than the sheet's own.
    bool is_passed(const Vec3& at, const Vec3& normal) const {
        const Frame across(normal);
        const double h = level_.voxel_size, reach = surrounding::reach_along * h;
        double sheet = std::numeric_limits<double>::infinity(); // the nearest of its points
        SidesOfLine in_front, behind;
        for (const Index v : voxels_)
            for (Index p = level_.first_point[v]; p < level_.first_point[v + 1]; ++p) {
                const Vec3 off = octree_.positions[p] - at, &facing = octree_.normals[p];
                const double above = off | normal;
                const Vec3 out = off - above * normal;
                const double distance = out.norm(), away = facing | out;
                if (octree_.is_completed(p) || std::max(std::abs(above), distance) > reach) continue;
                if ((facing | normal) > angles::facing) {
                    if (std::abs(above) < handles::speaking_gap * h) sheet = std::min(sheet, distance);
                } else if (above != 0 && std::abs(away) > angles::halfway * distance) {
                    (above > 0 ? in_front : behind)[away > 0].push_back({distance, across.angle_of(facing)});
                }
            }
        return is_round(in_front[1], in_front[0], sheet) || is_round(behind[0], behind[1], sheet);
    }

private:
    struct Side {
        double distance, angle; ///< from a line; of the normal about it
    };
    using SidesOfLine = std::array<std::vector<Side>, 2>; ///< facing it, facing away

    static bool is_round(const std::vector<Side>& own, const std::vector<Side>& others, double sheet) {
        const auto nearest = [](const std::vector<Side>& sides) {
            double least = std::numeric_limits<double>::infinity();
            for (const Side& side : sides) least = std::min(least, side.distance);
            return least;
        };
        if (sheet < nearest(own)) return false;
        const double other = nearest(others);
        std::vector<double> angles;
        for (const Side& side : own)
            if (side.distance < other) angles.push_back(side.angle);
        return stand_round(angles);
    }

    const Octree& octree_;
    const OctreeLevel& level_;
    std::span<const Index> voxels_;
    std::size_t count_ = 0;
};

} // namespace

void ask_points_at_bars(const Octree& octree, const OctreeLevel& level, const GridPoints& grid,
                        Crossings& crossings) {
    for_each_index(crossings.moved.size(), chunks::slow, [&](Index i) {
        const Index edge = crossings.moved[i].edge;
        if (crossings.on_edge(edge).empty()) return;
        std::vector<Index> voxels;
        for (const Index end : {edge / 3, grid.next[edge / 3][edge % 3]})
            std::ranges::copy_if(grid.voxels[end], std::back_inserter(voxels),
                                 [](Index v) { return v != no_index; });
        sort_unique(voxels);
        const PointsAround points(octree, level, voxels);
        if (points.are_none()) return;
        for (Index x = crossings.first[edge]; x < crossings.first[edge + 1]; ++x) {
            Crossing& crossing = crossings.crossings[x];
            const Vec3 at = crossing_position(grid, crossing, level.voxel_size);
            if (!points.have(at, crossing.normal) || points.is_passed(at, crossing.normal))
                crossing.standing = crossing.supported = false;
        }
    });
}

} // namespace hsdm
