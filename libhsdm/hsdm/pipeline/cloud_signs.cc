#include "hsdm/pipeline/cloud_signs.hh"

#include "hsdm/core/large_vector.hh"
#include "hsdm/errors.hh"
#include "hsdm/normals/vote_on_normals.hh"
#include "hsdm/octree/spacing.hh"
#include "hsdm/pipeline/cell_attributes.hh"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

namespace hsdm {
namespace {

/// A patch of the whole, by the numbers that patches have there.
struct PatchRow {
    Index number, count;
    std::int32_t sides;
    float seen_by;
    Vec3 centroid, normal;
    Sights sights;
    std::uint8_t beside; ///< as sheets_beside(), if sheets may be layers
};

/// What is gathered of all parts to tell the sides.
struct SideEvidence {
    std::vector<PatchRow> patches;
    std::vector<SignedEdge> edges;
    std::vector<SignedEdge> layers; ///< as layer_evidence(), if sheets may be layers
};

/// Bytes that the first rank holds while it tells the sides: of a patch, and of what pairs of points say.
constexpr std::size_t bytes_per_patch = 300, bytes_per_edge = 80;

/// Throws Error where so many do not fit. `how`: that they are all, or more than.
void refuse_large(std::size_t patches, std::size_t edges, std::size_t memory, const char* how) {
    const std::size_t bytes = patches * bytes_per_patch + edges * bytes_per_edge;
    if (bytes > memory)
        throw Error(std::string("telling the sides of normals takes ") + how + " "
                    + std::to_string((bytes + 999999) / 1000000)
                    + " MB, which is held in memory; give --memory that much, or a cloud with normals");
}

/// The empty space of the whole cloud, and the edge of its voxels.
struct WholeSpace {
    EmptySpace space;
    double voxel_size;
};
WholeSpace space_of(const ScratchCloud& cloud, double spacing, std::size_t most) {
    const int depth = depth_of_space(cloud.cube_extent(), spacing);
    std::vector<MortonCode> codes;
    cloud.for_groups(most,
                     [&](const Octree& part) { append_large(codes, extract_level(part, depth).codes); });
    std::vector<MortonCode> all = values_of_all(cloud.ranks(), codes);
    sort_unique(all);
    return {EmptySpace(all, depth), cloud.cube_extent() / static_cast<double>(1u << depth)};
}

/// Looks at the parts for what tells the sides.
class EvidencePass {
public:
    /// `memory`: bytes that what is found may take, else it throws Error.
    EvidencePass(const ScratchCloud& cloud, const Estimating& how, const Viewpoints& viewpoints,
                 const EmptySpace& space, double spacing, bool may_be_layers, std::size_t memory,
                 PartStore& store)
        : cloud_(cloud),
          how_(how),
          viewpoints_(viewpoints),
          space_(space),
          spacing_(spacing),
          may_be_layers_(may_be_layers),
          memory_(memory),
          store_(store) {}

    SideEvidence evidence;

