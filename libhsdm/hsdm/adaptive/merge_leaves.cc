#include "hsdm/adaptive/merge_leaves.hh"

#include "hsdm/adaptive/dissolve.hh"
#include "hsdm/adaptive/drop_vertices.hh"
#include "hsdm/adaptive/merge.hh"
#include "hsdm/adaptive/tidy.hh"
#include "hsdm/adaptive/trouble.hh"

#include <tbb/parallel_invoke.h>

#include <algorithm>
#include <functional>
#include <numeric>

namespace hsdm {
namespace {

constexpr double least_share = 0.2; // of the tolerance: what goes wrong below is not merged
constexpr double few_leaves = 0.02; // of all: so few need not be merged
constexpr double drop_share = 1.75; // of the tolerance: with twice that, places not looked at go far
constexpr int most_rings = 4;       // of facets around something wrong

struct Faults {
    FaultCounts counts;
    bool manifold = true;
    std::vector<Index> vertices; // where they are

    bool no_worse_than(const FaultCounts& other) const {
        return manifold && counts.crossing <= other.crossing && counts.distant <= other.distant
               && counts.points <= other.points;
    }
};

/// The leaves' mesh with vertices merged. A vertex with a tolerance of 0 is to stay.
using Merge = std::function<CollapsedMesh(const std::vector<double>& tolerance)>;

/// A way to merge, and how to go on from there.
struct MergeStep {
    Merge merge;
    Diagonals diagonals; ///< of the facets between
    bool blames_around;  ///< where nothing merged is something wrong, at once what merged beside it is blamed
};

/// Merges vertices of a mesh as far as nothing gets worse.
class MergeRounds {
public:
    MergeRounds(const LeafMesh& leaves, RoundChecks& checks, const MergeLeavesOptions& options)
        : leaves_(leaves),
          checks_(checks),
          options_(options),
          tolerance_(leaves.mesh.vertex_count(), checks.band().tolerance()) {}

    MergedLeaves run(const MergeStep& step) {
        for (int round = 0; round < options_.rounds; ++round) {
            merge_once(step);
            const Faults faults = find_faults();
            result_.faults = faults.counts;
            if (faults.no_worse_than(options_.faults)) return std::move(result_);
            if (keep_closer(faults.vertices, step.blames_around) == 0) break;
        }
        result_.mesh = leaves_.mesh;
        result_.vertex.resize(leaves_.mesh.vertex_count());
        std::iota(result_.vertex.begin(), result_.vertex.end(), Index{0});
        result_.faults = find_faults().counts;
        return std::move(result_);
    }

private:
    void merge_once(const MergeStep& step) {
        auto [mesh, stands_for] = step.merge(tolerance_);
        result_.mesh = std::move(mesh);
        std::vector<std::uint8_t> merged(stands_for.size(), 0);
        for (Index v = 0; v < stands_for.size(); ++v) merged[stands_for[v]] |= stands_for[v] != v;
        const std::vector<Index> leaf = drop_replaced(result_.mesh, stands_for);
        result_.vertex = std::move(stands_for);
        has_merged_ = picked(merged, leaf);
        // What nothing has changed stays as it is.
        std::vector<std::uint8_t> settled(leaf.size(), 1);
        for (Index v : with_neighbours(has_merged_)) settled[v] = 0;
        tidy_facets(result_.mesh, checks_.band(), settled, step.diagonals, tidied_);
    }

    /// Marked vertices, and those that share facets with them.
    std::vector<Index> with_neighbours(const std::vector<std::uint8_t>& marked) const {
        std::vector<Index> found;
        for (std::size_t f = 0; f < result_.mesh.facet_count(); ++f) {
            const auto ring = result_.mesh.facet(f);
            if (std::any_of(ring.begin(), ring.end(), [&](Index v) { return marked[v]; }))
                found.insert(found.end(), ring.begin(), ring.end());
        }
        return found;
    }

