#include "hsdm/simplify/decimate.hh"

#include "hsdm/core/chunks.hh"
#include "hsdm/core/interruption.hh"
#include "hsdm/mesh/facet_unions.hh"
#include "hsdm/mesh/part_of.hh"
#include "hsdm/simplify/collapse_by_distance.hh"
#include "hsdm/simplify/collapse_by_planes.hh"
#include "hsdm/simplify/constants.hh"
#include "hsdm/simplify/leaf_doublets.hh"
#include "hsdm/simplify/nonmanifold_vertices.hh"
#include "hsdm/simplify/remesh_by_flips.hh"

#include <algorithm>
#include <array>
#include <functional>
#include <iterator>

namespace hsdm {
namespace {

constexpr int most_doublings = 32; // of the reach of a search for the fine surface

struct Faults {
    FaultCounts counts;
    bool manifold = true;
    std::vector<Index> vertices; // where the mesh is no 2-manifold
    // sources beside places too far off or intersections
    std::vector<std::array<Index, 3>> sources;

    bool no_worse_than(const FaultCounts& other) const {
        return manifold && counts.intersecting <= other.intersecting && counts.distant <= other.distant
               && counts.points <= other.points;
    }
};

/// Returns the mesh with vertices merged. A vertex with a tolerance of 0 is to stay.
using Merge = std::function<CollapsedMesh(const std::vector<double>& tolerance)>;

/// A way to merge vertices, and what the remeshing after it may do.
struct DecimationStep {
    Merge merge;
    Diagonals diagonals; ///< of the remeshing
};

/// Merges vertices of a mesh as far as that causes no new faults. A `source` is a vertex of the mesh that the
/// step begins from: the one over the octree's leaves first, what the first step left of it then.
class DecimationRounds {
public:
    DecimationRounds(const ClusteredMesh& clustered, MeshChecks& checks, const DecimateOptions& options)
        : input_(clustered),
          checks_(checks),
          options_(options),
          tolerance_(clustered.mesh.vertex_count(), checks.envelope().tolerance),
          doublets_(vertices_of_two_facets(clustered.mesh)) {}

    DecimatedMesh run(const DecimationStep& step) {
        for (int round = 0; round < options_.rounds; ++round) {
            merge_once(step);
            const Faults faults = find_faults();
            result_.faults = faults.counts;
            if (faults.no_worse_than(options_.faults)) return std::move(result_);
            const std::size_t kept = keep(faults.sources);
            if (kept + keep_closer(faults.vertices) > 0) continue;
            std::vector<Index> vertices; // the faults' own vertices, when nothing above has helped
            for (const auto& sources : faults.sources)
                for (Index source : sources) vertices.push_back(result_.vertex[source]);
            if (keep_closer(vertices) == 0) break;
        }
        result_.mesh = copy_of(input_.mesh);
        result_.vertex = indices_below(input_.mesh.vertex_count());
        has_merged_.assign(input_.mesh.vertex_count(), 0);
        result_.faults = find_faults().counts;
        return std::move(result_);
    }

private:
    static std::vector<Index> vertices_of_two_facets(const PolygonMesh& mesh) {
        const VertexFacets at = facets_at_vertices(mesh);
        return indices_where(mesh.vertex_count(), chunks::light, [&](Index v) { return at.count[v] == 2; });
    }

    /// Per vertex of the result, may it have only two facets, as it had from the beginning? Empty if none
    /// may.
    std::vector<std::uint8_t> doublets() const {
        if (doublets_.empty()) return {};
        std::vector<std::uint8_t> marked(result_.mesh.vertex_count(), 0);
        for (Index source : doublets_) {
            const Index v = result_.vertex[source];
            marked[v] |= !has_merged_[v];
        }
        return marked;
    }

