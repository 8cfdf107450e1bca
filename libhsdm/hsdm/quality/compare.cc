#include "hsdm/quality/compare.hh"

#include "hsdm/cloud/cloud_frame.hh"
#include "hsdm/errors.hh"
#include "hsdm/point_cloud.hh"
#include "hsdm/quality/distance_to_surface.hh"
#include "hsdm/spatial/mesh_distance.hh"
#include "hsdm/spatial/neighbor_search.hh"

#include <cmath>
#include <optional>

namespace hsdm {
namespace {

/// One of the two: points, and the facets over them if it is a mesh.
struct Side {
    std::span<const Vec3> points;
    const PolygonMesh* mesh = nullptr;
};

Side side_of(const PolygonMesh& mesh) {
    return {mesh.positions, mesh.facet_count() > 0 ? &mesh : nullptr};
}

/// What distances are taken to: facets or points.
class Target {
public:
    explicit Target(const Side& side) {
        if (side.mesh)
            facets_.emplace(*side.mesh);
        else
            points_.emplace(side.points);
    }
    std::vector<double> squared_distances(std::span<const Vec3> from) const {
        if (facets_) return hsdm::squared_distances(from, *facets_);
        std::vector<double> distances = points_->nearest(from, 1).distance;
        for (double& d : distances) d *= d;
        return distances;
    }

private:
    std::optional<MeshDistance> facets_;
    std::optional<NeighborSearch> points_;
};

struct OneSided {
    Distance distance;
    Percentiles percentiles;
};

/// `unit`: of the sides' lengths, in those of the result.
OneSided one_sided(const Side& from, const Target& to, std::size_t samples, double unit) {
    std::vector<double> lengths = to.squared_distances(from.points);
    double of_vertices = 0;
    if (from.mesh) {
        const std::vector<Vec3> spread = sample_surface(*from.mesh, samples);
        if (!spread.empty()) { // else there is no area to spread them over
            of_vertices = summary_of(lengths).max;
            lengths = to.squared_distances(spread);
        }
    }
    OneSided result;
    result.distance = summary_of(lengths);
    result.distance.max = std::max(result.distance.max, of_vertices);
    for (double* d : {&result.distance.max, &result.distance.mean, &result.distance.rms}) *d *= unit;
    for (double& length : lengths) length = std::sqrt(length) * unit;
    result.percentiles = percentiles_of(std::move(lengths));
    return result;
}

Comparison compare(const Side& a, const Side& b, const CompareOptions& options, double unit) {
    const OneSided there = one_sided(a, Target(b), options.samples, unit);
    const OneSided back = one_sided(b, Target(a), options.samples, unit);
    return {there.distance, back.distance, there.percentiles, back.percentiles, 0};
}

/// A side in other units.
class Scaled {
public:
    Scaled(const Side& side, double factor) {
        if (side.mesh)
            mesh_ = *side.mesh;
        else
            mesh_.positions.assign(side.points.begin(), side.points.end());
        for (Vec3& p : mesh_.positions) p *= factor;
    }
    Side side() const { return side_of(mesh_); }

private:
    PolygonMesh mesh_;
};

Comparison compare(const Side& a, const Side& b, const CompareOptions& options) {
    if (a.points.empty() || b.points.empty())
        throw Error("nothing to compare: one of the two holds no point");
    if (options.samples == 0) throw OptionError("samples 0: must be at least 1");
    if (!all_finite(a.points) || !all_finite(b.points))
        throw Error("nothing to compare with: one of the two holds coordinates that are not finite");
    Box box = bounds_of(a.points);
    box.add(bounds_of(b.points));
    const CloudFrame frame(box);
    frame.check_reach();
    const double unit = frame.unit();
    Comparison result;
    if (unit == 1)
        result = compare(a, b, options, 1);
    else
        result = compare(Scaled(a, 1 / unit).side(), Scaled(b, 1 / unit).side(), options, unit);
    result.diagonal = (box.hi / unit - box.lo / unit).norm() * unit;
    return result;
}

} // namespace

Comparison compare(const PolygonMesh& a, const PolygonMesh& b, const CompareOptions& options) {
    return compare(side_of(a), side_of(b), options);
}

Comparison compare(std::span<const Vec3> a, std::span<const Vec3> b) {
    return compare(Side{a}, Side{b}, {});
}

} // namespace hsdm