    Faults find_faults() {
        const PolygonMesh& mesh = result_.mesh;
        Findings found;
        Faults faults;
        tbb::parallel_invoke([&] { faults.vertices = troubled_vertices(mesh); },
                             [&] { found = checks_.look_at(mesh); });
        faults.manifold = faults.vertices.empty();
        faults.counts = found.count();
        const auto blame = [&](Index f) {
            if (f == no_index) return;
            const auto ring = mesh.facet(f);
            faults.vertices.insert(faults.vertices.end(), ring.begin(), ring.end());
        };
        for (Index v : found.far.fine_vertices) faults.vertices.push_back(result_.vertex[leaves_.vertex[v]]);
        for (Index v : found.far.vertices) faults.vertices.push_back(v);
        for (Index f : found.far.facets) blame(f);
        for (const auto& pair : found.crossing)
            for (Index f : pair) blame(f);
        for (Index p : found.far_points.points)
            blame(checks_.bound().nearest_facet(checks_.bound().point(p)));
        result_.far_points = std::move(found.far_points);
        return faults;
    }

    /// What was merged into these vertices is to miss its planes by less or, where nothing was, what was
    /// merged around them. Returns how many vertices of the leaves that concerns.
    std::size_t keep_closer(const std::vector<Index>& vertices, bool blame_around) {
        std::vector<std::uint8_t> wrong(result_.mesh.vertex_count(), 0);
        std::vector<std::uint8_t> unmerged(wrong.size(), 0);
        for (Index v : vertices) {
            wrong[v] = 1;
            unmerged[v] = blame_around && !has_merged_[v];
        }
        for (Index v : with_neighbours(unmerged)) wrong[v] = 1;
        for (int ring = 0; ring < most_rings; ++ring) {
            if (const std::size_t count = lower_tolerances(wrong); count > 0) return count;
            for (Index v : with_neighbours(wrong)) wrong[v] = 1;
        }
        return 0;
    }

    std::size_t lower_tolerances(const std::vector<std::uint8_t>& wrong) {
        std::vector<Index> concerned;
        for (Index leaf = 0; leaf < tolerance_.size(); ++leaf) {
            const Index v = result_.vertex[leaf];
            if (wrong[v] && has_merged_[v] && tolerance_[leaf] > 0) concerned.push_back(leaf);
        }
        const bool few =
            static_cast<double>(concerned.size()) < few_leaves * static_cast<double>(tolerance_.size());
        for (Index leaf : concerned) {
            double& tolerance = tolerance_[leaf];
            tolerance = few || tolerance < least_share * checks_.band().tolerance() ? 0 : 0.5 * tolerance;
        }
        return concerned.size();
    }

    const LeafMesh& leaves_;
    RoundChecks& checks_;
    const MergeLeavesOptions& options_;
    std::vector<double> tolerance_;        // per vertex of the leaves
    std::vector<std::uint8_t> has_merged_; // per vertex of the result
    TidiedGroups tidied_;                  // in the round before
    MergedLeaves result_;
};

/// What stands for what stands for each.
std::vector<Index> through(const std::vector<Index>& first, const std::vector<Index>& second) {
    std::vector<Index> result(first.size());
    std::transform(first.begin(), first.end(), result.begin(), [&](Index v) { return second[v]; });
    return result;
}

} // namespace

MergedLeaves merge_leaves(const LeafMesh& leaves, std::vector<Quadric> planes, RoundChecks& checks,
                          const MergeLeavesOptions& options) {
    std::vector<Merger> mergers; // of the round before, which most are again
    const CollapsingMesh unmerged(leaves.mesh);
    const auto by_planes = [&](const std::vector<double>& tolerance) {
        return merge_vertices(unmerged, planes, tolerance, mergers);
    };
    MergedLeaves merged = MergeRounds(leaves, checks, options).run({by_planes, Diagonals::may_flip, false});
    planes = std::vector<Quadric>(); // dropping asks for distances

    const LeafMesh base{std::move(merged.mesh), through(leaves.vertex, merged.vertex)};
    MergeLeavesOptions drop_options = options;
    drop_options.faults = merged.faults;
    const CollapsingMesh undropped(base.mesh);
    const std::vector<Drop> drops =
        find_drops(undropped, checks.bound().to_fine(), drop_share * checks.band().tolerance());
    const auto by_distance = [&](const std::vector<double>& tolerance) {
        std::vector<std::uint8_t> may_go(tolerance.size()); // what was wrong once stays
        for (std::size_t v = 0; v < may_go.size(); ++v) may_go[v] = tolerance[v] >= checks.band().tolerance();
        return drop_vertices(undropped, drops, may_go);
    };
    MergedLeaves dropped = MergeRounds(base, checks, drop_options).run({by_distance, Diagonals::stay, true});
    dropped.vertex = through(merged.vertex, dropped.vertex);
    return dropped;
}

} // namespace hsdm
