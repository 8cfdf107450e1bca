#include "hsdm/pipeline/basic_method.hh"

#include "hsdm/basic/basic_facets.hh"
#include "hsdm/pipeline/attributes.hh"
#include "hsdm/pipeline/options.hh"
#include "hsdm/pipeline/phase_geometry.hh"

namespace hsdm {
namespace {

/// keep closes nothing; auto the loops that basic facets leave small. Closing every hole comes with a later
/// method, see the options' check.
BasicFacetOptions facet_options(const ReconstructOptions& options) {
    BasicFacetOptions result;
    if (options.holes == Holes::keep) result.max_hole_edges = 0;
    if (closes_all(options.holes)) result.max_hole_edges = FillHolesOptions::no_limit;
    return result;
}

void note_counts(const BasicFacets::Counts& counts, Report& report) {
    report.rejected["hit_test"] = counts.hit_test;
    report.rejected["distance_criterion"] = counts.distance_criterion;
    report.rejected["angle_comparison"] = counts.angle_comparison;
    note_repairs(counts.holes, counts.manifold, report);
    report.rejected["vertices_isolated"] = counts.manifold.isolated_vertices;
}

} // namespace

PolygonMesh basic_method(const MethodInput& in, Report& report) {
    const ConnectivityGraph graph =
        in.phases.run("graph", 0.2, report.seconds.graph, [&] { return extract_graph(in.octree, in.level); });
    BasicFacets facets = in.phases.run("facets", 0.3, report.seconds.facets, [&] {
        return reconstruct_facets(in.octree, in.level, graph, facet_options(in.options),
                                  average_attributes(in.cloud, in.octree, in.level, graph.voxel));
    });
    note_counts(facets.counts, report);
    if (!in.options.debug_dir.empty())
        write_phases(phase_files(in.options.debug_dir, in.level.depth), in.octree, in.level, graph,
                     facets.mesh, in.frame);
    for (Vec3& p : facets.mesh.positions) p -= in.octree.origin;
    return std::move(facets.mesh);
}

} // namespace hsdm
