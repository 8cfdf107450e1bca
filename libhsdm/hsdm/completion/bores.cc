#include "hsdm/completion/bores.hh"

#include "hsdm/completion/constants.hh"
#include "hsdm/core/chunks.hh"
#include "hsdm/core/constants.hh"
#include "hsdm/core/large_vector.hh"
#include "hsdm/mesh/area_vector.hh"
#include "hsdm/normals/plane_fit.hh"
#include "hsdm/spatial/mesh_distance.hh"
#include "hsdm/spatial/self_intersections.hh"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

namespace hsdm {
namespace {

/// A side of a boundary loop.
struct BorderSide {
    Vec3 middle, normal, beyond; ///< `beyond` points away from the facet beside it, as long as the side
    double length;
};

std::vector<BorderSide> sides_of(const PolygonMesh& mesh, const BoundaryLoops& loops, std::size_t l) {
    const auto loop = loops[l];
    std::vector<BorderSide> sides;
    for (std::size_t i = 0; i < loop.size(); ++i) {
        const Vec3 &from = mesh.positions[loop[i]], &to = mesh.positions[loop[(i + 1) % loop.size()]];
        const Vec3 normal = unit(area_vector(mesh, mesh.facet(loops.facets[loops.begin[l] + i])));
        // The facet beside the loop runs against it.
        sides.push_back({0.5 * (from + to), normal, normal % (to - from), (to - from).norm()});
    }
    return sides;
}

/// A straight wall round an axis that it faces, as far as a loop tells.
struct BoreWall {
    Vec3 centre{0, 0, 0}, axis{0, 0, 0}; ///< the axis is a unit vector, of either sign
    double radius = 0;
};

/// The axis is the one least along the normals. None where the mesh beside the loop is no such wall, as at
/// the end of a rod, which faces away from its axis.
std::optional<BoreWall> wall_of(const std::vector<BorderSide>& sides) {
    BoreWall wall;
    PlaneSums normals;
    double length = 0;
    for (const BorderSide& side : sides) {
        length += side.length;
        wall.centre += side.length * side.middle;
        normals.add(side.normal, 0.5 * side.length);
        normals.add(-side.normal, 0.5 * side.length);
    }
    if (!(length > 0)) return {};
    wall.centre /= length;
    const PlaneFit fit = fit_plane(normals);
    if (fit.normal.sqrnorm() == 0 || fit.variance > angles::half_of_sheet * angles::half_of_sheet) return {};
    wall.axis = fit.normal;
    double inward = 0;
    for (const BorderSide& side : sides) {
        Vec3 out = side.middle - wall.centre;
        out -= wall.axis * (out | wall.axis);
        wall.radius += side.length / length * out.norm();
        inward -= side.length * (side.normal | unit(out));
    }
    // 0.88 of a square bore, 0.62 of a slot four times as long as wide, negative of a rod.
    if (inward < angles::facing * length) return {};
    return wall;
}

/// Sides from `begin` on, round the loop.
struct Run {
    std::size_t begin = 0, count = 0;
};

/// Do most of the sides of a run go on along the axis?
bool goes_on(const std::vector<BorderSide>& sides, const Run& run, const Vec3& axis) {
    double along = 0, length = 0;
    for (std::size_t i = 0; i < run.count; ++i) {
        const BorderSide& side = sides[(run.begin + i) % sides.size()];
        along += side.beyond | axis;
        length += side.length;
    }
    // Midway: of a border that zigzags at right angles it is 0.7, of a hole in a wall 0.
    return length > 0 && along >= angles::halfway / 2 * length;
}

/// The run of sides that goes on farthest along the axis, all in all: a run between the first and the last
/// side, or all but the run that goes back farthest (Kadane's algorithm for both).
Run farthest_run(const std::vector<BorderSide>& sides, const Vec3& axis) {
    const auto farthest = [&](const Vec3& way) {
        std::pair<double, Run> best;
        Run now;
        double sum = 0;
        for (std::size_t i = 0; i < sides.size(); ++i) {
            if (sum <= 0) now = {i, 0}, sum = 0;
            sum += sides[i].beyond | way;
            ++now.count;
            if (sum > best.first) best = {sum, now};
        }
        return best;
    };
    const auto [there, run] = farthest(axis);
    const auto [back, rest] = farthest(-axis);
    double all = 0;
    for (const BorderSide& side : sides) all += side.beyond | axis;
    if (all + back <= there) return run;
    return {(rest.begin + rest.count) % sides.size(), sides.size() - rest.count};
}

/// A loop all of whose sides are one end of a bore.
struct BoreEnd {
    Index loop = 0;
    BoreWall wall; ///< its axis points beyond the end

