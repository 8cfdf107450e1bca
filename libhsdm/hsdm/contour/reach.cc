#include "hsdm/contour/reach.hh"

#include "hsdm/contour/constants.hh"
#include "hsdm/contour/point_fit.hh"
#include "hsdm/core/chunks.hh"
#include "hsdm/core/constants.hh"
#include "hsdm/core/interruption.hh"
#include "hsdm/core/large_vector.hh"
#include "hsdm/mesh/area_vector.hh"
#include "hsdm/mesh/triangulate.hh"
#include "hsdm/spatial/point_triangle.hh"
#include "hsdm/spatial/self_intersections.hh"

#include <algorithm>
#include <functional>
#include <limits>
#include <utility>

namespace hsdm {
namespace {

/// The facets round one voxel as a mesh of their own, and points that they are compared with.
struct VoxelFacets {
    PolygonMesh mesh;
    std::vector<Index> vertices;     // of the whole, ascending
    std::vector<Index> facets;       // ... ascending
    std::vector<Index> voxels;       // the one and those round it, ascending
    std::vector<Index> own, sampled; // points of the one; these and some of those round it
    std::vector<double> weights;     // how many points each of the sampled stands for
    double points = 0;               // in all voxels
};

/// How far points are from facets. Each counts as often as its weight says.
struct Farness {
    double squares = 0;        // sum of squared distances
    double far = 0;            // points that stand out
    double squares_of_far = 0; // of those alone
    double facing = 0;         // sum of the cosines of their normals with those of the nearest triangles
    double farthest = 0;       // largest squared distance
    Index point = no_index;    // the one so far
    Triangle triangle{};       // the nearest one of that

    /// Do enough stand out, and is the rest near beside them? Those that face away from what they are near to
    /// are of the other side of a wall; at a tip the two may be at right angles. They have most of the
    /// squared distances where the rest of the facets fits.
    bool stands_out() const {
        return far >= points_of_plane && facing > -angles::halfway * far && squares_of_far > 0.5 * squares;
    }
};

double total_area(const PolygonMesh& mesh) {
    double sum = 0;
    for (std::size_t f = 0; f < mesh.facet_count(); ++f) sum += 0.5 * area_vector(mesh, mesh.facet(f)).norm();
    return sum;
}

class Reach {
public:
    Reach(const Octree& octree, const OctreeLevel& level, std::span<const Index> voxel,
          std::span<const Index> far, PolygonMesh& mesh)
        : octree_(octree),
          level_(level),
          voxel_(voxel),
          mesh_(mesh),
          squared_far_(relations::smooth_gap * relations::smooth_gap * level.voxel_size * level.voxel_size) {
        std::vector<std::uint8_t> near = large_vector<std::uint8_t>(level.size());
        for (const Index x : far) {
            near[x] = 1;
            for_neighbors(level_, x, [&](Index v) { near[v] = 1; });
        }
        for_each_in_order(mesh.facet_count(), [&](std::size_t f) {
            for (const Index v : mesh.facet(f))
                if (const Index x = voxel[mesh.origin[v]]; x != no_index && near[x])
                    of_voxel_.emplace_back(x, static_cast<Index>(f));
        });
        std::ranges::sort(of_voxel_);
    }

    /// Squared distance of the farthest point of a voxel, if enough points of it and of those round it stand
    /// out; else 0.
    double standing_out(Index x) const {
        const VoxelFacets around = facets_round(x);
        if (around.facets.empty()) return 0;
        const Farness own = measure(around.mesh, around.own, {});
        return own.far > 0 && measure(around.mesh, around.sampled, around.weights).stands_out() ? own.farthest
                                                                                                : 0;
    }

