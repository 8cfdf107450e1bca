#include "hsdm/pipeline/tiled_draft.hh"

#include "hsdm/core/constants.hh"
#include "hsdm/io/parked_arrays.hh"
#include "hsdm/pipeline/attributes.hh"
#include "hsdm/pipeline/cloud_sparse_areas.hh"
#include "hsdm/pipeline/extended_method.hh"

#include <numeric>
#include <utility>

namespace hsdm {
namespace {

const ScratchCloud& cloud_of(const DraftsInput& in, const TiledDraft& draft) {
    return draft.cloud ? *draft.cloud : in.cloud;
}

/// A draft without facets yet.
TiledDraft draft_of(const DraftsInput& in, ScratchCloud&& cloud) {
    const auto add = [](std::size_t sum, const ScratchPoints::Cell& cell) { return sum + cell.points; };
    const std::size_t points =
        std::accumulate(cloud.cells().begin(), cloud.cells().end(), std::size_t{0}, add);
    TiledDraft draft;
    draft.cloud = std::make_unique<ScratchCloud>(std::move(cloud));
    draft.survey.emplace(
        CloudSurvey{survey_cloud(*draft.cloud, points, in.passes.most_points).sums, in.survey.spacing});
    draft.known.has_layers = in.known.has_layers, draft.known.outliers = in.known.outliers;
    return draft;
}

/// The next finer one of helped_draft(), of the coarser one's facets.
TiledDraft finer_draft(const DraftsInput& in, TiledDraft coarser, int above,
                       const std::vector<SparseVoxel>& sparse) {
    const Vec3 moved = coarser.cloud->origin() - in.cloud.origin();
    for (Vec3& p : coarser.facets.mesh.positions) p += moved;
    const ScratchCloud between =
        points_between(in.cloud, coarser.facets.mesh, in.levels, above, sparse, in.passes);
    coarser = TiledDraft(); // frees what is not needed any more
    return draft_of(in, in.cloud.with_points(between, PointKind::between, in.cloud.depth() - above,
                                             in.passes.most_points));
}

/// As the one of extended_method().
TiledDraft first_draft(const DraftsInput& in) {
    TiledDraft draft;
    std::vector<SparseVoxel> sparse;
    if (in.levels > 0) {
        sparse = sparse_voxels(in.cloud, in.levels, in.passes);
        draft = draft_of(in, in.cloud.in_voxels_of(in.cloud.depth() - in.levels, in.passes.most_points));
    }
    in.make(draft, false);
    for (int above = in.levels - 1; above >= 0; --above) {
        draft = finer_draft(in, std::move(draft), above, sparse);
        in.make(draft, false);
    }
    return draft;
}

/// What closes the slits of a draft, on the first rank.
SlitCompletion slits_of(const DraftsInput& in, TiledDraft& draft) {
    if (!in.cloud.ranks().is_first()) return {};
    const ScratchCloud& cloud = cloud_of(in, draft);
    std::optional<FacetLinks>& links = draft.facets.known.links;
    if (!links) links = link_facets(draft.facets.mesh);
    const OctreeLevel level = cloud.no_voxels();
    const MethodInput method{cloud.frame(), {}, cloud.no_points(), level, in.options, in.phases};
    return slit_completion(method, in.survey.spacing, draft.facets.mesh,
                           boundary_loops(draft.facets.mesh, *links));
}

/// The draft's points and those of the first rank that complete them.
TiledDraft completed_draft(const DraftsInput& in, const ScratchCloud& cloud, const CompletedPoints& points) {
    ScratchCloud added = cloud.emptied_aside();
    added.fill([&](const ScratchCloud::PutRow& put_row) {
        for (std::size_t i = 0; i < points.positions.size(); ++i) {
            const Vec3 &p = points.positions[i], &n = points.normals[i];
            put_row({p[0], p[1], p[2], n[0], n[1], n[2]}, nullptr);
        }
    });
    return draft_of(in, cloud.with_points(added, PointKind::completed, cloud.depth(), in.passes.most_points));
}

/// On the first rank.
FacetFaults faults_of(WholeFacets& facets) {
    std::optional<FacetLinks>& links = facets.known.links;
    if (!links) links = link_facets(facets.mesh);
    return {facets.known.intersections.count, boundary_loops(facets.mesh, *links).vertices.size()};
}

/// As the one of extended_method(). The facets before wait on scratch meanwhile.
void complete_slits(const DraftsInput& in, TiledDraft& draft, Report& report) {
    Ranks& ranks = in.cloud.ranks();
    for (int round = 1; round <= repeats::twice; ++round) {
        const SlitCompletion slits = slits_of(in, draft);
        if (!ranks.of_first(slits.loops.size() > 0)) return;
        Report noted;
        const ScratchCloud& cloud = cloud_of(in, draft);
        note_loops(draft.facets.mesh, slits.loops, true, cloud.origin(), cloud.frame(), noted);
        TiledDraft next = completed_draft(in, cloud, slits.points);
        std::swap(next, draft);
        WholeFacets& before = next.facets;
        FacetFaults faults{};
        if (ranks.is_first()) faults = faults_of(before);
        before.known.links.reset();
        ParkedArrays waiting(&in.parking);
        waiting.park(before.mesh.positions, before.mesh.first, before.mesh.corners, before.known.hints.sides,
                     before.attributes);
        in.make(draft, false);
        if (!ranks.of_first(ranks.is_first() && are_better(faults_of(draft.facets), faults))) {
            draft.facets = WholeFacets(); // its memory first
            waiting.restore();
            std::swap(next, draft);
            return;
        }
        report.loops.insert(report.loops.end(), noted.loops.begin(), noted.loops.end());
    }
}

/// Colours and scalars everywhere, of vertices whose voxels have no measured points too.
void spread_attributes(WholeFacets& facets) {
    const AttributeRows& rows = facets.rows;
    if (rows.columns().empty()) return;
    facets.known.links.reset(); // its memory
    const auto row = [&](std::size_t v) { return facets.attributes.data() + v * rows.bytes(); };
    std::vector<std::uint8_t> measured(facets.mesh.vertex_count());
    for (std::size_t v = 0; v < measured.size(); ++v) measured[v] = rows.kind(row(v)) == PointKind::measured;
    facets.mesh.properties = rows.properties_of(facets.attributes);
    spread_attributes(facets.mesh, std::move(measured));
    const std::vector<VertexProperty> properties = std::exchange(facets.mesh.properties, {});
    std::vector<char> spread = rows.rows_of(properties, facets.mesh.vertex_count());
    for (std::size_t v = 0; v < facets.mesh.vertex_count(); ++v)
        rows.set_kind(spread.data() + v * rows.bytes(), rows.kind(row(v)));
    facets.attributes = std::move(spread);
}

/// The facets as if they were the measured cloud's.
void return_to(const ScratchCloud& measured, TiledDraft& draft) {
    if (!draft.cloud) return;
    const Vec3 moved = draft.cloud->origin() - measured.origin();
    for (Vec3& p : draft.facets.mesh.positions) p += moved;
    draft.facets.known.intersections.first += moved;
    spread_attributes(draft.facets);
}

} // namespace

WholeFacets facets_of_drafts(const DraftsInput& in, Report& report) {
    TiledDraft draft = first_draft(in);
    report.grid.sets = draft.facets.counts.sets;
    if (in.options.holes == Holes::automatic) complete_slits(in, draft, report);
    Ranks& ranks = in.cloud.ranks();
    const bool turned = ranks.of_first(ranks.is_first() && faces_inward(draft.facets.mesh));
    if (turned) in.make(draft, true);
    report.rejected["normals_turned"] = turned ? in.survey.sums.points() : 0;
    return_to(in.cloud, draft);
    return std::move(draft.facets);
}

} // namespace hsdm