    /// Does this one go on to the other?
    bool leads_to(const BoreEnd& other) const {
        const Vec3 way = other.wall.centre - wall.centre;
        const double along = way | wall.axis,
                     most = bores::most_miss * std::min(wall.radius, other.wall.radius);
        return along > 0 && (way - wall.axis * along).norm() <= most
               && std::abs(wall.radius - other.wall.radius) <= most;
    }
};

/// Numbers of a loop's vertices, one after the other: those of a run of its sides.
std::vector<Index> vertices_of(std::span<const Index> loop, const Run& run) {
    std::vector<Index> vertices;
    for (std::size_t i = 0; i <= run.count; ++i) vertices.push_back(loop[(run.begin + i) % loop.size()]);
    return vertices;
}

/// What is ruled between two rows of vertices, of which the first runs as the border does and the second
/// against it: rungs from the one to the other, of which the next is always the one less askew to the axis.
class RuledWall {
public:
    RuledWall(const PolygonMesh& mesh, std::vector<Index> forward, std::vector<Index> back, const Vec3& axis)
        : mesh_(mesh), forward_(std::move(forward)), back_(std::move(back)), axis_(axis) {}

    /// Appends its triangles to walls, with sides of at most a step along the rungs.
    void add_to(PolygonMesh& walls, double step) const {
        const std::vector<Rung> rungs = all_rungs();
        double longest = 0;
        for (const Rung& rung : rungs) longest = std::max(longest, way(rung).norm());
        const auto steps = std::max(std::size_t{1}, static_cast<std::size_t>(std::ceil(longest / step)));
        for (std::size_t r = 0; r + 1 < rungs.size(); ++r)
            for (std::size_t s = 0; s < steps; ++s) add_between(rungs[r], rungs[r + 1], s, steps, walls);
    }

private:
    using Rung = std::array<std::size_t, 2>; // places in both rows

    std::vector<Rung> all_rungs() const {
        std::vector<Rung> rungs{{0, 0}};
        for (;;) {
            const Rung& rung = rungs.back();
            const bool at_end = rung[0] + 1 == forward_.size(), back_at_end = rung[1] + 1 == back_.size();
            if (at_end && back_at_end) return rungs;
            const Rung next{rung[0] + 1, rung[1]}, other{rung[0], rung[1] + 1};
            rungs.push_back(back_at_end || (!at_end && askew(next) <= askew(other)) ? next : other);
        }
    }
    Vec3 way(const Rung& r) const { return mesh_.positions[back_[r[1]]] - mesh_.positions[forward_[r[0]]]; }
    double askew(const Rung& r) const { return (way(r) % axis_).norm(); }
    Vec3 place(const Rung& r, std::size_t step, std::size_t steps) const {
        const double share = static_cast<double>(step) / static_cast<double>(steps);
        return mesh_.positions[forward_[r[0]]] * (1 - share) + mesh_.positions[back_[r[1]]] * share;
    }
    void add_between(const Rung& one, const Rung& next, std::size_t s, std::size_t steps,
                     PolygonMesh& walls) const {
        const Vec3 from = place(one, s, steps), to = place(next, s, steps);
        const Vec3 beyond = place(one, s + 1, steps), beyond_to = place(next, s + 1, steps);
        if (s > 0 || one[0] != next[0]) add({from, to, beyond}, walls);
        if (s + 1 < steps || one[1] != next[1]) add({to, beyond_to, beyond}, walls);
    }
    static void add(const std::array<Vec3, 3>& triangle, PolygonMesh& walls) {
        if (((triangle[1] - triangle[0]) % (triangle[2] - triangle[0])).sqrnorm() == 0) return;
        const auto first = static_cast<Index>(walls.vertex_count());
        walls.positions.insert(walls.positions.end(), triangle.begin(), triangle.end());
        walls.add_facet(std::array{first, first + 1, first + 2});
    }

