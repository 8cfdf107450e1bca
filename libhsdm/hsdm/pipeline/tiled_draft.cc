#include "hsdm/pipeline/tiled_draft.hh"

#include "hsdm/completion/constants.hh"
#include "hsdm/core/constants.hh"
#include "hsdm/core/hash.hh"
#include "hsdm/io/parked_arrays.hh"
#include "hsdm/mesh/small_components.hh"
#include "hsdm/pipeline/attributes.hh"
#include "hsdm/pipeline/cloud_free_space.hh"
#include "hsdm/pipeline/cloud_sparse_areas.hh"
#include "hsdm/pipeline/extended_method.hh"
#include "hsdm/pipeline/tile_plan.hh"

#include <algorithm>
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
    return draft_of(in, in.cloud.with_points(between, in.cloud.depth() - above, in.passes.most_points));
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

BoundaryLoops loops_of(WholeFacets& facets) {
    std::optional<FacetLinks>& links = facets.known.links;
    if (!links) links = link_facets(facets.mesh);
    return boundary_loops(facets.mesh, *links);
}

/// What closes the slits of a draft, on the first rank.
SlitCompletion slits_of(const DraftsInput& in, TiledDraft& draft) {
    if (!in.cloud.ranks().is_first()) return {};
    const ScratchCloud& cloud = cloud_of(in, draft);
    const OctreeLevel level = cloud.no_voxels();
    const MethodInput method{cloud.frame(), {}, cloud.no_points(), level, in.options, in.phases};
    return slit_completion(method, in.survey.spacing, draft.facets.mesh, loops_of(draft.facets));
}

/// The draft's points and those of the first rank that complete them.
TiledDraft completed_draft(const DraftsInput& in, const TiledDraft& before, const CompletedPoints& points,
                           CompletedRound round) {
    const ScratchCloud& cloud = cloud_of(in, before);
    const double shift = round == CompletedRound::none ? 0 : completing::shift;
    TiledDraft draft = draft_of(in, cloud.with_points(points, shift, in.passes.most_points));
    draft.completed = round;
    OrderedHash hash;
    hash.add(before.added);
    for (const std::vector<Vec3>* places : {&points.positions, &points.normals})
        for (const Vec3& p : *places)
            for (const double x : p) hash.add(x);
    Ranks::Bytes bytes;
    put(hash.value(), bytes);
    draft.added = ByteReader(cloud.ranks().of_first(std::move(bytes))).take<std::uint64_t>();
    return draft;
}

