#include "hsdm/quality/deviations.hh"

#include "hsdm/cloud/cloud_frame.hh"
#include "hsdm/core/groups.hh"
#include "hsdm/errors.hh"
#include "hsdm/mesh/facet_normal.hh"
#include "hsdm/spatial/point_triangle.hh"
#include "hsdm/spatial/triangle_tree.hh"

#include <cmath>

namespace hsdm {
namespace {

/// A mesh of triangles with the normals of its triangles, edges and vertices.
class SidedTriangles {
public:
    SidedTriangles(std::span<const Vec3> positions, std::span<const Triangle> triangles)
        : positions_(positions),
          triangles_(triangles),
          round_vertex_(corners_of(triangles), positions.size()) {}

    /// The nearest point of a triangle.
    NearestOfTriangle nearest(Index triangle, const Vec3& point) const {
        const auto [a, b, c] = triangles_[triangle];
        return PreparedTriangle(positions_[a], positions_[b], positions_[c]).nearest(point);
    }

    /// The normal of what the foot lies on, inside of the triangle, on a side or on a corner; of no
    /// particular length.
    Vec3 normal_at(Index triangle, const std::array<double, 3>& weights) const {
        unsigned on = 0, corner = 0, off = 0;
        for (unsigned k = 0; k < 3; ++k) {
            if (weights[k] > 0) {
                ++on;
                corner = k;
            } else {
                off = k;
            }
        }
        const Triangle& t = triangles_[triangle];
        if (on == 3) return normal(t);
        if (on == 1) return vertex_normal(t[corner]);
        return edge_normal(t[(off + 1) % 3], t[(off + 2) % 3]);
    }

private:
    static std::vector<Index> corners_of(std::span<const Triangle> triangles) {
        std::vector<Index> corners;
        corners.reserve(3 * triangles.size());
        for (const Triangle& t : triangles) corners.insert(corners.end(), t.begin(), t.end());
        return corners;
    }

    Vec3 normal(const Triangle& t) const {
        const Vec3& a = positions_[t[0]];
        return unit_or_zero((positions_[t[1]] - a) % (positions_[t[2]] - a));
    }

    Vec3 vertex_normal(Index v) const {
        Vec3 sum(0, 0, 0);
        for (const Index corner : round_vertex_.of(v)) {
            const Triangle& t = triangles_[corner / 3];
            const Vec3& here = positions_[v];
            sum += normal(t)
                   * angle_between(positions_[t[(corner + 1) % 3]] - here,
                                   positions_[t[(corner + 2) % 3]] - here);
        }
        return sum;
    }

    Vec3 edge_normal(Index v, Index w) const {
        Vec3 sum(0, 0, 0);
        for (const Index corner : round_vertex_.of(v)) {
            const Triangle& t = triangles_[corner / 3];
            if (t[0] == w || t[1] == w || t[2] == w) sum += normal(t);
        }
        return sum;
    }

    std::span<const Vec3> positions_;
    std::span<const Triangle> triangles_;
    Groups round_vertex_; // members: 3 * triangle + corner
};

/// Where a point is nearest to the mesh.
struct Foot {
    Index triangle = no_index;
    std::array<double, 3> weights{};
};

/// Means of the points' distances by vertex, NaN where there are none. In the points' order, so that rounding
/// does not depend on threads.
std::vector<double> means_at_vertices(std::span<const Foot> feet, std::span<const double> distances,
                                      std::span<const Triangle> triangles, std::size_t vertices) {
    std::vector<double> sums(vertices, 0), weights(vertices, 0);
    for (std::size_t i = 0; i < feet.size(); ++i)
        for (unsigned k = 0; k < 3 && feet[i].triangle != no_index; ++k) {
            const Index v = triangles[feet[i].triangle][k];
            sums[v] += feet[i].weights[k] * distances[i];
            weights[v] += feet[i].weights[k];
        }
    for (std::size_t v = 0; v < vertices; ++v)
        sums[v] = weights[v] > 0 ? sums[v] / weights[v] : std::numeric_limits<double>::quiet_NaN();
    return sums;
}

/// In units of a power of two in which squares neither overflow nor vanish.
std::vector<Vec3> in_units(std::span<const Vec3> places, double unit) {
    std::vector<Vec3> result(places.begin(), places.end());
    if (unit != 1)
        for (Vec3& p : result) p /= unit;
    return result;
}

} // namespace

Deviations measure_deviations(std::span<const Vec3> points, const PolygonMesh& mesh) {
    const Triangulation cut = triangulate(mesh);
    if (cut.size() == 0) throw Error("a mesh without facets: nothing deviates from it");
    Box box;
    for (const Vec3& p : mesh.positions) box.add(p);
    for (const Vec3& p : points)
        if (is_finite(p)) box.add(p);
    const double unit = CloudFrame(box).unit();
    const std::vector<Vec3> places = in_units(mesh.positions, unit), measured = in_units(points, unit);
    const TriangleTree tree(places, cut.triangles);
    const SidedTriangles sides(places, cut.triangles);

    Deviations result;
    result.of_points.resize(points.size());
    std::vector<Foot> feet(points.size());
    for_chunks(points.size(), chunks::slow, [&](std::size_t begin, std::size_t end, std::size_t) {
        Index hint = no_index;
        for (std::size_t i = begin; i < end; ++i) {
            result.of_points[i] = std::numeric_limits<double>::quiet_NaN();
            if (!is_finite(points[i])) continue;
            hint = tree.nearest(measured[i], hint).triangle;
            const NearestOfTriangle nearest = sides.nearest(hint, measured[i]);
            feet[i] = {hint, nearest.weights};
            const Vec3 away = measured[i] - nearest.point;
            const double side = away | sides.normal_at(hint, nearest.weights);
            result.of_points[i] = std::copysign(away.norm() * unit, side);
        }
    });
    result.at_vertices = means_at_vertices(feet, result.of_points, cut.triangles, places.size());
    return result;
}

} // namespace hsdm
