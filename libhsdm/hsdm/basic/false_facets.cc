#include "hsdm/basic/false_facets.hh"

#include "hsdm/spatial/point_triangle.hh"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace hsdm {
namespace {

Vec3 center_of(const ConnectivityGraph& graph, std::span<const Index> vertices) {
    Vec3 sum(0, 0, 0);
    for (Index v : vertices) sum += graph.positions[v];
    return sum / static_cast<double>(vertices.size());
}

bool touches(const VoxelCoord& a, const VoxelCoord& b) {
    return std::abs(a[0] - b[0]) <= 1 && std::abs(a[1] - b[1]) <= 1 && std::abs(a[2] - b[2]) <= 1;
}

VoxelCoord cell_of(const Vec3& p, double voxel_size) {
    VoxelCoord c;
    for (unsigned k = 0; k < 3; ++k) c[k] = static_cast<std::int32_t>(std::floor(p[k] / voxel_size));
    return c;
}

struct Triangle3 {
    Vec3 a, b, c;
};

/// Separating axes: the box's faces, the triangle's plane, and the products of their edges.
bool intersects_box(const Triangle3& t, const Vec3& center, double half) {
    const std::array<Vec3, 3> v{t.a - center, t.b - center, t.c - center};
    auto separated = [&](const Vec3& axis) {
        const double r = half * (std::abs(axis[0]) + std::abs(axis[1]) + std::abs(axis[2]));
        const auto [lo, hi] = std::minmax({axis | v[0], axis | v[1], axis | v[2]});
        return lo > r || hi < -r;
    };
    const std::array<Vec3, 3> unit{Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1)};
    for (const Vec3& axis : unit)
        if (separated(axis)) return false;
    if (separated((v[1] - v[0]) % (v[2] - v[0]))) return false;
    for (unsigned i = 0; i < 3; ++i)
        for (const Vec3& axis : unit)
            if (separated((v[(i + 1) % 3] - v[i]) % axis)) return false;
    return true;
}

/// A facet as triangles around its centre.
std::vector<Triangle3> fan(const ConnectivityGraph& graph, std::span<const Index> vertices) {
    const Vec3 center = center_of(graph, vertices);
    std::vector<Triangle3> triangles;
    for (std::size_t i = 0; i < vertices.size(); ++i)
        triangles.push_back(
            {graph.positions[vertices[i]], graph.positions[vertices[(i + 1) % vertices.size()]], center});
    return triangles;
}

/// From the edge into the facet, perpendicular to the edge.
Vec3 into_facet(const ConnectivityGraph& graph, const Vec3& origin, const Vec3& axis,
                std::span<const Index> vertices) {
    const Vec3 d = center_of(graph, vertices) - origin;
    return d - axis * (d | axis);
}

} // namespace

Vec3 facet_area(const ConnectivityGraph& graph, std::span<const Index> vertices) {
    const Vec3& origin = graph.positions[vertices[0]];
    Vec3 sum(0, 0, 0);
    for (std::size_t i = 1; i + 1 < vertices.size(); ++i)
        sum += (graph.positions[vertices[i]] - origin) % (graph.positions[vertices[i + 1]] - origin);
    return sum * 0.5;
}

bool hits_neighbor_voxel(const OctreeLevel& level, const ConnectivityGraph& graph,
                         std::span<const Index> vertices) {
    const Vec3 from = center_of(graph, vertices), along = facet_area(graph, vertices);
    if (along.sqrnorm() == 0) return false;
    const double h = level.voxel_size;
    VoxelCoord cell = cell_of(from, h);
    std::array<double, 3> next, step;
    for (unsigned k = 0; k < 3; ++k) {
        const double wall = (cell[k] + (along[k] > 0)) * h;
        next[k] = along[k] != 0 ? (wall - from[k]) / along[k] : Box::inf;
        step[k] = along[k] != 0 ? h / std::abs(along[k]) : Box::inf;
    }
    // The ray leaves the neighbourhood of at most max_loop_edges voxels after a few cells.
    for (;;) {
        const auto k = static_cast<unsigned>(std::min_element(next.begin(), next.end()) - next.begin());
        cell[k] += along[k] > 0 ? 1 : -1;
        next[k] += step[k];
        const auto coord = [&](Index v) { return level.coord(graph.voxel[v]); };
        if (std::none_of(vertices.begin(), vertices.end(), [&](Index v) { return touches(cell, coord(v)); }))
            return false;
        const Index voxel = level.find(cell);
        if (voxel != no_index && std::none_of(vertices.begin(), vertices.end(), [&](Index v) {
                return graph.voxel[v] == voxel;
            }))
            return true;
    }
}

double deviation_from_close_points(const Octree& octree, const OctreeLevel& level,
                                   const ConnectivityGraph& graph, std::span<const Index> vertices) {
    const std::vector<Triangle3> triangles = fan(graph, vertices);
    std::vector<PreparedTriangle> prepared;
    for (const Triangle3& t : triangles) prepared.emplace_back(t.a, t.b, t.c);
    const double h = level.voxel_size;
    Box box;
    for (Index v : vertices) box.add(graph.positions[v]);
    const VoxelCoord lo = cell_of(box.lo, h), hi = cell_of(box.hi, h);
    double deviation = 0;
    for (std::int32_t z = lo[2]; z <= hi[2]; ++z)
        for (std::int32_t y = lo[1]; y <= hi[1]; ++y)
            for (std::int32_t x = lo[0]; x <= hi[0]; ++x) {
                const Index voxel = level.find(VoxelCoord{x, y, z});
                const Vec3 center = Vec3(x + 0.5, y + 0.5, z + 0.5) * h;
                if (voxel == no_index
                    || std::none_of(triangles.begin(), triangles.end(),
                                    [&](const Triangle3& t) { return intersects_box(t, center, h / 2); }))
                    continue;
                for (Index p = level.first_point[voxel]; p < level.first_point[voxel + 1]; ++p) {
                    double nearest = Box::inf;
                    for (const PreparedTriangle& t : prepared)
                        nearest = std::min(nearest, t.nearest(octree.positions[p]).squared_distance);
                    deviation = std::max(deviation, nearest);
                }
            }
    return std::sqrt(deviation);
}

double outer_angle(const ConnectivityGraph& graph, Index from, Index to, std::span<const Index> previous,
                   std::span<const Index> candidate) {
    const Vec3& origin = graph.positions[from];
    Vec3 axis = graph.positions[to] - origin;
    axis /= std::max(axis.norm(), std::numeric_limits<double>::min());
    const Vec3 x = into_facet(graph, origin, axis, previous), d = into_facet(graph, origin, axis, candidate);
    // `previous` runs against the axis, so its normal points along x % axis.
    const double angle = std::atan2(d | (x % axis), d | x);
    return angle > 0 ? angle : angle + 2 * std::numbers::pi;
}

} // namespace hsdm
