#include "hsdm/pipeline/whole_of_tiles.hh"

#include "hsdm/contour/sheet_features.hh"
#include "hsdm/core/chunks.hh"
#include "hsdm/core/large_vector.hh"
#include "hsdm/mesh/small_components.hh"
#include "hsdm/pipeline/finish_mesh.hh"
#include "hsdm/pipeline/measure.hh"
#include "hsdm/quality/distance_to_surface.hh"

#include <algorithm>
#include <numbers>

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

/// Refuses what was taken for granted of the whole and is not so.
void check_whole(const WholeInput& in, const MethodInput& method, const PolygonMesh& mesh) {
    const SplinterOptions splinters;
    const std::size_t most = std::max({splinters.most_facets, splinters.most_open, splinters.most_flat});
    if (static_cast<double>(largest_component(mesh)) < splinters.least_ratio * static_cast<double>(most))
        refuse_in_tiles("no part of the mesh is large");
    if (in.options.holes == Holes::automatic && has_slits(method, in.survey.spacing, mesh))
        refuse_in_tiles("a slit has to be closed (--holes keep would leave it)");
}

/// Distances of the points of a cloud on disk from facets, relative to the cube.
Distance distance_of(const WholeInput& in, const PolygonMesh& facets, const FacetCells& cells,
                     Occurrences& off) {
    DistanceSums sums(std::numbers::sqrt3 * in.cloud.voxel_size());
    std::vector<Vec3> points; // as many at once as in one piece: what one search finds speeds up the next
    const auto add = [&](std::size_t count) {
        const std::size_t before = sums.count();
        sums.add(squared_distances_by_cells(std::span(points).first(count), facets, cells));
        const Distance so_far = sums.result();
        if (off.count == 0 && so_far.beyond > 0)
            off.first = points[so_far.first_beyond - before] + in.cloud.origin();
        off.count = so_far.beyond;
        points.erase(points.begin(), points.begin() + static_cast<std::ptrdiff_t>(count));
    };
    in.cloud.for_groups(in.group_points, [&](const Octree& part) {
        append_large(points, part.positions);
        add(points.size() / chunks::usual * chunks::usual);
    });
    add(points.size());
    return sums.result();
}

/// Error and topology; distances of points group by group.
void measure(const WholeInput& in, const MethodInput& method, PolygonMesh& facets, FacetKnowledge& known,
             Report& report) {
    drop_and_measure({}, method, facets, known, report);
    if (!in.options.measure) return;
    if (!known.cells) known.cells.emplace(facets, report.grid.voxel_size);
    Occurrences off;
    const Distance distance = distance_of(in, facets, *known.cells, off);
    report.error.points_to_mesh_max = distance.max;
    report.error.points_to_mesh_mean = distance.mean;
    report.error.points_to_mesh_rms = distance.rms;
    report.error.normalised_max = distance.max / in.cloud.extent().box.diagonal();
    note_dropped("points more than a voxel's diagonal off the mesh", off, in.cloud.frame(), report);
}

} // namespace

WholeFacets join_tiles(std::vector<Piece>&& pieces) {
    WholeFacets whole;
    for (const Piece& piece : pieces) whole.counts += piece.counts;
    whole.mesh = joined_pieces(std::move(pieces), whole.known.hints.sides);
    judge(whole.counts, whole.known);
    return whole;
}

Reconstruction finish_whole(const WholeInput& in, WholeFacets&& facets, Report&& report) {
    const OctreeLevel level = in.cloud.no_voxels();
    const MethodInput method{in.cloud.frame(), {}, in.cloud.no_points(), level, in.options, in.phases};
    in.phases.run("whole", 0.55, report.seconds.facets, [&] {
        check_facets(facets.mesh, report);
        check_whole(in, method, facets.mesh);
        const auto count = facets.mesh.vertex_count();
        facets.mesh.properties.push_back({"hsdm_level", VertexProperty::Type::uint8,
                                          std::vector<double>(count, static_cast<double>(level.depth))});
    });
    Reconstruction result;
    finish_mesh(
        method, std::move(facets.mesh), std::move(facets.known), std::move(report), result,
        [&](PolygonMesh& mesh, FacetKnowledge& what, Report& of) { measure(in, method, mesh, what, of); });
    return result;
}

} // namespace hsdm