/// On the first rank.
FacetFaults faults_of(WholeFacets& facets) {
    return {facets.known.intersections.count, loops_of(facets).vertices.size()};
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
        TiledDraft next = completed_draft(in, draft, slits.points, CompletedRound::none);
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

/// Points that close loops of the first rank's facets. What scanners looked through is found each time: it
/// is not held while tiles are made. `sees_space`: is any known?
CompletedPoints completing_points(const DraftsInput& in, const ScratchCloud& cloud, const PolygonMesh& facets,
                                  const BoundaryLoops& loops, Passing passing, bool* sees_space = nullptr) {
    CompleteOptions how{passing};
    const std::size_t of_mesh = facets.vertex_count() * bytes_per_voxel_in_completion;
    how.most_bytes = in.memory - std::min(in.memory, of_mesh);
    const FreeSpace free = cloud_free_space(in.cloud, in.passes.most_points, how.most_bytes);
    if (sees_space) *sees_space = !free.empty();
    if (!in.cloud.ranks().is_first()) return {};
    if (!free.empty()) {
        how.most_bytes -= std::min(how.most_bytes, in.survey.sums.points() * bytes_per_ray);
        how.empty = [&, moved = cloud.origin() - in.cloud.origin()](const Vec3& place) {
            return free.holds(place + moved);
        };
    }
    return complete_surface(facets, loops, cloud.voxel_size(), how);
}

/// A draft with all loops of another one completed.
struct TiledCompletion {
    TiledDraft draft;
    std::size_t left = 0;    ///< as Completion of extended_method() has it; of the first rank
    bool sees_space = false; ///< likewise, as in CompletionCheck
    Report noted{};          ///< likewise, the loops of the second round

    FacetFaults faults() const { return {draft.facets.known.intersections.count, left}; }
};

/// As the one of extended_method(). `park` is called once the draft's facets, whose loops these are, are not
/// read any more.
TiledCompletion completed_all(const DraftsInput& in, const TiledDraft& draft, const BoundaryLoops& loops,
                              Passing passing, const std::function<void()>& park) {
    Ranks& ranks = in.cloud.ranks();
    const PolygonMesh& mesh = draft.facets.mesh;
    TiledCompletion result;
    CompletedPoints points =
        completing_points(in, cloud_of(in, draft), mesh, loops, passing, &result.sees_space);
    const bool has_new_cavities = ranks.is_first() && !has_cavity(mesh);
    park();
    result.draft = completed_draft(in, draft, points, CompletedRound::first);
    points = CompletedPoints(); // frees what is not needed any more
    in.make(result.draft, false);
    BoundaryLoops left;
    if (ranks.is_first()) left = loops_of(result.draft.facets);
    if (ranks.of_first(left.size() > 0)) {
        result.left = left.vertices.size();
        const ScratchCloud& cloud = *result.draft.cloud;
        note_loops(result.draft.facets.mesh, left, true, cloud.origin(), cloud.frame(), result.noted);
        points = completing_points(in, cloud, result.draft.facets.mesh, left, passing);
        result.draft.facets = WholeFacets();
        result.draft = completed_draft(in, result.draft, points, CompletedRound::second);
        points = CompletedPoints();
        in.make(result.draft, false);
    }
    result.draft.facets.known.links.reset();
    result.draft.has_new_cavities = has_new_cavities;
    return result;
}

/// As the one of extended_method(). Facets that are not looked at wait on scratch.
void complete_all(const DraftsInput& in, TiledDraft& draft, Report& report) {
    Ranks& ranks = in.cloud.ranks();
    WholeFacets& facets = draft.facets;
    BoundaryLoops loops;
    if (ranks.is_first()) loops = loops_of(facets);
    if (!ranks.of_first(loops.size() > 0)) return;
    const FacetFaults before{facets.known.intersections.count, loops.vertices.size()};
    facets.known = FacetKnowledge(); // frees what is not needed any more
    release(facets.attributes);
    const ScratchCloud& cloud = cloud_of(in, draft);
    note_loops(facets.mesh, loops, true, cloud.origin(), cloud.frame(), report);
    PolygonMesh& mesh = facets.mesh;
    ParkedArrays waiting(&in.parking);
    TiledCompletion result = completed_all(in, draft, loops, Passing::ignored,
                                           [&] { waiting.park(mesh.positions, mesh.first, mesh.corners); });
    const CompletionCheck check{before, result.sees_space};
    if (ranks.of_first(check.is_doubtful(result.faults()))) {
        WholeFacets& first = result.draft.facets;
        ParkedArrays other(&in.parking);
        other.park(first.mesh.positions, first.mesh.first, first.mesh.corners, first.known.hints.sides,
                   first.attributes);
        waiting.restore();
        TiledCompletion beside =
            completed_all(in, draft, loops, Passing::stopped, [&] { mesh = PolygonMesh(); });
        if (ranks.of_first(check.is_better(beside.faults(), result.faults()))) {
            result = std::move(beside);
        } else {
            beside.draft = TiledDraft(); // its memory first
            other.restore();
        }
    }
    report.loops.insert(report.loops.end(), result.noted.loops.begin(), result.noted.loops.end());
    draft = std::move(result.draft);
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

/// So that all meshes that were to be completed tell what was, also where there was nothing to complete.
void mark_all(WholeFacets& facets) {
    const AttributeRows before = facets.rows;
    if (before.has_kinds()) return;
    facets.rows = before.with_kinds();
    const std::size_t bytes = before.bytes();
    std::vector<char> rows = large_vector<char>(facets.mesh.vertex_count() * facets.rows.bytes());
    for (std::size_t v = 0; v < facets.mesh.vertex_count(); ++v) {
        char* const row = rows.data() + v * facets.rows.bytes();
        std::copy_n(facets.attributes.data() + v * bytes, bytes, row);
        facets.rows.set_kind(row, PointKind::measured);
    }
    facets.attributes = std::move(rows);
}

/// Vertices stay, without facets.
void leave_out_cavities(const DraftsInput& in, WholeFacets& facets, Report& report) {
    const ScratchCloud& cloud = in.cloud;
    const OctreeLevel level = cloud.no_voxels();
    const MethodInput method{cloud.frame(), {}, cloud.no_points(), level, in.options, in.phases};
    drop_cavities(method, facets.mesh, facets.known, report);
}

} // namespace

WholeFacets facets_of_drafts(const DraftsInput& in, Report& report) {
    TiledDraft draft = first_draft(in);
    report.grid.sets = draft.facets.counts.sets;
    if (in.options.holes == Holes::automatic || in.options.holes == Holes::complete)
        complete_slits(in, draft, report);
    if (in.options.holes == Holes::complete) complete_all(in, draft, report);
    Ranks& ranks = in.cloud.ranks();
    const bool turned = ranks.of_first(ranks.is_first() && faces_inward(draft.facets.mesh));
    if (turned) in.make(draft, true);
    report.rejected["normals_turned"] = turned ? in.survey.sums.points() : 0;
    return_to(in.cloud, draft);
    if (in.options.holes == Holes::complete) mark_all(draft.facets);
    if (draft.has_new_cavities) leave_out_cavities(in, draft.facets, report);
    return std::move(draft.facets);
}

} // namespace hsdm
