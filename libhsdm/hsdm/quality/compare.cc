#include "hsdm/quality/compare.hh"

#include "hsdm/cloud/cloud_frame.hh"
#include "hsdm/errors.hh"
#include "hsdm/point_cloud.hh"
#include "hsdm/quality/distance_to_surface.hh"
#include "hsdm/spatial/mesh_distance.hh"

namespace hsdm {
namespace {

/// A cloud's points as facets without extent: the nearest facet is then the nearest point.
PolygonMesh as_facets(const PolygonMesh& cloud) {
    PolygonMesh mesh;
    mesh.positions = cloud.positions;
    mesh.corners.reserve(3 * cloud.vertex_count());
    mesh.first.reserve(cloud.vertex_count() + 1);
    for (Index v = 0; v < cloud.vertex_count(); ++v) mesh.add_facet(std::array<Index, 3>{v, v, v});
    return mesh;
}

MeshDistance distance_to(const PolygonMesh& mesh) {
    return MeshDistance(mesh.facet_count() > 0 ? mesh : as_facets(mesh));
}

PolygonMesh scaled(PolygonMesh mesh, double factor) {
    for (Vec3& p : mesh.positions) p *= factor;
    return mesh;
}

Distance one_sided(const PolygonMesh& from, const MeshDistance& to, std::size_t samples) {
    if (from.facet_count() == 0) return points_to_mesh(from.positions, to);
    const Distance of_vertices = points_to_mesh(from.positions, to);
    const std::vector<Vec3> spread = sample_surface(from, samples);
    if (spread.empty()) return of_vertices; // no area to spread them over
    Distance distance = points_to_mesh(spread, to);
    distance.max = std::max(distance.max, of_vertices.max);
    return distance;
}

} // namespace

Comparison compare(const PolygonMesh& a, const PolygonMesh& b, const CompareOptions& options) {
    if (a.vertex_count() == 0 || b.vertex_count() == 0)
        throw Error("nothing to compare: one of the two holds no point");
    if (options.samples == 0) throw OptionError("samples 0: must be at least 1");
    if (!all_finite(a.positions) || !all_finite(b.positions))
        throw Error("nothing to compare with: one of the two holds coordinates that are not finite");
    Box box = bounds_of(a.positions);
    box.add(bounds_of(b.positions));
    const CloudFrame frame(box);
    frame.check_reach();
    if (const double unit = frame.unit(); unit != 1) {
        Comparison result = compare(scaled(a, 1 / unit), scaled(b, 1 / unit), options);
        for (Distance* distance : {&result.a_to_b, &result.b_to_a})
            for (double* length : {&distance->max, &distance->mean, &distance->rms}) *length *= unit;
        result.diagonal *= unit;
        return result;
    }
    Comparison result;
    result.a_to_b = one_sided(a, distance_to(b), options.samples);
    result.b_to_a = one_sided(b, distance_to(a), options.samples);
    result.diagonal = box.diagonal();
    return result;
}

} // namespace hsdm
