#include "hsdm/quality/distance.hh"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

namespace hsdm {
namespace {

/// Points worked through in order, each beginning where its predecessor's nearest triangle was; also the
/// unit of the sums, so that their rounding does not depend on the number of threads.
constexpr std::size_t chunk = 1 << 11;

struct Sums {
    double max = -1, sum = 0, squares = 0;
    std::size_t farthest = 0;
};

} // namespace

MeshDistance::MeshDistance(const PolygonMesh& mesh) : MeshDistance(mesh, triangulate(mesh)) {}

MeshDistance::MeshDistance(const PolygonMesh& mesh, const Triangulation& cut)
    : tree_(mesh.positions, cut.triangles), facet_(facet_of_triangle(cut)) {}

double MeshDistance::operator()(const Vec3& point) const {
    return std::sqrt(tree_.nearest(point).squared);
}

Distance MeshDistance::operator()(std::span<const Vec3> points, double enough) const {
    Distance distance;
    if (points.empty()) return distance;
    std::vector<Sums> chunks((points.size() + chunk - 1) / chunk);
    tbb::parallel_for(std::size_t{0}, chunks.size(), [&](std::size_t c) {
        Sums sums;
        Index hint = no_index;
        for (std::size_t i = c * chunk; i < std::min(points.size(), (c + 1) * chunk); ++i) {
            const TriangleTree::Nearest nearest = tree_.nearest(points[i], hint, enough * enough);
            hint = nearest.block;
            const double d = std::sqrt(nearest.squared);
            sums.sum += d;
            sums.squares += nearest.squared;
            if (d > sums.max) sums.max = d, sums.farthest = i;
        }
        chunks[c] = sums;
    });
    Sums total;
    for (const Sums& sums : chunks) {
        total.sum += sums.sum;
        total.squares += sums.squares;
        if (sums.max > total.max) total.max = sums.max, total.farthest = sums.farthest;
    }
    const auto n = static_cast<double>(points.size());
    return {total.max, total.sum / n, std::sqrt(total.squares / n), total.farthest};
}

Index MeshDistance::nearest_facet(const Vec3& point) const {
    const Index triangle = tree_.nearest(point).triangle;
    return triangle == no_index ? no_index : facet_[triangle];
}

bool MeshDistance::is_beyond(const Vec3& point, double bound, Index& hint) const {
    const TriangleTree::Nearest nearest = tree_.nearest(point, hint, bound * bound);
    hint = nearest.block;
    return std::sqrt(nearest.squared) > bound;
}

std::vector<Index> MeshDistance::facets_within(std::span<const Vec3> points, double bound) const {
    std::vector<Index> facets(points.size(), no_index);
    tbb::parallel_for(std::size_t{0}, (points.size() + chunk - 1) / chunk, [&](std::size_t c) {
        Index hint = no_index;
        for (std::size_t i = c * chunk; i < std::min(points.size(), (c + 1) * chunk); ++i) {
            const TriangleTree::Nearest nearest = tree_.nearest(points[i], hint, bound * bound);
            hint = nearest.block;
            if (std::sqrt(nearest.squared) <= bound) facets[i] = facet_[nearest.triangle];
        }
    });
    return facets;
}

Distance points_to_mesh(std::span<const Vec3> points, const PolygonMesh& mesh, double enough) {
    return MeshDistance(mesh)(points, enough);
}

std::vector<Vec3> sample_surface(const PolygonMesh& mesh, std::size_t count) {
    const Triangulation cut = triangulate(mesh);
    const std::vector<Vec3>& p = mesh.positions;
    std::vector<double> area(cut.size() + 1, 0.0); // running sum
    for (std::size_t t = 0; t < cut.size(); ++t) {
        const auto& [a, b, c] = cut.triangles[t];
        area[t + 1] = area[t] + ((p[b] - p[a]) % (p[c] - p[a])).norm() / 2;
    }
    std::vector<Vec3> samples;
    if (!(area.back() > 0)) return samples;
    samples.resize(count);
    constexpr std::size_t grain = 1 << 12;
    tbb::parallel_for(std::size_t{0}, (count + grain - 1) / grain, [&](std::size_t c) {
        for (std::size_t i = c * grain; i < std::min(count, (c + 1) * grain); ++i) {
            // Evenly spaced along the running area; inside the triangle the additive recurrence of the two
            // generalised golden ratios of the plane, folded into the triangle.
            const auto n = static_cast<double>(i);
            const double at = (n + 0.5) / static_cast<double>(count) * area.back();
            const auto next = std::upper_bound(area.begin() + 1, area.end() - 1, at);
            const auto& [ia, ib, ic] = cut.triangles[static_cast<std::size_t>(next - area.begin()) - 1];
            double s = std::fmod(0.5 + 0.7548776662466927 * n, 1.0);
            double t = std::fmod(0.5 + 0.5698402909980532 * n, 1.0);
            if (s + t > 1) s = 1 - s, t = 1 - t;
            samples[i] = p[ia] + (p[ib] - p[ia]) * s + (p[ic] - p[ia]) * t;
        }
    });
    return samples;
}

} // namespace hsdm