    /// Moves vertices to the points of a voxel, as long as one may move. Returns how many did.
    std::size_t move_to(Index x) {
        std::size_t moved = 0;
        while (move_one(x)) ++moved;
        return moved;
    }

private:
    VoxelFacets facets_round(Index x) const {
        VoxelFacets around;
        around.voxels.push_back(x);
        for_neighbors(level_, x, [&](Index v) { around.voxels.push_back(v); });
        std::ranges::sort(around.voxels);
        for (const Index v : around.voxels) {
            for (auto it = std::ranges::lower_bound(of_voxel_, std::pair{v, Index{0}});
                 it != of_voxel_.end() && it->first == v; ++it)
                around.facets.push_back(it->second);
            const Index first = level_.first_point[v], last = level_.first_point[v + 1];
            around.points += last - first;
            const std::size_t stride = v == x ? 1 : sample_stride(last - first);
            for (std::size_t p = first; p < last; p += stride) {
                around.sampled.push_back(static_cast<Index>(p));
                around.weights.push_back(static_cast<double>(std::min<std::size_t>(stride, last - p)));
                if (v == x) around.own.push_back(static_cast<Index>(p));
            }
        }
        sort_unique(around.facets);
        copy_facets(around);
        return around;
    }

    void copy_facets(VoxelFacets& around) const {
        for (const Index f : around.facets)
            for (const Index v : mesh_.facet(f)) around.vertices.push_back(v);
        sort_unique(around.vertices);
        for (const Index v : around.vertices) around.mesh.positions.push_back(mesh_.positions[v]);
        std::vector<Index> corners;
        for (const Index f : around.facets) {
            corners.clear();
            for (const Index v : mesh_.facet(f))
                corners.push_back(static_cast<Index>(std::ranges::lower_bound(around.vertices, v)
                                                     - around.vertices.begin()));
            around.mesh.add_facet(corners);
        }
    }

    /// Weights are 1 where none are given.
    Farness measure(const PolygonMesh& mesh, std::span<const Index> points,
                    std::span<const double> weights) const {
        Farness result;
        const Triangulation cut = triangulate(mesh);
        std::vector<PreparedTriangle> prepared;
        for (const Triangle& t : cut.triangles)
            prepared.emplace_back(mesh.positions[t[0]], mesh.positions[t[1]], mesh.positions[t[2]]);
        for (std::size_t i = 0; i < points.size(); ++i) {
            const Index p = points[i];
            const double weight = weights.empty() ? 1 : weights[i];
            double least = std::numeric_limits<double>::infinity();
            std::size_t nearest = 0;
            for (std::size_t t = 0; t < prepared.size(); ++t)
                if (const double d = prepared[t].nearest(octree_.positions[p]).squared_distance; d < least)
                    least = d, nearest = t;
            const Triangle& triangle = cut.triangles[nearest];
            result.squares += weight * least;
            if (least > squared_far_) {
                result.far += weight;
                result.squares_of_far += weight * least;
                const Vec3& a = mesh.positions[triangle[0]];
                const Vec3 up = (mesh.positions[triangle[1]] - a) % (mesh.positions[triangle[2]] - a);
                result.facing += weight * (octree_.normals[p] | unit(up));
            }
            if (result.point == no_index || least > result.farthest)
                result.farthest = least, result.point = p, result.triangle = triangle;
        }
        return result;
    }

    bool is_around(Index v, const VoxelFacets& around) const {
        return std::ranges::binary_search(around.voxels, voxel_[mesh_.origin[around.vertices[v]]]);
    }

    /// Of the facets as far as they lie in the voxels: a corner stands for its share of a facet.
    double area_in_voxels(const VoxelFacets& around) const {
        double sum = 0;
        for (std::size_t f = 0; f < around.mesh.facet_count(); ++f) {
            const auto facet = around.mesh.facet(f);
            const auto inside = std::ranges::count_if(facet, [&](Index v) { return is_around(v, around); });
            sum += 0.5 * area_vector(around.mesh, facet).norm() * static_cast<double>(inside)
                   / static_cast<double>(facet.size());
        }
        return sum;
    }

    /// May a vertex move: are all facets at it there, and all round it? At a border points may go on.
    bool is_free(Index v, const VoxelFacets& around) const {
        if (!std::ranges::binary_search(around.voxels, voxel_[mesh_.origin[around.vertices[v]]]))
            return false;
        std::vector<Index> from, to; // at the sides at it
        for (std::size_t f = 0; f < around.mesh.facet_count(); ++f) {
            const std::span<const Index> facet = around.mesh.facet(f);
            for (std::size_t i = 0; i < facet.size(); ++i)
                if (facet[i] == v)
                    from.push_back(facet[(i + facet.size() - 1) % facet.size()]),
                        to.push_back(facet[(i + 1) % facet.size()]);
        }
        std::ranges::sort(from);
        std::ranges::sort(to);
        return from == to;
    }