    void merge_once(const DecimationStep& step) {
        auto [mesh, stands_for, flipped] = step.merge(tolerance_);
        result_.mesh = std::move(mesh);
        std::vector<std::uint8_t> merged = large_vector<std::uint8_t>(stands_for.size());
        const auto mark = [&, &stands_for = stands_for, &flipped = flipped](std::size_t v) {
            merged[stands_for[v]] |= stands_for[v] != v || flipped[v] != 0
                                     || result_.mesh.positions[v] != input_.mesh.positions[v];
        };
        for_each_in_order(stands_for.size(), mark);
        const std::vector<Index> source = drop_replaced(result_.mesh, stands_for);
        result_.vertex = std::move(stands_for);
        has_merged_ = gathered(merged, source);
        // Facets that no merger has changed stay as they are.
        std::vector<std::uint8_t> fixed(source.size(), 1);
        for (Index v : with_neighbours(result_.mesh, has_merged_)) fixed[v] = 0;
        remesh_by_flips(result_.mesh, checks_.envelope(), fixed, step.diagonals, remeshed_);
    }

    /// Marked vertices, and those that share facets with them.
    static std::vector<Index> with_neighbours(const PolygonMesh& mesh,
                                              const std::vector<std::uint8_t>& marked) {
        std::vector<Index> found;
        for_each_in_order(mesh.facet_count(), [&](std::size_t f) {
            const auto ring = mesh.facet(f);
            if (std::any_of(ring.begin(), ring.end(), [&](Index v) { return marked[v]; }))
                found.insert(found.end(), ring.begin(), ring.end());
        });
        return found;
    }

    Faults find_faults() {
        const PolygonMesh& mesh = result_.mesh;
        Findings found;
        Faults faults;
        run_both([&] { found = checks_.look_at(mesh); },
                 [&] { faults.vertices = nonmanifold_vertices(mesh, doublets()); });
        faults.manifold = faults.vertices.empty();
        faults.counts = found.count();
        for (Index v : found.far.fine_vertices) {
            const Index source = input_.vertex[v];
            faults.sources.push_back({source, source, source});
        }
        for (Index v : found.far.vertices) add_sources(mesh.positions[v], faults.sources);
        for (const Vec3& place : found.far.on_facets) add_sources(place, faults.sources);
        for_each_in_order(found.far_points.points.size(), [&](std::size_t i) {
            add_sources(checks_.distances().point(found.far_points.points[i]), faults.sources);
        });
        for (const auto& [f, g] : found.intersecting)
            for (Index v : mesh.facet(diagonal(g) < diagonal(f) ? g : f))
                add_sources(mesh.positions[v], faults.sources);
        result_.far_points = std::move(found.far_points);
        return faults;
    }

    /// The diagonal of a facet's box, squared.
    double diagonal(Index facet) const {
        const Box box = box_of(result_.mesh, facet);
        return (box.hi - box.lo).sqrnorm();
    }

    /// Adds the sources that stand for the corners of a triangle of the fine surface near a place.
    void add_sources(const Vec3& place, std::vector<std::array<Index, 3>>& sources) const {
        const SurfaceWalk& fine = checks_.distances().to_fine();
        Index triangle = no_index, hint = no_index;
        double reach = checks_.envelope().tolerance;
        for (int k = 0; k < most_doublings && triangle == no_index; ++k, reach *= 2)
            triangle = fine.triangle_within(place, reach, hint);
        if (triangle == no_index) return;
        const auto [a, b, c] = fine.corners(triangle);
        sources.push_back({input_.vertex[a], input_.vertex[b], input_.vertex[c]});
    }

    bool may_be_kept(Index source) const {
        return tolerance_[source] > 0 && has_merged_[result_.vertex[source]];
    }

    /// Sets the tolerance of the sources at faults to 0, so that they stay as they were; where all
    /// of them do already, that of those around them. So a fault in one place costs no vertices elsewhere.
    /// Returns how many that concerns.
    std::size_t keep(const std::vector<std::array<Index, 3>>& faults) {
        std::vector<Index> kept;
        std::vector<std::uint8_t> around(tolerance_.size(), 0);
        bool is_helped = true;
        for (const auto& sources : faults) {
            const std::size_t before = kept.size();
            std::copy_if(sources.begin(), sources.end(), std::back_inserter(kept),
                         [&](Index source) { return may_be_kept(source); });
            if (kept.size() > before) continue;
            is_helped = false;
            for (Index source : sources) around[source] = 1;
        }
        for (int ring = 0; ring < decimation::most_rings && !is_helped; ++ring)
            for (Index source : with_neighbours(input_.mesh, around)) {
                around[source] = 1;
                if (!may_be_kept(source)) continue;
                kept.push_back(source);
                is_helped = true;
            }
        sort_unique(kept);
        for (Index source : kept) tolerance_[source] = 0;
        return kept.size();
    }

