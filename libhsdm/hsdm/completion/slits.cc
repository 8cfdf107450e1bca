#include "hsdm/completion/slits.hh"

#include "hsdm/completion/constants.hh"
#include "hsdm/core/chunks.hh"
#include "hsdm/core/constants.hh"
#include "hsdm/mesh/area_vector.hh"
#include "hsdm/mesh/split_polygon.hh"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace hsdm {
namespace {

/// What closes a loop with edges as short and bends as small as can be; empty if nothing does.
Pieces triangles_over(const PolygonMesh& mesh, std::span<const Index> loop, std::span<const Vec3> beside,
                      const EdgeSet& none) {
    return split_polygon(mesh, loop, beside, none, {.max_bend = std::numbers::pi, .quads = false});
}

/// Unit normals of the facets at a loop's sides.
std::vector<Vec3> normals_beside(const PolygonMesh& mesh, std::span<const Index> facets) {
    std::vector<Vec3> normals;
    for (Index f : facets) normals.push_back(unit(area_vector(mesh, mesh.facet(f))));
    return normals;
}

/// Sums over what closes a loop.
struct Closing {
    double area = 0, length = 0, agreeing = 0;
    Eigen::Matrix3d facing = Eigen::Matrix3d::Zero(); ///< squares of the normals beside, by length

    Closing(const PolygonMesh& mesh, std::span<const Index> loop, std::span<const Vec3> beside,
            const Pieces& triangles) {
        const auto next = [&](std::size_t i) { return i + 1 == loop.size() ? 0 : i + 1; };
        std::vector<std::pair<Index, std::size_t>> places; // of the loop's vertices, which are all different
        for (std::size_t i = 0; i < loop.size(); ++i) places.emplace_back(loop[i], i);
        std::sort(places.begin(), places.end());
        for (const auto& triangle : triangles) {
            const Vec3 twice = area_vector(mesh, triangle);
            area += 0.5 * twice.norm();
            for (std::size_t c = 0; c < 3; ++c) {
                const Index from = triangle[c], to = triangle[(c + 1) % 3];
                const std::size_t i =
                    std::lower_bound(places.begin(), places.end(), std::pair(from, std::size_t{0}))->second;
                if (loop[next(i)] != to) continue;
                const double side = (mesh.positions[to] - mesh.positions[from]).norm();
                const Eigen::Vector3d normal{beside[i][0], beside[i][1], beside[i][2]};
                length += side;
                agreeing += side * (unit(twice) | beside[i]);
                facing += side * normal * normal.transpose();
            }
        }
    }

    /// As long and narrow as a rectangle of that ratio.
    bool is_slender() const {
        const double perimeter = 2 * (slits::least_ratio + 1);
        return length * length * slits::least_ratio >= perimeter * perimeter * area;
    }

    /// Between two sheets that face apart, not round the end of a pipe: of the sides of a rectangle of that
    /// ratio as many face one way or back.
    bool is_lip() const {
        Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen;
        eigen.computeDirect(facing, Eigen::EigenvaluesOnly);
        return agreeing < angles::facing * length
               && eigen.eigenvalues()[2] * (slits::least_ratio + 1) >= slits::least_ratio * length;
    }

    bool is_slit(double widest) const {
        return 4 * area <= widest * length && agreeing > angles::opposed * length
               && (is_slender() || is_lip());
    }
};

/// Points of a triangle: n (n + 1) / 2 of the n^2 alike ones that it consists of have one each.
void add_points_of(const std::array<Vec3, 3>& triangle, double voxel_size, CompletedPoints& points) {
    const auto& [a, b, c] = triangle;
    const Vec3 twice = (b - a) % (c - a);
    if (!(twice.norm() > 0)) return;
    const int n =
        std::max(1, static_cast<int>(std::ceil(std::sqrt(twice.norm()) * completing::samples / voxel_size)));
    for (int i = 0; i < n; ++i)
        for (int k = 0; i + k < n; ++k) {
            points.positions.push_back(a + (b - a) * ((i + 1.0 / 3) / n) + (c - a) * ((k + 1.0 / 3) / n));
            points.normals.push_back(unit(twice));
        }
}

} // namespace

Slits find_slits(const PolygonMesh& mesh, const BoundaryLoops& loops, double widest) {
    std::vector<Pieces> closing(loops.size());
    const EdgeSet none(PolygonMesh(), {});
    for_each_task(loops.size(), [&](std::size_t l) {
        const auto loop = loops[l];
        // What closes a loop has at least the area of the loop's area vector: most borders need not be
        // filled.
        if (loop.size() < 3 || loop.size() > slits::most_edges
            || 2 * area_vector(mesh, loop).norm() > widest * length_of(mesh, loop))
            return;
        const std::vector<Vec3> beside =
            normals_beside(mesh, {loops.facets.data() + loops.begin[l], loop.size()});
        Pieces triangles = triangles_over(mesh, loop, beside, none);
        if (!triangles.empty() && Closing(mesh, loop, beside, triangles).is_slit(widest))
            closing[l] = std::move(triangles);
    });
    Slits result;
    for (std::size_t l = 0; l < loops.size(); ++l) {
        if (closing[l].empty()) continue;
        for (Index i = loops.begin[l]; i < loops.begin[l + 1]; ++i) {
            result.loops.vertices.push_back(loops.vertices[i]);
            result.loops.facets.push_back(loops.facets[i]);
        }
        result.loops.begin.push_back(static_cast<Index>(result.loops.vertices.size()));
        for (const auto& t : closing[l])
            result.closing.push_back({mesh.positions[t[0]], mesh.positions[t[1]], mesh.positions[t[2]]});
    }
    return result;
}

CompletedPoints points_across(const Slits& slits, double voxel_size) {
    CompletedPoints points;
    for (const auto& triangle : slits.closing) add_points_of(triangle, voxel_size, points);
    return points;
}

CompletedPoints points_across(const PolygonMesh& triangles, double voxel_size) {
    const double side = voxel_size / completing::samples;
    CompletedPoints points;
    for (std::size_t f = 0; f < triangles.facet_count(); ++f) {
        const auto corners = triangles.facet(f);
        const auto& at = triangles.positions;
        const std::array<Vec3, 3> triangle{at[corners[0]], at[corners[1]], at[corners[2]]};
        // Of less than a tenth of the area that a point stands for the normal says nothing.
        if (area_vector(triangles, corners).norm() > 0.2 * side * side)
            add_points_of(triangle, voxel_size, points);
    }
    return points;
}

} // namespace hsdm