    /// What a move is judged by.
    struct State {
        Farness own, sampled;
        double area, density; // of all facets; points on a unit of it
    };

    /// Does no facet turn by a right angle when a vertex moves from there?
    static bool keeps_sides(VoxelFacets& around, Index vertex, const Vec3& from) {
        PolygonMesh& mesh = around.mesh;
        for (std::size_t f = 0; f < mesh.facet_count(); ++f) {
            if (std::ranges::find(mesh.facet(f), vertex) == mesh.facet(f).end()) continue;
            const Vec3 now = area_vector(mesh, mesh.facet(f)),
                       to = std::exchange(mesh.positions[vertex], from);
            const Vec3 then = area_vector(mesh, mesh.facet(f));
            mesh.positions[vertex] = to;
            if ((now | then) < 0) return false;
        }
        return true;
    }

    /// May facets that were so become those that they are now? No vertex takes away half of what noise makes.
    bool is_better(const VoxelFacets& around, const State& was) const {
        if (measure(around.mesh, around.own, {}).squares > 0.5 * was.own.squares) return false;
        const Farness is = measure(around.mesh, around.sampled, around.weights);
        if (is.squares > 0.5 * was.sampled.squares || is.farthest >= was.sampled.farthest
            || is.far >= was.sampled.far)
            return false;
        // What the surface has more must have its points, which strays have not.
        const double expected = was.density * (total_area(around.mesh) - was.area);
        return was.sampled.far - is.far >= crossing::fair_share * expected;
    }

    /// Do more facets intersect than before a vertex moved from there?
    static bool is_tangled(VoxelFacets& around, Index vertex, const Vec3& from) {
        const std::size_t now = find_self_intersections(around.mesh).triangle_pairs;
        if (now == 0) return false;
        const Vec3 to = std::exchange(around.mesh.positions[vertex], from);
        const std::size_t then = find_self_intersections(around.mesh).triangle_pairs;
        around.mesh.positions[vertex] = to;
        return now > then;
    }

    bool move_one(Index x) {
        VoxelFacets around = facets_round(x);
        State now{measure(around.mesh, around.own, {}), {}, 0, 0};
        if (now.own.far == 0) return false;
        now.sampled = measure(around.mesh, around.sampled, around.weights);
        if (!now.sampled.stands_out()) return false;
        now.area = total_area(around.mesh);
        now.density = around.points / area_in_voxels(around);
        const Vec3& to = octree_.positions[now.own.point];
        Triangle corners = now.own.triangle;
        std::ranges::sort(corners, {}, [&](Index v) { return (around.mesh.positions[v] - to).sqrnorm(); });
        for (const Index v : corners) {
            if (!is_free(v, around)) continue;
            const Vec3 from = std::exchange(around.mesh.positions[v], to);
            if (keeps_sides(around, v, from) && is_better(around, now) && !is_tangled(around, v, from)) {
                mesh_.positions[around.vertices[v]] = to;
                return true;
            }
            around.mesh.positions[v] = from;
        }
        return false;
    }

    const Octree& octree_;
    const OctreeLevel& level_;
    std::span<const Index> voxel_; // per origin of a vertex
    PolygonMesh& mesh_;
    double squared_far_;
    std::vector<std::pair<Index, Index>> of_voxel_; // voxels and facets that have a vertex there
};

} // namespace

std::size_t reach_points(const Octree& octree, const OctreeLevel& level, std::span<const Index> voxel,
                         std::span<const Index> far, PolygonMesh& mesh) {
    if (far.empty()) return 0;
    Reach reach(octree, level, voxel, far, mesh);
    std::vector<double> out = large_vector<double>(far.size());
    for_each_index(far.size(), chunks::heavy, [&](Index i) { out[i] = reach.standing_out(far[i]); });
    std::vector<Index> wanted = indices_where(far.size(), chunks::usual, [&](Index i) { return out[i] > 0; });
    // Tips come before what is beside them.
    std::ranges::stable_sort(wanted, std::greater(), [&](Index i) { return out[i]; });
    std::size_t moved = 0;
    for (const Index i : wanted) {
        Interruption::poll();
        moved += reach.move_to(far[i]);
    }
    return moved;
}

} // namespace hsdm