    /// Returns false, and takes nothing, if not all is known.
    bool add(const CloudPart& part) {
        if (part.lacks_neighbors(how_.neighbors.count)) return false;
        const PartNormals made(part, how_, store_);
        const std::vector<Index>& leaves = made.neighbors.leaf_first; // its own begin with its own points
        const auto leaf_at = [&](std::size_t point) {
            return static_cast<std::size_t>(std::ranges::lower_bound(leaves, point) - leaves.begin());
        };
        const std::size_t begin = leaf_at(part.begin()), end = leaf_at(part.end());
        const Index first = leaves[begin], last = leaves[end];
        // Own points before `first` are of a leaf that begins before the range, if it does so in the whole.
        if (!made.known.all(part.begin(), last) || !made.known.all_around(first, last)) return false;
        const auto patch_at = [&](Index point) {
            return static_cast<Index>(std::ranges::lower_bound(made.first_point, point)
                                      - made.first_point.begin());
        };
        const Index first_patch = patch_at(first), last_patch = patch_at(last);
        if (!see_all(part, made.patches, first_patch, last_patch)) return false;
        const OctreeLevel level = extract_level(part.octree(), space_.depth());
        const std::vector<Sights> seen =
            look_around(part.octree(), level, space_, made.patches, spacing_, first_patch, last_patch);
        for (const Sights& sights : seen)
            for (const Sight& sight : sights)
                if (!knows(made, level, sight)) return false;
        std::vector<std::uint8_t> beside(made.patches.size(), 0);
        if (may_be_layers_) {
            beside = sheets_beside(part.octree(), made.neighbors, made.estimate, made.patches);
            take(made, layer_evidence(part.octree(), made.neighbors, made.estimate, made.patches, begin, end),
                 evidence.layers);
        }
        const std::vector<float> by_sensors = seen_by(part, made.patches);
        for (Index p = first_patch; p < last_patch; ++p)
            take_patch(made, p, seen[p - first_patch], beside[p], by_sensors.empty() ? 0 : by_sensors[p]);
        take(made, patch_evidence(part.octree(), made.neighbors, made.estimate, made.patches, begin, end),
             evidence.edges);
        refuse_large(evidence.patches.size(), evidence.edges.size() + evidence.layers.size(), memory_,
                     "more than");
        return true;
    }

private:
    /// Has the part all that these patches may see?
    bool see_all(const CloudPart& part, const Patches& patches, Index begin, Index end) const {
        const double h = part.octree().voxel_size(space_.depth());
        for (Index p = begin; p < end; ++p) {
            VoxelCoord at;
            for (unsigned k = 0; k < 3; ++k)
                at[k] = static_cast<std::int32_t>(std::floor(patches.centroids[p][k] / h));
            if (!part.has_around(at, space_.depth(), depth_of_sight())) return false;
        }
        return true;
    }

    /// As seen_by_sensors(), of the part's own patches.
    std::vector<float> seen_by(const CloudPart& part, const Patches& patches) const {
        const std::vector<std::int32_t> scanners = scanners_of(cloud_, part.octree());
        if (scanners.empty())
            return seen_by_sensors(part.octree(), patches, viewpoints_, part.octree().source);
        const Viewpoints viewpoints{viewpoints_.sensors,
                                    StridedSpan(scanners.data(), scanners.size(), sizeof(std::int32_t))};
        std::vector<Index> places = unwritten_vector<Index>(scanners.size());
        std::iota(places.begin(), places.end(), Index{0});
        return seen_by_sensors(part.octree(), patches, viewpoints, places);
    }

    /// Does the patch see the same in the whole? A sheet whose points have no normal here may have one there.
    static bool knows(const PartNormals& made, const OctreeLevel& level, const Sight& sight) {
        if (sight.patch != no_index) return made.known[made.first_point[sight.patch]];
        const Index voxel = sight.region == no_index ? level.find(sight.voxel) : no_index;
        if (voxel == no_index) return true;
        for (Index i = level.first_point[voxel]; i < level.first_point[voxel + 1]; ++i)
            if (made.patches.of_point[i] == no_index && !made.known[i]) return false;
        return true;
    }

    void take_patch(const PartNormals& made, Index p, Sights sights, std::uint8_t beside, float seen_by) {
        for (Sight& sight : sights)
            if (sight.patch != no_index) sight.patch = made.number(sight.patch);
        push_large(evidence.patches,
                   PatchRow{made.number(p), made.patches.counts[p], made.patches.sides[p], seen_by,
                            made.patches.centroids[p], made.patches.normals[p], sights, beside});
    }
    static void take(const PartNormals& made, std::vector<SignedEdge> found, std::vector<SignedEdge>& all) {
        for (SignedEdge& edge : found) edge.a = made.number(edge.a), edge.b = made.number(edge.b);
        append_large(all, found);
    }

