#include "hsdm/pipeline/extended_method.hh"

#include "hsdm/completion/constants.hh"
#include "hsdm/contour/dual_contour.hh"
#include "hsdm/contour/outlier_sets.hh"
#include "hsdm/contour/patches.hh"
#include "hsdm/contour/sheet_features.hh"
#include "hsdm/contour/sheet_widths.hh"
#include "hsdm/mesh/turn_outward.hh"
#include "hsdm/pipeline/attributes.hh"
#include "hsdm/pipeline/completed_cloud.hh"
#include "hsdm/pipeline/confidence.hh"
#include "hsdm/pipeline/constants.hh"
#include "hsdm/pipeline/extended_graph.hh"
#include "hsdm/pipeline/options.hh"
#include "hsdm/pipeline/phase_geometry.hh"
#include "hsdm/pipeline/warnings.hh"
#include "hsdm/quality/topology.hh"

#include <algorithm>

namespace hsdm {
namespace {

/// keep closes nothing, close all loops, auto and complete those that are small against the sampling.
DualContourOptions extended_options(Holes holes, double spacing_in_voxels) {
    DualContourOptions result;
    result.holes.max_diameter = std::max(holes::widest_in_spacings * spacing_in_voxels, holes::widest);
    result.holes.insist = true;
    result.fill = holes != Holes::keep;
    if (holes == Holes::close)
        result.holes = {.max_edges = FillHolesOptions::no_limit, .max_diameter = Box::inf, .insist = true};
    return result;
}

void note_dropped(const std::string& what, Occurrences relative, const MethodInput& in, Report& report) {
    relative.first += in.octree.origin;
    note_dropped(what, relative, in.frame, report);
}

void note_counts(const DualContour& facets, Report& report) {
    report.rejected["crossings_beyond_crease"] = facets.beyond_crease;
    report.rejected["crossings_settled"] = facets.settled;
    report.rejected["crossings_beyond_data"] = facets.trimmed;
    report.rejected["crossings_at_tips"] = 2 * facets.tips;
    report.rejected["webs_opened"] = facets.webs_opened;
    report.rejected["handles_cut"] = facets.handles_cut;
    report.rejected["vertices_clamped"] = facets.clamped;
    report.rejected["corners_merged"] = facets.corners_merged;
    report.rejected["edges_halved"] = facets.midpoints;
    report.rejected["doublets_merged"] = facets.doublets;
    report.rejected["facets_debris"] = facets.splinters.count;
    report.rejected["holes_closed"] = facets.holes.closed;
    report.rejected["holes_refused"] = facets.holes.refused;
    report.rejected["facets_degenerate"] = facets.manifold.degenerate;
    report.rejected["facets_cancelled"] = facets.manifold.cancelled;
    report.rejected["facets_duplicate"] = facets.manifold.duplicates;
    report.rejected["edges_opened"] = facets.manifold.opened_edges;
    report.rejected["intersections_removed"] = facets.intersections.before - facets.intersections.after;
    report.rejected["intersections_left"] = facets.intersections.after;
    report.rejected["vertices_split"] = facets.manifold.split_vertices;
}

/// How much the report lists, so that what was noted of a draft can be taken back.
struct Listed {
    std::size_t dropped, warnings;

