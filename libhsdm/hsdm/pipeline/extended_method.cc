#include "hsdm/pipeline/extended_method.hh"

#include "hsdm/completion/constants.hh"
#include "hsdm/completion/free_space.hh"
#include "hsdm/completion/slits.hh"
#include "hsdm/contour/dual_contour.hh"
#include "hsdm/contour/outlier_sets.hh"
#include "hsdm/contour/patches.hh"
#include "hsdm/contour/sheet_features.hh"
#include "hsdm/contour/sheet_widths.hh"
#include "hsdm/core/chunks.hh"
#include "hsdm/core/constants.hh"
#include "hsdm/core/large_vector.hh"
#include "hsdm/mesh/constants.hh"
#include "hsdm/mesh/manifold.hh"
#include "hsdm/mesh/small_components.hh"
#include "hsdm/mesh/turn_outward.hh"
#include "hsdm/mesh/vertex_normals.hh"
#include "hsdm/pipeline/attributes.hh"
#include "hsdm/pipeline/completed_cloud.hh"
#include "hsdm/pipeline/confidence.hh"
#include "hsdm/pipeline/constants.hh"
#include "hsdm/pipeline/extended_graph.hh"
#include "hsdm/pipeline/options.hh"
#include "hsdm/pipeline/phase_geometry.hh"
#include "hsdm/pipeline/sparse_areas.hh"
#include "hsdm/pipeline/voxel_order.hh"
#include "hsdm/pipeline/warnings.hh"
#include "hsdm/quality/topology.hh"
#include "hsdm/spatial/self_intersections.hh"

#include <algorithm>
#include <optional>
#include <utility>

