#include "hsdm/pipeline/whole_of_tiles.hh"

#include "hsdm/contour/sheet_features.hh"
#include "hsdm/core/large_vector.hh"
#include "hsdm/core/system.hh"
#include "hsdm/io/parked_arrays.hh"
#include "hsdm/mesh/manifold.hh"
#include "hsdm/mesh/turn_outward.hh"
#include "hsdm/mesh/vertex_normals.hh"
#include "hsdm/pipeline/cloud_distance.hh"
#include "hsdm/pipeline/finish_mesh.hh"
#include "hsdm/pipeline/join_pieces.hh"
#include "hsdm/pipeline/measure.hh"
#include "hsdm/pipeline/options.hh"
#include "hsdm/pipeline/warnings.hh"
#include "hsdm/quality/degenerate_facets.hh"

#include <algorithm>

namespace hsdm {
namespace {

/// Smooth hints are taken back where normals are smeared.
void judge(const FacetCounts& counts, FacetKnowledge& known) {
    SheetFeatures features;
    features.middle = counts.middle, features.tilted = counts.tilted;
    features.hints = std::move(known.hints);
    judge_normals(features);
    known.hints = std::move(features.hints);
}

void note_intersections(const WholeInput& in, Occurrences left, Report& report) {
    report.rejected["intersections_left"] = left.count;
    left.first += in.cloud.origin();
    warn(warning_of::intersections, left, in.cloud.frame(), report);
}

/// Distances of points, group by group. Returns the points that the mesh leaves out, and not because of their
/// noise.
Occurrences measure_error(const WholeInput& in, const PolygonMesh& facets, Report& report) {
    Occurrences off;
    const ScratchCloud& measured = in.as_read ? *in.as_read : in.cloud;
    const Distance distance = cloud_distance(measured, facets, in.group_points, off);
    if (in.as_read && in.cloud.ranks().of_first(off.count > 0))
        cloud_distance(in.cloud, facets, in.group_points, off);
    report.error.points_to_mesh_max = distance.max;
    report.error.points_to_mesh_mean = distance.mean;
    report.error.points_to_mesh_rms = distance.rms;
    report.error.normalised_max = distance.max / in.cloud.bounds().diagonal();
    return off;
}

/// As drop_and_measure(); `relinked` is called where facets are left out, whose vertices are there still,
/// `park` for what may wait while the error is measured.
void drop_small_and_measure(const WholeInput& in, const MethodInput& method, PolygonMesh& facets,
                            FeatureHints& hints, Report& report, const std::function<void()>& relinked,
                            const std::function<void()>& note_connectivity,
                            const std::function<void(ParkedArrays&)>& park) {
    const bool measure = in.options.measure, drop = in.options.min_component.has_value();
    const auto error = [&] {
        ParkedArrays waiting(in.parking);
        park(waiting);
        const Occurrences left_out = measure_error(in, facets, report);
        waiting.restore();
        return left_out;
    };
    Occurrences off; // of all components; those to be dropped are reported separately
    bool measured = drop && measure;
    if (measured) off = error();
    if (drop && drop_small_components(method, facets, hints, report) > 0) measured = false, relinked();
    if (!measure) return;
    if (drop) in.cloud.ranks().of_first(!measured); // those that assist wait for it
    note_connectivity();
    if (!measured) {
        const Occurrences left_out = error();
        if (!drop) off = left_out;
    }
    note_dropped("points more than a voxel's diagonal off the mesh", off, in.cloud.frame(), report);
}

/// Finishes facets in little memory: each step frees what the next ones do not need.
class FlatFinish {
public:
    FlatFinish(const WholeInput& in, WholeFacets&& facets, Report&& report)
        : in_(in),
          level_(in.cloud.no_voxels()),
          method_{in.cloud.frame(), no_cloud_, in.cloud.no_points(), level_, in.options, in.phases},
          hints_(std::move(facets.known.hints)),
          intersections_(facets.known.intersections),
          report_(std::move(report)) {
        result_.mesh = std::move(facets.mesh);
        result_.rows = facets.rows, result_.attributes = std::move(facets.attributes);
        if (facets.known.links) links() = std::move(*facets.known.links);
    }