    const PolygonMesh& mesh_;
    std::vector<Index> forward_, back_;
    Vec3 axis_;
};

/// What loops tell.
struct LoopEnds {
    std::optional<BoreEnd> one;
    std::optional<std::array<Run, 2>> both; ///< of a loop that is both ends of a bore
    Vec3 axis{0, 0, 0};
};

LoopEnds ends_of(const PolygonMesh& mesh, const BoundaryLoops& loops, std::size_t l) {
    const std::vector<BorderSide> sides = sides_of(mesh, loops, l);
    std::optional<BoreWall> wall = wall_of(sides);
    LoopEnds ends;
    if (!wall) return ends;
    Vec3 beyond(0, 0, 0);
    for (const BorderSide& side : sides) beyond += side.beyond;
    if ((beyond | wall->axis) < 0) wall->axis = -wall->axis;
    ends.axis = wall->axis;
    if (goes_on(sides, {0, sides.size()}, wall->axis)) {
        ends.one = BoreEnd{static_cast<Index>(l), *wall};
        return ends;
    }
    const Run there = farthest_run(sides, wall->axis);
    const Run back{(there.begin + there.count) % sides.size(), sides.size() - there.count};
    if (goes_on(sides, there, wall->axis) && goes_on(sides, back, -wall->axis)) ends.both = {there, back};
    return ends;
}

void join_ends(const PolygonMesh& mesh, const BoundaryLoops& loops, const BoreEnd& a, const BoreEnd& b,
               double step, PolygonMesh& walls) {
    const auto loop = loops[a.loop], other = loops[b.loop];
    const Vec3 axis = unit(a.wall.axis - b.wall.axis);
    const auto askew = [&](Index v) { return ((mesh.positions[v] - mesh.positions[loop[0]]) % axis).norm(); };
    const auto nearest = std::ranges::min_element(other, {}, askew) - other.begin();
    std::vector<Index> back = vertices_of(other, {static_cast<std::size_t>(nearest), other.size()});
    std::ranges::reverse(back);
    RuledWall(mesh, vertices_of(loop, {0, loop.size()}), std::move(back), axis).add_to(walls, step);
}

/// Per end, the nearest that leads to it and that it leads to; their number if there is none.
std::vector<std::size_t> nearest_of(const std::vector<BoreEnd>& ends) {
    std::vector<std::size_t> nearest(ends.size(), ends.size());
    for_each_index(ends.size(), chunks::heavy, [&](std::size_t i) {
        double least = Box::inf;
        for (std::size_t k = 0; k < ends.size(); ++k) {
            const double far = (ends[k].wall.centre - ends[i].wall.centre).norm();
            if (k != i && far < least && ends[i].leads_to(ends[k]) && ends[k].leads_to(ends[i]))
                least = far, nearest[i] = k;
        }
    });
    return nearest;
}

/// Does it hold at the middle of more than half of a wall's triangles?
bool is_mostly(const std::function<bool(const Vec3&)>& empty, const PolygonMesh& wall) {
    std::size_t count = 0;
    for (std::size_t v = 0; v < wall.vertex_count(); v += 3)
        count += empty((wall.positions[v] + wall.positions[v + 1] + wall.positions[v + 2]) / 3);
    return 2 * count > wall.facet_count();
}

/// A wall and the loops that it closes.
struct FoundBore {
    PolygonMesh wall;
    std::vector<Index> loops;
};

/// Adds the vertices and triangles of a wall, each of which has its own.
void append_wall(const PolygonMesh& wall, PolygonMesh& walls) {
    const auto first = static_cast<Index>(walls.vertex_count());
    append_large(walls.positions, wall.positions);
    for (Index v = first; v < walls.vertex_count(); v += 3) walls.add_facet(std::array{v, v + 1, v + 2});
}

/// Per bore, does its wall meet that of another one, or the border of something else that enters it: one of
/// half as many edges as its own, at least, most of which lies on it? Layers of scans have small ones all
/// over.
std::vector<std::uint8_t> met_bores(const std::vector<FoundBore>& bores, const PolygonMesh& mesh,
                                    const BoundaryLoops& loops, double voxel_size) {
    std::vector<std::uint8_t> met(bores.size()), closed(loops.size());
    PolygonMesh walls;
    std::vector<Index> bore_of; // per triangle
    for (std::size_t b = 0; b < bores.size(); ++b) {
        append_wall(bores[b].wall, walls);
        bore_of.resize(walls.facet_count(), static_cast<Index>(b));
        for (const Index l : bores[b].loops) closed[l] = 1;
    }
    for (const auto& [one, other] : find_self_intersections(walls).facet_pairs)
        if (bore_of[one] != bore_of[other]) met[bore_of[one]] = met[bore_of[other]] = 1;
    const MeshDistance distance(walls);
    for (std::size_t l = 0; l < loops.size(); ++l) {
        if (closed[l] != 0) continue;
        std::vector<Index> near; // bores, one per vertex that has one
        Index hint = no_index;
        for (const Index v : loops[l])
            if (const Index t = distance.triangle_within(mesh.positions[v], voxel_size, hint); t != no_index)
                near.push_back(bore_of[distance.facet_of(t)]);
        std::ranges::sort(near);
        for (auto at = near.begin(); at != near.end();) {
            const auto end = std::upper_bound(at, near.end(), *at);
            const bool is_most = 2 * (end - at) >= std::ssize(loops[l]);
            if (is_most && 2 * loops[l].size() >= loops[bores[*at].loops[0]].size()) met[*at] = 1;
            at = end;
        }
    }
    return met;
}

} // namespace

Bores find_bores(const PolygonMesh& mesh, const BoundaryLoops& loops, double voxel_size,
                 const std::function<bool(const Vec3&)>& empty) {
    std::vector<LoopEnds> found(loops.size());
    for_each_task(loops.size(), [&](std::size_t l) { found[l] = ends_of(mesh, loops, l); });
    std::vector<FoundBore> bores;
    const auto take = [&](PolygonMesh wall, std::vector<Index> closed) {
        if (!empty || !is_mostly(empty, wall)) bores.push_back({std::move(wall), std::move(closed)});
    };
    std::vector<BoreEnd> ends;
    for (std::size_t l = 0; l < loops.size(); ++l) {
        if (found[l].one) ends.push_back(*found[l].one);
        if (!found[l].both) continue;
        const auto& [there, back] = *found[l].both;
        std::vector<Index> row = vertices_of(loops[l], back);
        std::ranges::reverse(row);
        PolygonMesh wall;
        RuledWall(mesh, vertices_of(loops[l], there), std::move(row), found[l].axis).add_to(wall, voxel_size);
        take(std::move(wall), {static_cast<Index>(l)});
    }
    const std::vector<std::size_t> nearest = nearest_of(ends);
    for (std::size_t i = 0; i < ends.size(); ++i) {
        const std::size_t k = nearest[i];
        if (k == ends.size() || k < i || nearest[k] != i) continue;
        PolygonMesh wall;
        join_ends(mesh, loops, ends[i], ends[k], voxel_size, wall);
        take(std::move(wall), {ends[i].loop, ends[k].loop});
    }
    Bores result;
    if (bores.empty()) return result;
    const std::vector<std::uint8_t> met = met_bores(bores, mesh, loops, voxel_size);
    for (std::size_t b = 0; b < bores.size(); ++b) {
        if (met[b] != 0) continue;
        append_wall(bores[b].wall, result.walls);
        append_large(result.loops, bores[b].loops);
    }
    return result;
}

} // namespace hsdm