namespace hsdm {
namespace {

const FillHolesOptions every_hole{.max_edges = FillHolesOptions::no_limit, .insist = true};

/// keep closes nothing, close all loops, auto and complete those that are small against the sampling.
DualContourOptions options_for(const MethodInput& in, double spacing,
                               CompletedRound completed = CompletedRound::none) {
    const double spacing_in_voxels = spacing / in.level.voxel_size;
    DualContourOptions result;
    result.fill = in.options.holes != Holes::keep;
    result.better_quads = !wants_adaptive(in.options); // strips of an adaptive grid keep to rows of voxels
    result.all_round = completed != CompletedRound::none;
    if (in.options.holes == Holes::close || completed == CompletedRound::second) {
        result.holes = every_hole;
    } else {
        result.holes.max_diameter = std::max(holes::widest_in_spacings * spacing_in_voxels, holes::widest);
        result.holes.insist = true;
        result.widest_free = holes::widest_in_spacings * spacing_in_voxels;
    }
    result.splinters.least_area = points_of_plane * spacing_in_voxels * spacing_in_voxels;
    if (in.has_layers) result.splinters.layers = splinters::layers_in_spacings * spacing_in_voxels;
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
    report.rejected["grid_points_moved"] = facets.grid_points_moved;
    report.rejected["handles_cut"] = facets.handles_cut;
    report.rejected["vertices_clamped"] = facets.clamped;
    report.rejected["vertices_drawn_in"] = facets.drawn_in;
    report.rejected["vertices_reached"] = facets.reached;
    report.rejected["corners_merged"] = facets.corners_merged;
    report.rejected["flat_corners_merged"] = facets.flat_corners;
    report.rejected["straight_vertices_dropped"] = facets.straight;
    report.rejected["quads_cut_straight"] = facets.quads_cut;
    report.rejected["facets_recut"] = facets.facets_recut;
    report.rejected["edges_halved"] = facets.midpoints;
    report.rejected["doublets_merged"] = facets.doublets;
    report.rejected["facets_of_splinters"] = facets.splinters.count;
    note_repairs(facets.holes, facets.manifold, report);
    report.rejected["intersections_removed"] = facets.intersections.before - facets.intersections.after;
    report.rejected["intersections_left"] = facets.intersections.after;
}

/// The level's sets as they come; those that have been made already if layers need not be merged.
NormalSets sets_of(const MethodInput& in) {
    const bool made = in.sets && *in.sets && !in.options.merge_layers;
    return made ? *std::exchange(*in.sets, std::nullopt)
                : build_normal_sets(in.octree, in.level, {.merge_layers = in.options.merge_layers});
}

/// The level's sets without outliers, parted at walls and gaps; notes what was dropped or is doubtful.
NormalSets separated_sets(const MethodInput& in, Report& report) {
    NormalSets all = sets_of(in);
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

/// How many are not completed ones.
std::size_t measured_points(const Octree& octree) {
    if (octree.source.empty()) return octree.size();
    return static_cast<std::size_t>(std::ranges::count_if(octree.source, is_measured));
}

/// Facets face where the points' normals point. If these point into a closed solid, the whole surface is
/// turned.
bool turn_solid_outward(PolygonMesh& mesh) {
    if (!faces_inward(mesh)) return false;
    turn_over(mesh);
    return true;
}

/// The facets' links, which are found once.
const FacetLinks& links_of(DualContour& facets) {
    if (!facets.links) facets.links = link_facets(facets.mesh);
    return *facets.links;
}

bool is_open(DualContour& facets) {
    const std::vector<Index>& twins = links_of(facets).twin;
    return std::ranges::find(twins, no_index) != twins.end();
}

/// A hole may be of the part: where the surface has borders anyway, nothing says that it is none.
void warn_of_wide_holes(const MethodInput& in, DualContour& facets, Report& report) {
    if (closes_all(in.options.holes) || facets.wide_holes.count == 0 || !is_open(facets)) return;
    Occurrences wide = facets.wide_holes;
    wide.first += in.octree.origin;
    warn(warning_of::wide_holes, wide, in.frame, report);
}

/// What is known of facets once they are made, and what their vertices inherit from the points; takes the
/// mesh, and the sets, to free them. (The adaptive grid, which makes another one of it, has an order of its
/// own.)
PolygonMesh finished(const MethodInput& in, NormalSets&& sets, DualContour& facets, Report& report,
                     FacetKnowledge& known) {
    note_counts(facets, report);
    warn_of_wide_holes(in, facets, report);
    note_dropped("facets of splinters", facets.splinters, in, report);
    const bool turned = turn_solid_outward(facets.mesh);
    if (turned) facets.links.reset();
    report.rejected["normals_turned"] = turned ? measured_points(in.octree) : 0;
    if (in.options.classify) {
        SheetFeatures features = in.phases.run("sheet features", 0.5, report.seconds.features, [&] {
            links_of(facets);
            known.links = std::move(facets.links);
            return sheet_features(in.octree, in.level, sets, facets.mesh, *known.links, facets.voxel,
                                  in.options.crease_angle, turned);
        });
        report.rejected["edges_bent"] = features.smooth;
        report.rejected["edges_doubtful"] = features.doubtful;
        known.hints = std::move(features.hints);
    }
    sets = NormalSets();
    known.cells = std::move(facets.cells);
    known.intersections = {facets.intersections.after, facets.intersections.first};
    if (!wants_adaptive(in.options)) order_by_voxels(in.level.size(), facets.voxel, facets.mesh, known);
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

/// Facets of a cloud, and what the report says of them.
struct Draft {
    std::optional<CompletedCloud> cloud; ///< none: the measured points alone
    Report report;
    NormalSets sets{};
    DualContour facets{};
    bool has_new_cavities = false; ///< are those it has of what completes it?

    MethodInput input(const MethodInput& measured) const {
        return cloud ? measured.with(cloud->octree, cloud->level) : measured;
    }
};

/// Sets and facets of the draft's cloud; `done` is the share of the whole run before it, `sets` that of the
/// sets.
void make_facets(const MethodInput& measured, double done, const DualContourOptions& options, Draft& draft,
                 double sets = 0.02) {
    const MethodInput in = draft.input(measured);
    Report& report = draft.report;
    draft.sets =
        in.phases.run("sets", done, report.seconds.graph, [&] { return separated_sets(in, report); });
    draft.facets = in.phases.run("facets", done + sets, report.seconds.facets,
                                 [&] { return dual_contour(in.octree, in.level, draft.sets, options); });
}

/// So that what is found on them is found on the joined facets of tiles, too.
void order_by_voxels(const MethodInput& in, DualContour& facets) {
    FacetKnowledge known;
    known.links = std::move(facets.links), known.cells = std::move(facets.cells);
    order_by_voxels(in.level.size(), facets.voxel, facets.mesh, known);
    facets.links = std::move(known.links), facets.cells = std::move(known.cells);
}

/// The loops of a draft's facets, which are in the order of voxels then if there are any; those of an
/// adaptive grid keep theirs.
BoundaryLoops loops_of(const MethodInput& in, DualContour& facets) {
    if (!is_open(facets)) return {};
    if (!wants_adaptive(in.options)) order_by_voxels(in, facets);
    return boundary_loops(facets.mesh, links_of(facets));
}

/// Do most of the points whose scanner is known face it? If not, their normals point into solids.
bool face_scanners(const Octree& octree, const Viewpoints& viewpoints) {
    std::ptrdiff_t facing = 0;
    for_each_in_order(octree.size(), [&](std::size_t i) {
        const Vec3* sensor = is_measured(octree.source[i]) ? viewpoints.of(octree.source[i]) : nullptr;
        if (sensor != nullptr) facing += (octree.normals[i] | (*sensor - octree.positions[i])) > 0 ? 1 : -1;
    });
    return facing > 0;
}

/// What scanners looked through; none where that is not known.
FreeSpace free_space(const MethodInput& measured) {
    if (measured.viewpoints.sensors.empty() || measured.frame.has_cuts()
        || !face_scanners(measured.octree, measured.viewpoints))
        return {};
    return {measured.octree, measured.viewpoints, measured.level.voxel_size};
}

/// From what all is completed, and how.
struct Completing {
    const MethodInput& measured;
    const Report& base;              ///< before there were facets
    double done = 0;                 ///< share of the whole run before it
    double share = 0;                ///< of the whole run, that a round is
    const FreeSpace* free = nullptr; ///< of the measured points, if any

    CompletedPoints points(const MethodInput& in, const PolygonMesh& mesh, const BoundaryLoops& loops,
                           Passing passing, Report& report) const {
        return in.phases.run("completion", done, report.seconds.facets, [&] {
            CompleteOptions how{passing};
            if (free != nullptr && !free->empty())
                how.empty = [this, moved = in.octree.origin - measured.octree.origin](const Vec3& place) {
                    return free->holds(place + moved);
                };
            return complete_surface(mesh, loops, in.level.voxel_size, how);
        });
    }

    /// Sets and facets of a draft's points, which `in` has, and of those that complete them.
    Draft draft(const MethodInput& in, const CompletedPoints& points, const Report& before, double shift,
                const DualContourOptions& options) const {
        Draft next{{}, base};
        next.report.seconds = before.seconds;
        next.report.loops = before.loops;
        next.cloud = complete_cloud(in.octree, in.level, points, shift);
        make_facets(measured, done + share / 6, options, next, share * 2 / 3);
        return next;
    }
};

/// Completes the slits of a draft, and once more where some are left, as long as that makes it better.
void complete_slits(Completing how, Draft& draft) {
    const DualContourOptions options = options_for(how.measured, how.base.input.spacing);
    for (int round = 1; round <= repeats::twice; ++round, how.done += how.share) {
        const MethodInput in = draft.input(how.measured);
        FacetFaults before{draft.facets.intersections.after, 0};
        const SlitCompletion completion =
            in.phases.run("completion", how.done, draft.report.seconds.facets, [&] {
                const BoundaryLoops loops = loops_of(in, draft.facets);
                before.border = loops.vertices.size();
                return slit_completion(in, how.base.input.spacing, draft.facets.mesh, loops);
            });
        if (completion.loops.size() == 0) return;
        draft.facets.cells.reset(), draft.facets.links.reset(); // frees what is not needed any more
        Draft next = how.draft(in, completion.points, draft.report, 0, options);
        const FacetFaults after{next.facets.intersections.after,
                                boundary_loops(next.facets.mesh, links_of(next.facets)).vertices.size()};
        if (!are_better(after, before)) {
            draft.report.seconds = next.report.seconds;
            return;
        }
        note_loops(draft.facets.mesh, completion.loops, true, in.octree.origin, in.frame, next.report);
        draft = std::move(next);
    }
}

/// A draft with all loops of a mesh completed.
struct Completion {
    Draft draft;
    std::size_t left = 0; ///< edges of the loops that the first round left

    FacetFaults faults() const { return {draft.facets.intersections.after, left}; }
};

/// Completes all loops of a draft's mesh, and once more where some are left.
Completion completed_all(Completing how, Passing passing, const PolygonMesh& mesh, const BoundaryLoops& loops,
                         const Draft& draft, Report& report) {
    const auto options = [&](CompletedRound round) {
        return options_for(how.measured, how.base.input.spacing, round);
    };
    const MethodInput in = draft.input(how.measured);
    Draft result = how.draft(in, how.points(in, mesh, loops, passing, report), report, completing::shift,
                             options(CompletedRound::first));
    result.has_new_cavities = !has_cavity(mesh);
    const BoundaryLoops left = loops_of(result.input(how.measured), result.facets);
    if (left.size() == 0) return {std::move(result)};
    how.done += how.share;
    const MethodInput again = result.input(how.measured);
    note_loops(result.facets.mesh, left, true, again.octree.origin, again.frame, result.report);
    const CompletedPoints points = how.points(again, result.facets.mesh, left, passing, result.report);
    result.facets = DualContour(); // frees what is not needed any more
    Draft last = how.draft(again, points, result.report, completing::shift, options(CompletedRound::second));
    last.has_new_cavities = result.has_new_cavities;
    return {std::move(last), left.vertices.size()};
}

/// Completes all loops of a draft; once more with a surface that keeps beside the mesh where that is
/// doubtful, and takes the better one.
void complete_all(Completing how, Draft& draft) {
    const std::size_t meeting = draft.facets.intersections.after;
    const BoundaryLoops loops = loops_of(draft.input(how.measured), draft.facets);
    if (loops.size() == 0) return;
    const PolygonMesh mesh = std::move(draft.facets.mesh);
    draft.facets = DualContour(); // frees what is not needed any more
    draft.sets = NormalSets();
    const MethodInput in = draft.input(how.measured);
    const FreeSpace free = in.phases.run("completion", how.done, draft.report.seconds.facets,
                                         [&] { return free_space(how.measured); });
    how.free = &free;
    note_loops(mesh, loops, true, in.octree.origin, in.frame, draft.report);
    Completion result = completed_all(how, Passing::ignored, mesh, loops, draft, draft.report);
    const CompletionCheck check{{meeting, loops.vertices.size()}, !free.empty()};
    if (check.is_doubtful(result.faults())) {
        Report report = draft.report;
        report.seconds = result.draft.report.seconds;
        how.done += 2 * how.share;
        Completion beside = completed_all(how, Passing::stopped, mesh, loops, draft, report);
        result.draft.report.seconds = beside.draft.report.seconds;
        if (check.is_better(beside.faults(), result.faults())) result = std::move(beside);
    }
    draft = std::move(result.draft);
}

/// The vertices of a completed cloud's mesh as if it were the measured one's: where these lie, with colours
/// and scalars everywhere.
void return_to(const MethodInput& measured, const Draft& draft, std::span<const Index> voxel,
               PolygonMesh& mesh, FacetKnowledge& known) {
    VertexProperty marks{completed_property, VertexProperty::Type::uint8,
                         std::vector<double>(mesh.vertex_count())};
    if (draft.cloud) {
        const std::vector<std::uint8_t> completed = draft.cloud->completed_voxels();
        const std::vector<std::uint8_t> measured_voxels = draft.cloud->measured_voxels();
        std::vector<std::uint8_t> has_measured(voxel.size());
        for (std::size_t v = 0; v < voxel.size(); ++v) {
            has_measured[v] = measured_voxels[voxel[v]];
            marks.values[v] = completed[voxel[v]];
        }
        spread_attributes(mesh, std::move(has_measured));
        for (VertexProperty& property : mesh.properties) // the larger cube's level is no one's concern
            if (property.name == level_property)
                std::ranges::fill(property.values, static_cast<double>(measured.level.depth));
        const Vec3 moved = draft.cloud->octree.origin - measured.octree.origin;
        for (Vec3& p : mesh.positions) p += moved;
        known.intersections.first += moved;
        known.cells.reset(); // their voxels are those of the larger cube
    }
    mesh.properties.push_back(std::move(marks));
}

/// How many coarser levels help out where points are too few for the voxels; none where these were asked for.
int levels_to_help(const MethodInput& in, const Report& report) {
    return are_voxels_asked_for(in.options, report) ? 0 : levels_above_sparse(in.level);
}

/// The facets of a level with so many coarser ones to help: from the coarsest on, each has points between
/// sparse ones on the facets of the last.
Draft helped_draft(const MethodInput& in, const Report& report, int levels) {
    const SparseAreas areas(in.octree, in.level, levels);
    Draft draft{{}, report};
    for (int above = levels; above >= 0; --above) {
        const OctreeLevel& level = areas.level(above);
        const MethodInput wide = in.with(in.octree, level);
        const double done = 0.2 + 0.16 * (levels - above) / (levels + 1);
        Draft next{{}, report};
        if (above < levels) {
            next.report.seconds = draft.report.seconds;
            next.cloud = in.phases.run("sparse areas", done, next.report.seconds.facets, [&] {
                order_by_voxels(draft.input(in.with(in.octree, areas.level(above + 1))), draft.facets);
                PolygonMesh& facets = draft.facets.mesh;
                const Vec3 moved =
                    draft.cloud ? draft.cloud->octree.origin - in.octree.origin : Vec3(0, 0, 0);
                for (Vec3& p : facets.positions) p += moved;
                const CompletedPoints points = areas.points_between(facets, above);
                draft.facets = DualContour();
                return complete_cloud(in.octree, wide.level, points, 0, between_points);
            });
        }
        make_facets(wide, done, options_for(wide, report.input.spacing), next);
        draft = std::move(next);
    }
    return draft;
}

Draft first_draft(const MethodInput& in, Report& report) {
    if (const int levels = levels_to_help(in, report); levels > 0) {
        note_coarser_levels(levels, report);
        return helped_draft(in, report, levels);
    }
    Draft draft{{}, report};
    make_facets(in, 0.2, options_for(in, report.input.spacing), draft);
    return draft;
}

} // namespace

PolygonMesh extended_method(const MethodInput& in, Report& report, FacetKnowledge& known) {
    Draft draft = first_draft(in, report);
    const std::size_t measured_sets = draft.sets.sets.size();
    if (in.options.holes == Holes::automatic || in.options.holes == Holes::complete)
        complete_slits({in, report, 0.38, 0.03}, draft);
    if (in.options.holes == Holes::complete) complete_all({in, report, 0.44, 0.015}, draft);
    report = std::move(draft.report);
    report.grid.sets = measured_sets;
    const bool marked = draft.cloud || in.options.holes == Holes::complete;
    PolygonMesh mesh = finished(draft.input(in), std::move(draft.sets), draft.facets, report, known);
    if (marked) return_to(in, draft, draft.facets.voxel, mesh, known);
    if (draft.has_new_cavities) {
        drop_cavities(in, mesh, known, report);
        remove_isolated_vertices(mesh);
    }
    return mesh;
}

void drop_cavities(const MethodInput& in, PolygonMesh& facets, FacetKnowledge& known, Report& report) {
    Occurrences cavities = drop_cavities(facets, known.hints);
    report.rejected["facets_of_cavities"] = cavities.count;
    if (cavities.count == 0) return;
    known.links.reset();
    known.cells.reset();
    if (known.intersections.count > 0) {
        const SelfIntersections left = find_self_intersections(facets);
        known.intersections.count = left.triangle_pairs;
        if (left.triangle_pairs > 0)
            known.intersections.first = facets.positions[facets.facet(left.facet_pairs[0][0])[0]];
    }
    report.rejected["intersections_left"] = known.intersections.count;
    note_dropped("facets of cavities that were seen through holes", cavities, in, report);
}

bool faces_inward(const PolygonMesh& facets) {
    return signed_volume(facets) < 0 && measure_connectivity(facets).closed();
}

void FacetCounts::operator+=(const FacetCounts& other) {
    sets += other.sets;
    middle += other.middle, tilted += other.tilted;
    misfit_placed += other.misfit_placed, misfit_moved += other.misfit_moved;
    tangles += other.tangles;
}

PartFacets facets_of_part(const MethodInput& in, const PartOfLevel& part) {
    NormalSets sets = sets_of(in);
    const RelationTest related({}, in.level.voxel_size);
    drop_outlier_sets(in.level, related, sets, {.typical = part.typical_set});
    separate_patches(in.octree, in.level, related, sets);
    DualContourOptions options = options_for(in, part.spacing, part.completed);
    const auto is_own = [&](Index voxel) { return part.owns(in.level.codes[voxel]); };
    options.tangles = part.tangles;
    options.largest = part.largest;
    std::vector<std::uint8_t> own_voxels = large_vector<std::uint8_t>(in.level.size());
    std::vector<std::uint8_t> near_voxels = large_vector<std::uint8_t>(in.level.size());
    for_each_index(own_voxels.size(), chunks::quick, [&](Index v) {
        own_voxels[v] = is_own(v);
        near_voxels[v] = part.is_near(in.level.codes[v]);
    });
    options.relax.part_of_whole = own_voxels;
    options.part = {[&](Index voxel) { return own_voxels[voxel] != 0; },
                    [&](Index voxel) { return near_voxels[voxel] != 0; }};
    options.relax.go_back = part.go_back;
    DualContour facets = dual_contour(in.octree, in.level, sets, options);
    if (part.turned) {
        turn_over(facets.mesh);
        facets.links.reset();
    }
    PartFacets result;
    if (in.options.classify) {
        std::vector<std::uint8_t> own = large_vector<std::uint8_t>(facets.mesh.facet_count());
        for_each_index(own.size(), chunks::quick, [&](Index f) {
            Index least = no_index; // voxel
            for (const Index v : facets.mesh.facet(f)) least = std::min(least, facets.voxel[v]);
            own[f] = is_own(least);
        });
        result.known.links = facets.links ? std::move(*facets.links) : link_facets(facets.mesh);
        SheetFeatures features = judge_edges(in.octree, in.level, sets, facets.mesh, *result.known.links,
                                             facets.voxel, in.options.crease_angle, part.turned, own);
        result.counts.middle = features.middle, result.counts.tilted = features.tilted;
        result.known.hints = std::move(features.hints);
    }
    order_by_voxels(in.level.size(), facets.voxel, facets.mesh, result.known);
    for (const NormalSet& set : sets.sets) result.counts.sets += is_own(set.voxel);
    result.counts.misfit_placed = facets.misfit_placed, result.counts.misfit_moved = facets.misfit_moved;
    result.counts.tangles = facets.tangles;
    result.counts.looked_far = facets.looked_far;
    result.components = std::move(facets.components);
    result.mesh = std::move(facets.mesh);
    result.voxel = std::move(facets.voxel);
    return result;
}

SlitCompletion slit_completion(const MethodInput& in, double spacing, const PolygonMesh& facets,
                               const BoundaryLoops& loops) {
    if (loops.size() == 0) return {};
    const double h = in.level.voxel_size;
    Slits slits = find_slits(facets, loops, h * options_for(in, spacing).holes.max_diameter);
    // Where more than slits is open all is completed at once: what closes one loop may meet another's.
    if (in.options.holes == Holes::complete && slits.loops.size() < loops.size()) return {};
    SlitCompletion result{{}, points_across(slits, h)};
    result.loops = std::move(slits.loops);
    return result;
}

} // namespace hsdm