    FlatReconstruction finish() {
        Report::Seconds& seconds = report_.seconds;
        os::give_back_freed_memory();
        in_.phases.run("whole", 0.55, seconds.facets, [&] {
            check_facets(mesh(), report_);
            note_intersections(in_, intersections_, report_);
            if (links().source.empty()) links() = link_facets(mesh());
            leave_out_unsound();
            check_facets(mesh(), report_);
        });
        os::give_back_freed_memory();
        in_.phases.run("error", 0.6, seconds.error, [&] {
            drop_small_and_measure(
                in_, method_, mesh(), hints_, report_, [&] { relink(); },
                [&] {
                    note_connectivity();
                    warn_of_open_loops();
                    keep_to_manifold();
                    os::give_back_freed_memory();
                },
                [&](ParkedArrays& waiting) { park_links(waiting); });
            if (in_.options.measure) return;
            warn_of_open_loops();
            keep_to_manifold();
        });
        os::give_back_freed_memory();
        in_.phases.run("mesh", 0.85, seconds.mesh, [&] { face_outward(); });
        os::give_back_freed_memory();
        if (in_.options.classify) in_.phases.run("features", 0.9, seconds.features, [&] { find_features(); });
        report_.peak_memory_bytes = os::peak_memory();
        result_.depth = in_.cloud.depth();
        result_.report = std::move(report_);
        return std::move(result_);
    }

private:
    PolygonMesh& mesh() { return result_.mesh; }
    FacetLinks& links() { return result_.links; }

    void leave_out_unsound() {
        Occurrences unsound =
            drop_degenerate_facets(mesh(), in_.cloud.origin(), in_.cloud.frame(), links(), hints_);
        report_.rejected["facets_unsound"] = unsound.count;
        unsound.first += in_.cloud.origin();
        note_dropped("facets that enclose nothing or have no area", unsound, in_.cloud.frame(), report_);
        if (links().rejected > 0) refuse_in_tiles("some facets meet others that face another way");
        report_.rejected["to_mesh"] = 0;
    }

    void note_connectivity() {
        note_topology(measure_connectivity(mesh(), links()), report_);
        if (report_.mesh.boundary_loops > 0)
            note_loops(mesh(), boundary_loops(mesh(), links()), false, in_.cloud.origin(), in_.cloud.frame(),
                       report_);
    }

    void warn_of_open_loops() {
        if (!must_be_closed(in_.options)) return;
        const BoundaryLoops loops = boundary_loops(mesh(), links());
        if (loops.size() == 0) return;
        warn(warning_of::open_loops, {loops.size(), mesh().positions[loops[0][0]] + in_.cloud.origin()},
             in_.cloud.frame(), report_);
    }

    /// The mesh as its links have it: a vertex for each fan, and none without facets.
    void keep_to_manifold() {
        if (links().split_vertices > 0 || links().source.size() < mesh().vertex_count()) {
            mesh().positions = gathered(mesh().positions, links().source);
            keep_attributes();
            mesh().corners = std::move(links().vertex);
        }
        forget_vertices();
    }
    void keep_attributes() {
        const std::size_t bytes = result_.rows.bytes();
        std::vector<char> kept = large_vector<char>(links().source.size() * bytes);
        for_each_index(bytes > 0 ? links().source.size() : 0, chunks::light, [&](Index v) {
            std::copy_n(result_.attributes.data() + links().source[v] * bytes, bytes,
                        kept.data() + v * bytes);
        });
        result_.attributes = std::move(kept);
    }
    void relink() {
        links() = FacetLinks(); // its memory first
        links() = link_facets(mesh());
    }
    void park_links(ParkedArrays& waiting) {
        waiting.park(links().facet, links().twin, links().vertex, links().source, links().side_out,
                     links().open_in, links().accepted, hints_.sides, result_.attributes);
    }
    void forget_vertices() { release(links().vertex, links().source, links().accepted); }

    void face_outward() {
        // this rounds positions; only then can be told how facets face
        for (Vec3& p : mesh().positions) p += in_.cloud.origin();
        ParkedArrays waiting(in_.parking);
        waiting.park(links().facet, links().side_out, links().open_in);
        const std::size_t turned = turn_outward(mesh(), links(), hints_);
        if (turned == 0) waiting.restore(); // else the links are new
        report_.rejected["facets_turned"] = turned;
        forget_vertices();
    }

    void find_features() {
        FeatureOptions options;
        options.crease_angle = in_.options.crease_angle;
        result_.features = find_facet_features(mesh(), links(), std::move(hints_), options);
        if (in_.options.vertex_normals) smooth_normals();
        const FeatureCounts& counts = result_.features.counts;
        report_.features.sharp_edges = counts.sharp_edges;
        report_.features.smooth_vertices = counts.smooth_vertices;
        report_.features.edge_vertices = counts.edge_vertices;
        report_.features.corner_vertices = counts.corner_vertices;
    }

