#include "hsdm/pipeline/measure.hh"

#include "hsdm/cloud/strided.hh"
#include "hsdm/core/chunks.hh"
#include "hsdm/core/interruption.hh"
#include "hsdm/mesh/manifold.hh"
#include "hsdm/mesh/small_components.hh"
#include "hsdm/mesh/to_mesh.hh"
#include "hsdm/mesh/vertex_normals.hh"
#include "hsdm/pipeline/adaptive_grid.hh"
#include "hsdm/pipeline/warnings.hh"
#include "hsdm/quality/distance.hh"
#include "hsdm/quality/distance_to_surface.hh"
#include "hsdm/quality/mesh_digest.hh"
#include "hsdm/quality/topology.hh"
#include "hsdm/spatial/self_intersections.hh"

#include <algorithm>
#include <numbers>

namespace hsdm {
namespace {

void note_small_components(const SmallComponents& small, Report& report) {
    report.rejected["components_small"] = small.components;
    report.rejected["facets_of_small_components"] = small.facets.count;
}

/// On a uniform grid facets are about as large as voxels.
void make_cells(const PolygonMesh& facets, FacetKnowledge& known, const Report& report) {
    if (report.grid.kind == "uniform" && !known.cells) known.cells.emplace(facets, report.grid.voxel_size);
}

/// Distances of the points from the facets, by cells where there are any.
Distance distance_of(std::span<const Vec3> points, const PolygonMesh& facets, FacetKnowledge& known,
                     const DistanceOptions& options, const Report& report) {
    if (report.grid.kind != "uniform") return points_to_mesh(points, facets, options);
    make_cells(facets, known, report);
    return points_to_mesh_by_cells(points, facets, *known.cells, options.beyond);
}

/// Measures the error. Returns the points that the mesh leaves out: those farther from it than a voxel's
/// diagonal, or than the bound, and not because of their noise.
Occurrences measure_error(std::span<const Vec3> points, const MethodInput& in, const PolygonMesh& facets,
                          FacetKnowledge& known, double enough, Report& report) {
    DistanceOptions options{.enough = enough};
    options.beyond = std::max(std::numbers::sqrt3 * report.grid.voxel_size, report.grid.max_error);
    Distance distance = distance_of(points, facets, known, options, report);
    report.error.points_to_mesh_max = distance.max;
    report.error.points_to_mesh_mean = distance.mean;
    report.error.points_to_mesh_rms = distance.rms;
    report.error.normalised_max = distance.max / in.octree.bounds.diagonal();
    const std::span<const Vec3> moved = in.octree.positions;
    if (distance.beyond > 0 && points.data() != moved.data())
        distance = distance_of(moved, facets, known, options, report);
    if (distance.beyond == 0) return {};
    return {distance.beyond, moved[distance.first_beyond] + in.octree.origin};
}

/// Vertices of each class, of a mesh that has classes.
void count_classes(const PolyMesh& mesh, Report::Features& features) {
    OpenMesh::VPropHandleT<std::uint8_t> classes;
    if (!mesh.get_property_handle(classes, vertex_class_property)) return;
    for (const auto v : mesh.vertices()) {
        const auto of = static_cast<VertexClass>(mesh.property(classes, v));
        features.smooth_vertices += of == VertexClass::smooth;
        features.edge_vertices += of == VertexClass::edge;
        features.corner_vertices += of == VertexClass::corner;
    }
}

/// Divides positions of extreme size by a power of two in which products of lengths are numbers; returns it.
double into_own_unit(std::vector<Vec3>& positions) {
    const double unit = CloudFrame(bounds_of(positions)).unit();
    if (unit != 1)
        for (Vec3& p : positions) p /= unit;
    return unit;
}

} // namespace

void note_topology(const PolygonMesh& facets, const std::optional<FacetLinks>& links, Report& report) {
    const bool linked = links && links->rejected == 0;
    note_topology(linked ? measure_connectivity(facets, *links) : measure_connectivity(facets), report);
}

void note_topology(const Topology& t, Report& report) {
    Report::Mesh& m = report.mesh;
    m.vertices = t.vertices;
    m.edges = t.edges;
    m.faces = t.faces;
    m.triangles = t.triangles;
    m.quads = t.quads;
    m.larger = t.larger;
    m.components = t.components;
    m.boundary_loops = t.boundary_loops;
    m.boundary_edges = t.boundary_edges;
    m.euler = t.euler;
    m.genus = t.genus();
    m.closed = t.closed();
}

std::vector<Vec3> points_as_read(const PointView& cloud, const CloudFrame& frame, const Octree& octree) {
    std::vector<Vec3> points(octree.size());
    for_each_index(points.size(), chunks::light, [&](Index i) {
        points[i] = frame.to_work(vec3_at(cloud.positions, octree.source[i])) - octree.origin;
    });
    return points;
}

std::size_t drop_small_components(const MethodInput& in, PolygonMesh& facets, FeatureHints& hints,
                                  Report& report) {
    const auto [value, of_largest] = *in.options.min_component;
    SmallComponents small =
        drop_small_components(facets, hints, {of_largest ? 0 : value, of_largest ? value : 0});
    note_small_components(small, report);
    small.facets.first += in.octree.origin;
    note_dropped("facets of components smaller than asked for", small.facets, in.frame, report);
    return small.components;
}

void drop_and_measure(std::span<const Vec3> points, const MethodInput& in, PolygonMesh& facets,
                      FacetKnowledge& known, Report& report) {
    const ReconstructOptions& options = in.options;
    const double enough = options.measure ? 0 : report.grid.max_error;
    bool measured = report.grid.max_error > 0 || (options.measure && options.min_component);
    Occurrences off; // of all components; those to be dropped are reported separately
    if (measured) off = measure_error(points, in, facets, known, enough, report);
    check_error_kept(report, in.frame.unit());
    if (options.min_component) {
        if (drop_small_components(in, facets, known.hints, report) > 0) {
            remove_isolated_vertices(facets);
            known.links.reset();
            known.cells.reset();
            measured = false;
        }
    }
    if (!options.measure) {
        report.error = {};
        return;
    }
    if (!measured) make_cells(facets, known, report); // here: only this thread asks whether to go on
    run_both([&] { note_topology(facets, known.links, report); },
             [&] {
                 if (measured) return;
                 const Occurrences left_out = measure_error(points, in, facets, known, 0, report);
                 if (!options.min_component) off = left_out;
             });
    note_dropped("points more than a voxel's diagonal off the mesh", off, in.frame, report);
}

void measure_again(const PolyMesh& mesh, std::span<const Vec3> points, Report& report) {
    report.features = {};
    report.features.sharp_edges = static_cast<std::size_t>(
        std::count_if(mesh.edges_begin(), mesh.edges_end(), [](const auto& e) { return e.feature(); }));
    count_classes(mesh, report.features);
    report.mesh = {};
    report.error = {};
    if (points.empty()) return;
    PolygonMesh facets = to_polygons(mesh);
    note_topology(facets, std::nullopt, report);
    const double unit = CloudFrame(bounds_of(points)).unit(); // distances are squared
    std::vector<Vec3> measured(points.begin(), points.end());
    for (std::vector<Vec3>* const places : {&measured, &facets.positions})
        for (Vec3& p : *places) p /= unit;
    const Distance distance = points_to_mesh(measured, facets);
    report.error.points_to_mesh_max = distance.max * unit;
    report.error.points_to_mesh_mean = distance.mean * unit;
    report.error.points_to_mesh_rms = distance.rms * unit;
    report.error.normalised_max = report.error.points_to_mesh_max / report.input.bbox.diagonal();
}

Occurrences facets_that_meet(const PolygonMesh& facets) {
    const auto pairs = find_self_intersections(facets).facet_pairs;
    if (pairs.empty()) return {};
    return {pairs.size(), facets.positions[facets.facet(pairs[0][0])[0]]};
}

void measure_details(const PolyMesh& mesh, Report::Mesh& report) {
    measure_details(to_polygons(mesh), report);
}

void measure_details(const PolygonMesh& facets, Report::Mesh& report) {
    const double unit = CloudFrame(bounds_of(facets.positions)).unit();
    std::string digest;
    FacetShape shape;
    run_both([&] { digest = mesh_digest(facets); },
             [&] {
                 if (unit == 1) {
                     shape = measure_shape(facets);
                 } else {
                     PolygonMesh scaled = facets;
                     into_own_unit(scaled.positions);
                     shape = measure_shape(scaled);
                 }
             });
    report.details = {digest, shape.quad_share, shape.scaled_jacobian_median, shape.scaled_jacobian_min,
                      shape.edge_length_mean * unit};
}

void count_intersections(const PolyMesh& mesh, Report& report) {
    PolygonMesh facets = to_polygons(mesh);
    const double unit = into_own_unit(facets.positions);
    Occurrences found = facets_that_meet(facets);
    found.first *= unit;
    report.mesh.intersections = found.count;
    warn_anew(warning_of::intersections, found, CloudFrame(), report);
}

} // namespace hsdm