    const ScratchCloud& cloud_;
    const Estimating& how_;
    const Viewpoints& viewpoints_;
    const EmptySpace& space_;
    double spacing_;
    bool may_be_layers_;
    std::size_t memory_;
    PartStore& store_;
};

/// On the first rank: what all have found. Others are left with nothing.
SideEvidence gathered(SideEvidence&& own, Ranks& ranks, std::size_t memory) {
    refuse_large(ranks.sum(own.patches.size()), ranks.sum(own.edges.size() + own.layers.size()), memory,
                 "about");
    if (ranks.size() == 1) return std::move(own);
    std::vector<Ranks::Bytes> out(static_cast<std::size_t>(ranks.size()));
    put_vector(own.patches, out.front());
    put_vector(own.edges, out.front());
    put_vector(own.layers, out.front());
    own = {};
    for (const Ranks::Bytes& got : ranks.exchange(std::move(out))) {
        if (got.empty()) continue;
        ByteReader reader(got);
        append_large(own.patches, reader.take_vector<PatchRow>());
        append_large(own.edges, reader.take_vector<SignedEdge>());
        append_large(own.layers, reader.take_vector<SignedEdge>());
    }
    return std::move(own);
}

/// What is of patches, as make_normals() has it.
struct WholeEvidence {
    Patches patches; ///< without what is of points
    std::vector<Sights> seen;
    std::vector<std::uint8_t> beside;
    std::vector<float> seen_by; ///< as seen_by_sensors()
};

/// The evidence of all patches as make_normals() has it: in the order of their numbers, which become their
/// places in it. Leaves `all` without what is of patches.
WholeEvidence whole_evidence(SideEvidence& all, bool is_seen, SignsOfAll& result) {
    std::ranges::sort(all.patches, {}, &PatchRow::number);
    WholeEvidence whole;
    for (const PatchRow& row : all.patches) {
        push_large(result.number, row.number);
        push_large(whole.patches.counts, row.count);
        push_large(whole.patches.sides, row.sides);
        push_large(whole.patches.centroids, row.centroid);
        push_large(whole.patches.normals, row.normal);
        push_large(whole.seen, row.sights);
        push_large(whole.beside, row.beside);
        if (is_seen) push_large(whole.seen_by, row.seen_by);
    }
    release(all.patches);
    for (Sights& sights : whole.seen)
        for (Sight& sight : sights)
            if (sight.patch != no_index) sight.patch = result.place(sight.patch);
    for (std::vector<SignedEdge>* edges : {&all.edges, &all.layers})
        for (SignedEdge& edge : *edges) edge.a = result.place(edge.a), edge.b = result.place(edge.b);
    return whole;
}

/// None if it takes the evidence of layers, which `all` has not.
std::optional<SignsOfAll> signs_of(SideEvidence&& all, const WholeSpace& around, bool may_be_layers,
                                   const OrientOptions& options) {
    SignsOfAll result;
    const WholeEvidence whole = whole_evidence(all, !options.viewpoints.sensors.empty(), result);
    bool lacks_layers = false;
    const auto read_layers = [&] {
        lacks_layers = !may_be_layers;
        LayerReading layers;
        layers.edges = std::move(all.layers);
        layers.sky.assign(whole.patches.size(), 0), layers.clear_sky = layers.sky;
        if (lacks_layers) return layers;
        OutsideView view =
            judge_sights(around.space, whole.seen, whole.patches, around.voxel_size, whole.beside);
        layers.sky = std::move(view.sky), layers.clear_sky = std::move(view.clear_sky);
        return layers;
    };
    PatchSigns signs = sign_patches(whole.patches, std::move(all.edges),
                                    judge_sights(around.space, whole.seen, whole.patches, around.voxel_size),
                                    whole.seen_by, options, read_layers);
    if (lacks_layers) return std::nullopt;
    result.sign = std::move(signs.sign);
    result.report = signs.report;
    return result;
}

/// What the first rank finds, if it does.
std::optional<SignsOfAll> signs_of_all(SideEvidence&& own, const WholeSpace& space, bool may_be_layers,
                                       Ranks& ranks, std::size_t memory, const OrientOptions& options) {
    SideEvidence all = gathered(std::move(own), ranks, memory);
    Ranks::Bytes bytes;
    if (ranks.is_first())
        if (const auto found = signs_of(std::move(all), space, may_be_layers, options)) {
            put(found->report, bytes);
            put_vector(found->number, bytes);
            put_vector(found->sign, bytes);
        }
    const Ranks::Bytes got = ranks.of_first(std::move(bytes));
    if (got.empty()) return std::nullopt;
    ByteReader reader(got);
    SignsOfAll result;
    result.report = reader.take<OrientReport>();
    result.number = reader.take_vector<Index>();
    result.sign = reader.take_vector<std::int8_t>();
    return result;
}

} // namespace

Index SignsOfAll::place(Index patch) const {
    const auto at = std::ranges::lower_bound(number, patch);
    if (at == number.end() || *at != patch)
        throw Error("no part took patch " + std::to_string(patch)
                    + ", a fault of hsdm; reconstruct the cloud in one piece (by hsdm, without --memory)");
    return static_cast<Index>(at - number.begin());
}

PartEstimate::PartEstimate(const CloudPart& part, const Estimating& how, PartStore& store)
    : neighbors(store.neighbors(part, how.neighbors)),
      estimate(estimate_normals(part.octree(), neighbors, how.estimate)),
      known(part.known_by(neighbors)) {
    known.step();                                       // what is bent hangs on how far neighbours spread
    known.step(estimate.bent, 2 * how.estimate.rounds); // as estimate_normals() renews them
}

std::vector<Vec3> PartEstimate::refine(const CloudPart& part) {
    known.step();
    if (estimate.noise > estimation::rough) known.step();
    return refined_normals(part.octree(), neighbors, estimate);
}

void PartEstimate::vote(const CloudPart& part) {
    vote_on_normals(part.octree(), neighbors, estimate);
    known.step(estimate.bent, repeats::twice);
}

PartNormals::PartNormals(const CloudPart& part, const Estimating& how, PartStore& store)
    : PartEstimate(part, how, store), part_(part) {
    if (how.normals == Estimating::Normals::given) estimate.normals = part.octree().normals;
    if (how.normals == Estimating::Normals::along_given) turn_along(part.octree().normals, estimate.normals);
    patches = build_patches(part.octree(), neighbors, estimate);
    known.step_leaves();
    for (std::size_t i = 0; i < part.octree().size(); ++i)
        if (patches.of_point[i] == first_point.size()) first_point.push_back(static_cast<Index>(i));
}

std::vector<std::int8_t> PartNormals::signs(const SignsOfAll& all) const {
    std::vector<std::int8_t> sign(patches.size(), 1);
    for (Index p = 0; p < sign.size(); ++p)
        if (known[first_point[p]]) sign[p] = all.sign[all.place(number(p))];
    return sign;
}

SignsOfAll find_signs(ScratchCloud& cloud, const CloudSurvey& survey, const Estimating& how,
                      const OrientOptions& options, const CloudPasses& passes, std::size_t memory,
                      PartStore& store) {
    const double spacing = estimate_spacing(survey.sums.counts(), cloud.cube_extent());
    const WholeSpace whole = space_of(cloud, spacing, passes.most_points);
    const std::vector<VoxelRange> ranges = passes.plan(cloud, passes.ghost_voxels);
    for (bool may_be_layers = false;; may_be_layers = true) {
        EvidencePass pass(cloud, how, options.viewpoints, whole.space, spacing, may_be_layers, memory, store);
        for_parts(cloud, survey.sums, ranges, store.widths,
                  [&](const CloudPart& part) { return pass.add(part); });
        if (auto signs =
                signs_of_all(std::move(pass.evidence), whole, may_be_layers, cloud.ranks(), memory, options))
            return std::move(*signs);
    }
}

} // namespace hsdm