    /// Lowers the tolerances of what was merged into these vertices or, where nothing was, into those around
    /// them. Returns how many sources that concerns.
    std::size_t keep_closer(const std::vector<Index>& vertices) {
        std::vector<std::uint8_t> wrong(result_.mesh.vertex_count(), 0);
        for (Index v : vertices) wrong[v] = 1;
        for (int ring = 0; ring < decimation::most_rings && !vertices.empty(); ++ring) {
            if (const std::size_t count = lower_tolerances(wrong); count > 0) return count;
            for (Index v : with_neighbours(result_.mesh, wrong)) wrong[v] = 1;
        }
        return 0;
    }

    std::size_t lower_tolerances(const std::vector<std::uint8_t>& wrong) {
        std::vector<Index> concerned;
        for_each_in_order(tolerance_.size(), [&](std::size_t source) {
            const Index v = result_.vertex[source];
            if (wrong[v] && has_merged_[v] && tolerance_[source] > 0)
                concerned.push_back(static_cast<Index>(source));
        });
        const bool few = static_cast<double>(concerned.size())
                         < decimation::few_leaves * static_cast<double>(tolerance_.size());
        for (Index source : concerned) {
            double& tolerance = tolerance_[source];
            tolerance = few || tolerance < decimation::least_share * checks_.envelope().tolerance
                            ? 0
                            : 0.5 * tolerance;
        }
        return concerned.size();
    }

    const ClusteredMesh& input_;
    MeshChecks& checks_;
    const DecimateOptions& options_;
    std::vector<double> tolerance_;        // per source
    std::vector<Index> doublets_;          // sources with two facets
    std::vector<std::uint8_t> has_merged_; // per vertex of the result
    RemeshedGroups remeshed_;              // results of the round before
    DecimatedMesh result_;
};

/// Composes two maps: per item of the first, what stands for it after both.
std::vector<Index> through(const std::vector<Index>& first, const std::vector<Index>& second) {
    std::vector<Index> result = large_vector<Index>(first.size());
    for_each_index(first.size(), chunks::light, [&](Index v) { result[v] = second[first[v]]; });
    return result;
}

} // namespace

DecimatedMesh decimate(const ClusteredMesh& clustered, std::vector<Quadric> planes, MeshChecks& checks,
                       const DecimateOptions& options) {
    std::vector<PlaneCollapse> plane_collapses; // of the round before; most of them are made again
    const CollapsingMesh unmerged(clustered.mesh);
    const auto by_planes = [&](const std::vector<double>& tolerance) {
        return collapse_by_planes(unmerged, planes, tolerance, plane_collapses);
    };
    DecimatedMesh merged = DecimationRounds(clustered, checks, options).run({by_planes, Diagonals::may_flip});
    planes = std::vector<Quadric>(); // collapse by distance does not need them

    const ClusteredMesh base{std::move(merged.mesh), through(clustered.vertex, merged.vertex)};
    DecimateOptions drop_options = options;
    drop_options.faults = merged.faults;
    const CollapsingMesh undropped(base.mesh);
    const std::vector<DistanceCollapse> drops = find_distance_collapses(
        undropped, checks.distances().to_fine(), bounds::drop_share * checks.envelope().tolerance);
    const auto by_distance = [&](const std::vector<double>& tolerance) {
        std::vector<std::uint8_t> may_go(tolerance.size()); // a vertex with a fault in a round before stays
        for (std::size_t v = 0; v < may_go.size(); ++v)
            may_go[v] = tolerance[v] >= checks.envelope().tolerance;
        return collapse_by_distance(undropped, drops, may_go);
    };
    DecimatedMesh dropped = DecimationRounds(base, checks, drop_options).run({by_distance, Diagonals::stay});
    dropped.vertex = through(merged.vertex, dropped.vertex);
    return dropped;
}

} // namespace hsdm