    void smooth_normals() {
        FacetNormals normals = facet_normals(mesh());
        ParkedArrays waiting(in_.parking);
        if (in_.options.normal_smoothing > 0) {
            waiting.park(mesh().positions, mesh().corners, links().side_out, links().open_in,
                         result_.attributes);
            const FacetNeighbours neighbours = neighbours_of(mesh(), links(), result_.features.sharp);
            waiting.park(links().facet, links().twin);
            smooth_facet_normals(normals, neighbours, {.rounds = in_.options.normal_smoothing});
        }
        release(normals.area);
        result_.features.normals = std::move(normals.normals);
        waiting.restore();
    }

    const WholeInput& in_;
    const PointView no_cloud_{};
    const OctreeLevel level_;
    const MethodInput method_;
    FeatureHints hints_;
    Occurrences intersections_;
    Report report_;
    FlatReconstruction result_;
};

} // namespace

void assist_error(const WholeInput& in) {
    assist_cloud_distance(in.as_read ? *in.as_read : in.cloud, in.group_points);
    if (in.as_read && in.cloud.ranks().of_first(false)) assist_cloud_distance(in.cloud, in.group_points);
}

WholeFacets join_tiles(std::vector<Piece>&& pieces, const PieceStore* store) {
    WholeFacets whole;
    for (const Piece& piece : pieces) whole.counts += piece.counts;
    whole.known.intersections = whole.counts.tangles.left;
    JoinedPieces joined = joined_pieces(std::move(pieces), store);
    whole.mesh = std::move(joined.mesh), whole.attributes = std::move(joined.attributes);
    whole.known.hints.sides = std::move(joined.sides);
    judge(whole.counts, whole.known);
    return whole;
}

Reconstruction finish_whole(const WholeInput& in, WholeFacets&& facets, Report&& report) {
    const OctreeLevel level = in.cloud.no_voxels();
    const MethodInput method{in.cloud.frame(), {}, in.cloud.no_points(), level, in.options, in.phases};
    in.phases.run("whole", 0.55, report.seconds.facets, [&] {
        check_facets(facets.mesh, report);
        report.rejected["intersections_left"] = facets.known.intersections.count;
        if (!facets.known.links) facets.known.links = link_facets(facets.mesh);
        const auto count = facets.mesh.vertex_count();
        std::vector<VertexProperty>& properties = facets.mesh.properties;
        properties = facets.rows.properties_of(facets.attributes);
        const auto add = [&](const char* name, std::vector<double> values) {
            properties.push_back({name, VertexProperty::Type::uint8, std::move(values)});
        };
        add(level_property, std::vector<double>(count, static_cast<double>(level.depth)));
        if (facets.rows.has_kinds()) add(completed_property, facets.rows.are_completed(facets.attributes));
        release(facets.attributes);
    });
    Reconstruction result;
    finish_mesh(method, std::move(facets.mesh), std::move(facets.known), std::move(report), result,
                [&](PolygonMesh& mesh, FacetKnowledge& known, Report& of) {
                    drop_small_and_measure(
                        in, method, mesh, known.hints, of,
                        [&] {
                            remove_isolated_vertices(mesh);
                            known.links.reset();
                        },
                        [&] { note_topology(mesh, known.links, of); }, [](ParkedArrays&) {});
                });
    return result;
}

/// While normals are smoothed: the mesh, its links but for those that are forgotten by then, which sides are
/// sharp, normals before and after a round, areas and neighbours.
std::size_t bytes_of_flat_finish(const PolygonMesh& mesh) {
    const std::size_t of_vertex = sizeof(Vec3) + 2 * sizeof(Index);
    const std::size_t of_side = 3 * sizeof(Index) + sizeof(std::uint8_t) + sizeof(Index);
    const std::size_t of_facet = sizeof(Index) + 2 * sizeof(Vec3) + sizeof(double) + sizeof(Index);
    return mesh.vertex_count() * of_vertex + mesh.corners.size() * of_side + mesh.facet_count() * of_facet;
}

FlatReconstruction finish_whole_flat(const WholeInput& in, WholeFacets&& facets, Report&& report) {
    return FlatFinish(in, std::move(facets), std::move(report)).finish();
}

} // namespace hsdm