    explicit Listed(const Report& report)
        : dropped(report.dropped.size()), warnings(report.warnings.size()) {}
    void restore(Report& report) const {
        report.dropped.resize(dropped);
        report.warnings.resize(warnings);
    }
};

/// The level's sets without outliers, parted at walls and gaps; notes what was dropped or is doubtful.
NormalSets separated_sets(const MethodInput& in, Report& report) {
    NormalSets all = build_normal_sets(in.octree, in.level, {.merge_layers = in.options.merge_layers});
    const RelationTest related({}, in.level.voxel_size);
    const Occurrences outliers = drop_outlier_sets(in.level, related, all);
    report.rejected["points_stray"] = outliers.count;
    note_dropped("points that no neighbour continues", outliers, in, report);
    report.rejected["sets_split"] = separate_patches(in.octree, in.level, related, all).split;
    Occurrences crowded = crowded_sheets(in.level, all);
    crowded.first += in.octree.origin;
    warn(warning_of::crowded_sheets, crowded, in.frame, report);
    return all;
}

/// Facets face where the points' normals point. If these point into a closed solid, the whole surface is
/// turned.
bool turn_solid_outward(PolygonMesh& mesh) {
    if (signed_volume(mesh) >= 0 || !measure_connectivity(mesh).closed()) return false;
    turn_over(mesh);
    return true;
}

double spacing_in_voxels(const MethodInput& in, const Report& report) {
    return report.input.spacing / in.level.voxel_size;
}

DualContour facets_of(const MethodInput& in, const NormalSets& sets, const DualContourOptions& options,
                      double done, Report& report) {
    return in.phases.run("facets", done, report.seconds.facets,
                         [&] { return dual_contour(in.octree, in.level, sets, options); });
}

/// Marks the vertices of voxels that have none but completed points.
VertexProperty completed_vertices(const CompletedCloud& cloud, std::span<const Index> voxel) {
    const std::vector<std::uint8_t> completed = cloud.completed_voxels();
    VertexProperty property{"hsdm_completed", VertexProperty::Type::uint8, std::vector<double>(voxel.size())};
    for (std::size_t v = 0; v < voxel.size(); ++v) property.values[v] = completed[voxel[v]];
    return property;
}

/// What is known of facets once they are made, and what their vertices inherit from the points.
PolygonMesh finished(const MethodInput& in, const NormalSets& sets, DualContour facets, Report& report,
                     FacetKnowledge& known) {
    note_counts(facets, report);
    note_dropped("facets of splinters", facets.splinters, in, report);
    const bool turned = turn_solid_outward(facets.mesh);
    report.rejected["normals_turned"] = turned ? in.octree.size() : 0;
    if (in.options.classify) {
        SheetFeatures features = in.phases.run("sheet features", 0.5, report.seconds.features, [&] {
            known.links = link_facets(facets.mesh);
            return sheet_features(in.octree, in.level, sets, facets.mesh, *known.links, facets.voxel,
                                  in.options.crease_angle, turned);
        });
        report.rejected["edges_bent"] = features.smooth;
        report.rejected["edges_doubtful"] = features.doubtful;
        known.hints = std::move(features.hints);
    }
    known.cells = std::move(facets.cells);
    known.intersections = {facets.intersections.after, facets.intersections.first};
    facets.mesh.properties = average_attributes(in.cloud, in.octree, in.level, facets.voxel);
    if (wants_confidence(in.options))
        facets.mesh.properties.push_back(
            {confidence_property, VertexProperty::Type::float32,
             vertex_confidence(in.octree, in.level, facets.mesh, report.input.spacing, turned)});
    if (!in.options.debug_dir.empty()) {
        PolygonMesh placed = facets.mesh;
        for (Vec3& p : placed.positions) p += in.octree.origin;
        write_phases(phase_files(in.options.debug_dir, report.grid.depth), in.octree, in.level,
                     extended_graph(facets.mesh, facets.voxel), placed, in.frame);
    }
    return std::move(facets.mesh);
}

/// The same with the points that complete the surface where these facets end, and again where loops are left.
PolygonMesh completed(const MethodInput& in, DualContour draft, const BoundaryLoops& border,
                      const Listed& listed, int rounds, Report& report, FacetKnowledge& known) {
    listed.restore(report);
    const double done = 0.4 + 0.05 * (completing::most_rounds - rounds);
    note_loops(draft.mesh, border, true, in.octree.origin, in.frame, report);
    const CompletedCloud cloud = in.phases.run("completion", done, report.seconds.facets, [&] {
        return complete_cloud(in.octree, in.level, complete_surface(draft.mesh, border, in.level.voxel_size));
    });
    draft = DualContour();
    const MethodInput whole{in.frame, in.cloud, cloud.octree, cloud.level, in.options, in.phases};
    const NormalSets sets = in.phases.run("sets", done + 0.01, report.seconds.graph,
                                          [&] { return separated_sets(whole, report); });
    const bool last = rounds == 1;
    DualContourOptions options =
        extended_options(last ? Holes::close : Holes::automatic, spacing_in_voxels(in, report));
    options.all_round = true;
    DualContour facets = facets_of(whole, sets, options, done + 0.02, report);
    const BoundaryLoops left = last ? BoundaryLoops() : boundary_loops(facets.mesh);
    PolygonMesh mesh;
    if (left.size() > 0) {
        mesh = completed(whole, std::move(facets), left, listed, rounds - 1, report, known);
    } else {
        VertexProperty marks = completed_vertices(cloud, facets.voxel);
        mesh = finished(whole, sets, std::move(facets), report, known);
        std::vector<std::uint8_t> measured(marks.values.size());
        for (std::size_t v = 0; v < measured.size(); ++v) measured[v] = marks.values[v] == 0;
        spread_attributes(mesh, std::move(measured));
        mesh.properties.push_back(std::move(marks));
    }
    for (VertexProperty& property : mesh.properties) // the larger cube's level is no one's concern
        if (property.name == "hsdm_level")
            std::ranges::fill(property.values, static_cast<double>(in.level.depth));
    const Vec3 moved = cloud.octree.origin - in.octree.origin;
    for (Vec3& p : mesh.positions) p += moved;
    known.intersections.first += moved;
    known.cells.reset(); // their voxels are those of the larger cube
    return mesh;
}

} // namespace

PolygonMesh extended_method(const MethodInput& in, Report& report, FacetKnowledge& known) {
    const Listed listed(report);
    const NormalSets sets =
        in.phases.run("sets", 0.2, report.seconds.graph, [&] { return separated_sets(in, report); });
    report.grid.sets = sets.sets.size();
    const Holes holes = in.options.holes;
    DualContour facets =
        facets_of(in, sets, extended_options(holes, spacing_in_voxels(in, report)), 0.3, report);
    if (holes == Holes::complete)
        if (const BoundaryLoops border = boundary_loops(facets.mesh); border.size() > 0)
            return completed(in, std::move(facets), border, listed, completing::most_rounds, report, known);
    PolygonMesh mesh = finished(in, sets, std::move(facets), report, known);
    if (holes == Holes::complete)
        mesh.properties.push_back(
            {"hsdm_completed", VertexProperty::Type::uint8, std::vector<double>(mesh.vertex_count())});
    return mesh;
}

} // namespace hsdm
