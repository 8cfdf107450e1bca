#include "hsdm/simplify/simplify.hh"

#include "hsdm/core/chunks.hh"
#include "hsdm/core/constants.hh"
#include "hsdm/core/interruption.hh"
#include "hsdm/errors.hh"
#include "hsdm/mesh/part_of.hh"
#include "hsdm/quality/distance_to_surface.hh"
#include "hsdm/simplify/clusters.hh"
#include "hsdm/simplify/constants.hh"
#include "hsdm/simplify/decimate.hh"
#include "hsdm/simplify/leaf_doublets.hh"
#include "hsdm/simplify/nonmanifold_vertices.hh"
#include "hsdm/simplify/planar_patches.hh"
#include "hsdm/simplify/remesh_by_flips.hh"
#include "hsdm/spatial/self_intersections.hh"

#include <algorithm>
#include <cmath>
#include <optional>

namespace hsdm {
namespace {

constexpr std::size_t fewest_samples = 10000, most_samples = 100000;

/// A cluster, which becomes a vertex of the result.
struct LeafCluster {
    int level = 0;
    Index cluster = no_index;
    Index cell = no_index;
};

class Simplification {
public:
    Simplification(const PolygonMesh& fine, std::span<const Vec3> points, double extent, int depth,
                   const SimplifyOptions& options, const FacetCells* cells)
        : fine_(fine),
          points_(points),
          options_(options),
          tree_(build_cell_tree(fine.positions, extent, depth)) {
        run_both( // each has steps that run on one thread
            [&] {
                // half, for what bends to either side of a strip's plane, and its neighbours' corners
                patches_ = find_planar_patches(fine, 0.5 * options.max_error);
                planes_ = vertex_planes(fine, patches_, tolerance());
                clusters_ = build_clusters(fine, tree_, planes_, tolerance());
            },
            [&] {
                checks_.emplace(fine, cells, points, options.max_error,
                                bounds::place_spacing * extent / static_cast<double>(1u << depth),
                                tolerance());
            });
    }

    AdaptiveMesh run() {
        int round = 0;
        while (round < options_.rounds + kept_ && split_what_is_wrong() > 0) ++round;
        if (round == options_.rounds + kept_ || result_.points_beyond > result_.unreachable)
            settle_for_fine();
        else
            decimate_leaves();
        count_leaves();
        if (options_.measure) {
            const std::size_t samples =
                std::clamp(2 * result_.mesh.facet_count(), fewest_samples, most_samples);
            result_.to_fine =
                points_to_surface(sample_surface(result_.mesh, samples), checks_->distances().to_fine());
        }
        result_.vertex = std::move(vertex_);
        result_.mesh.origin.clear();
        return std::move(result_);
    }

private:
    /// Builds and checks the mesh over the current leaves, and subdivides those at faults; returns how many.
    std::size_t split_what_is_wrong() {
        result_.balance_splits += balance(tree_);
        mesh_over_leaves();
        drop_doublets();
        const std::size_t troubled = split_troubled();
        result_.topology_splits += troubled;
        if (troubled > 0) return troubled; // the other checks need a 2-manifold
        remesh_by_flips(result_.mesh, checks_->envelope(), own(), Diagonals::may_flip, remeshed_);
        const Findings found = checks_->look_at(result_.mesh);
        faults_ = found.count();
        set_beyond(found.far_points);
        const std::size_t intersecting = split_intersecting(found), distant = split_distant(found);
        result_.intersection_splits += intersecting;
        result_.error_splits += distant;
        return intersecting + distant > 0 ? intersecting + distant : keep_doublets(found);
    }

    /// Merges vertices of leaves (decimate).
    void decimate_leaves() {
        ClusteredMesh leaves{std::move(result_.mesh), std::move(vertex_)};
        std::vector<Quadric> leaf_planes = large_vector<Quadric>(leaves.mesh.vertex_count());
        for_each_in_order(planes_.size(),
                          [&](std::size_t v) { leaf_planes[leaves.vertex[v]] += planes_[v]; });
        // A vertex that stands for a dropped doublet has that one's planes too.
        for_each_index(leaf_planes.size(), chunks::slow,
                       [&](Index v) { leaf_planes[v].drop_shared(leaves.mesh.positions[v], tolerance()); });
        planes_ = std::vector<Quadric>();
        DecimatedMesh merged = decimate(leaves, std::move(leaf_planes), *checks_,
                                        {.faults = faults_, .rounds = options_.rounds});
        result_.mesh = std::move(merged.mesh);
        result_.merged = leaves.mesh.vertex_count() - result_.mesh.vertex_count();
        set_beyond(merged.far_points);
        result_.intersecting = merged.faults.intersecting;
        vertex_ = std::move(leaves.vertex);
        std::vector<Index> number = large_vector<Index>(coarse_.size(), no_index);
        const std::vector<Index> nearest = nearest_leaves(leaves.mesh, merged.vertex);
        for (Index v = 0; v < nearest.size(); ++v) number[nearest[v]] = v;
        for_each_index(vertex_.size(), chunks::light, [&](Index v) { vertex_[v] = number[vertex_[v]]; });
        coarse_ = gathered(coarse_, nearest);
    }

    /// Per vertex of the result, the nearest of the leaves' vertices that were merged there.
    std::vector<Index> nearest_leaves(const PolygonMesh& leaves, const std::vector<Index>& vertex) const {
        std::vector<Index> nearest = large_vector<Index>(result_.mesh.vertex_count(), no_index);
        for_each_in_order(vertex.size(), [&](std::size_t i) {
            const auto leaf = static_cast<Index>(i);
            Index& best = nearest[vertex[leaf]];
            const Vec3& place = result_.mesh.positions[vertex[leaf]];
            if (best == no_index
                || (leaves.positions[leaf] - place).sqrnorm() < (leaves.positions[best] - place).sqrnorm())
                best = leaf;
        });
        return nearest;
    }

    void set_beyond(const FarPoints& far) {
        result_.points_beyond = far.beyond;
        result_.unreachable = far.unreachable;
        result_.first_unreachable = far.first_unreachable;
    }

    void settle_for_fine() {
        for (CellLevel& level : tree_.levels)
            if (&level != &tree_.levels.back()) level.whole.assign(level.whole.size(), 0);
        mesh_over_leaves();
        set_beyond(checks_->far_points(result_.mesh));
        result_.intersecting = find_self_intersections(result_.mesh).facet_pairs.size();
    }

    /// Finds the leaf and the cluster of every fine vertex.
    void locate() {
        resize_large(places_, fine_.vertex_count());
        for_chunks(places_.size(), chunks::usual, [&](std::size_t begin, std::size_t end, std::size_t) {
            for (std::size_t v = begin; v < end; ++v) {
                LeafCluster place{tree_.depth(), static_cast<Index>(v), tree_.of_vertex[v]};
                while (place.level > 0) {
                    const auto level = static_cast<std::size_t>(place.level);
                    const Index up = tree_.levels[level].parent[place.cell];
                    if (!tree_.levels[level - 1].whole[up]) break;
                    place.cluster = clusters_[level].parent[place.cluster];
                    place.cell = up;
                    --place.level;
                }
                places_[v] = place;
            }
        });
    }

    /// Builds the mesh over the leaves: a facet remains if it has three different vertices.
    void mesh_over_leaves() {
        locate();
        std::vector<std::vector<Index>> number(clusters_.size());
        for (std::size_t level = 0; level < clusters_.size(); ++level)
            assign_large(number[level], clusters_[level].size(), no_index);
        PolygonMesh& mesh = result_.mesh = PolygonMesh();
        coarse_.clear();
        resize_large(vertex_, fine_.vertex_count());
        for_each_in_order(places_.size(), [&](std::size_t v) {
            const LeafCluster& place = places_[v];
            Index& n = number[static_cast<std::size_t>(place.level)][place.cluster];
            if (n == no_index) {
                n = static_cast<Index>(coarse_.size());
                push_large(coarse_, place);
                push_large(mesh.origin, static_cast<Index>(v));
                push_large(mesh.positions,
                           clusters_[static_cast<std::size_t>(place.level)].positions[place.cluster]);
            }
            vertex_[v] = n;
        });
        std::vector<PolygonMesh> parts(chunk_count(fine_.facet_count(), chunks::quick));
        std::vector<std::vector<Index>> pinched(parts.size());
        for_chunks(fine_.facet_count(), chunks::quick,
                   [&](std::size_t begin, std::size_t end, std::size_t chunk) {
                       std::vector<Index> ring, open;
                       for (std::size_t f = begin; f < end; ++f) {
                           ring.clear();
                           for (Index v : fine_.facet(f)) ring.push_back(vertex_[v]);
                           if (!add_loops(ring, open, parts[chunk]))
                               pinched[chunk].push_back(static_cast<Index>(f));
                       }
                   });
        append_facets(mesh, parts);
        pinched_ = joined(pinched);
    }

    /// Removes doublets; neighbours stand for their fine vertices from then on.
    void drop_doublets() {
        std::vector<Index> stands_for = dissolve_doublets(result_.mesh, staying());
        coarse_ = gathered(coarse_, drop_replaced(result_.mesh, stands_for));
        for_each_index(vertex_.size(), chunks::light, [&](Index v) { vertex_[v] = stands_for[vertex_[v]]; });
    }

    double tolerance() const { return bounds::planes_share * options_.max_error; }

    /// Does this stand for one vertex of the fine mesh, that of its number?
    bool is_own(const LeafCluster& place) const { return place.level == tree_.depth(); }

    /// Per vertex of the result, is it a vertex of the fine mesh?
    std::vector<std::uint8_t> own() const {
        std::vector<std::uint8_t> result = large_vector<std::uint8_t>(coarse_.size());
        for_each_index(result.size(), chunks::light, [&](Index v) { result[v] = is_own(coarse_[v]); });
        return result;
    }

    /// Per vertex of the result, is it to stay although it has only two facets? Empty if none is.
    std::vector<std::uint8_t> staying() const {
        if (stays_.empty()) return {};
        std::vector<std::uint8_t> result = large_vector<std::uint8_t>(coarse_.size());
        for_each_index(result.size(), chunks::light,
                       [&](Index v) { result[v] = is_own(coarse_[v]) ? stays_[coarse_[v].cluster] : 0; });
        return result;
    }

    /// What is wrong where no leaf can be subdivided is so because doublets of the fine mesh were removed:
    /// those stay from now on. Returns how many they are.
    std::size_t keep_doublets(const Findings& found) {
        if (found.is_empty() || kept_ == repeats::twice) return 0;
        std::vector<std::uint8_t> wrong = large_vector<std::uint8_t>(coarse_.size());
        const auto mark_facet = [&](Index f) {
            for (Index v : result_.mesh.facet(f)) wrong[v] = 1;
        };
        for (const auto& pair : found.intersecting)
            for (Index f : pair) mark_facet(f);
        for (Index v : found.far.fine_vertices) wrong[vertex_[v]] = 1;
        for (Index v : found.far.vertices) wrong[v] = 1;
        for (Index f : found.far.facets) mark_facet(f);
        for_each_in_order(found.far_points.points.size(), [&](std::size_t i) {
            const Vec3& point = points_[found.far_points.points[i]];
            if (const Index f = checks_->distances().nearest_facet(point); f != no_index) mark_facet(f);
        });
        const std::vector<Index> kept = indices_where(fine_.vertex_count(), chunks::light, [&](Index v) {
            const LeafCluster& now = coarse_[vertex_[v]];
            return wrong[vertex_[v]] && is_own(places_[v]) && !(is_own(now) && now.cluster == v);
        });
        if (kept.empty()) return 0;
        stays_.resize(fine_.vertex_count(), 0);
        for (Index v : kept) stays_[v] = 1;
        ++kept_;
        return kept.size();
    }

    /// Adds the simple loops of at least three vertices that remain of a facet some of whose vertices
    /// coincide. False if corners coincide that are not next to each other: what the surface has between them
    /// could be a handle. `open` is scratch.
    static bool add_loops(std::vector<Index>& ring, std::vector<Index>& open, PolygonMesh& mesh) {
        ring.erase(std::unique(ring.begin(), ring.end()), ring.end());
        while (ring.size() > 1 && ring.front() == ring.back()) ring.pop_back();
        bool simple = true;
        open.clear();
        for (Index v : ring) {
            const auto seen = std::find(open.begin(), open.end(), v);
            if (seen != open.end()) {
                simple = false;
                if (open.end() - seen >= 3)
                    mesh.add_facet({&*seen, static_cast<std::size_t>(open.end() - seen)});
                open.erase(seen, open.end());
            }
            open.push_back(v);
        }
        if (open.size() >= 3) mesh.add_facet(open);
        return simple;
    }

    std::size_t split_at(const LeafCluster& place) { return tree_.split(place.level, place.cell); }

    std::size_t split_troubled() {
        std::size_t splits = 0;
        std::vector<std::uint8_t> due = large_vector<std::uint8_t>(result_.mesh.vertex_count());
        std::vector<Index> troubled = nonmanifold_vertices(result_.mesh, staying());
        append_large(troubled, lost());
        for_each_in_order(troubled.size(), [&](std::size_t i) { splits += split_at(coarse_[troubled[i]]); });
        for_each_in_order(pinched_.size(), [&](std::size_t i) {
            for (Index v : fine_.facet(pinched_[i])) splits += split_at(places_[v]);
        });
        if (splits > 0 || troubled.empty()) return splits;
        // Leaves of the deepest level cannot be subdivided: subdivide those of their neighbours.
        for (Index v : troubled) due[v] = 1;
        for_each_in_order(result_.mesh.facet_count(), [&](std::size_t f) {
            const auto ring = result_.mesh.facet(f);
            if (std::none_of(ring.begin(), ring.end(), [&](Index v) { return due[v]; })) return;
            for (Index v : ring) splits += split_at(coarse_[v]);
        });
        return splits;
    }

    /// The vertices that have lost all facets: a piece of the surface as small as a leaf.
    std::vector<Index> lost() const {
        std::vector<std::uint8_t> lost = large_vector<std::uint8_t>(coarse_.size());
        for_each_in_order(fine_.corners.size(), [&](std::size_t c) { lost[vertex_[fine_.corners[c]]] = 1; });
        const std::vector<Index>& kept = result_.mesh.corners;
        for_each_in_order(kept.size(), [&](std::size_t c) { lost[kept[c]] = 0; });
        return indices_where(lost.size(), chunks::light, [&](Index v) { return lost[v] != 0; });
    }

    std::size_t split_intersecting(const Findings& found) {
        std::size_t splits = 0;
        for_each_in_order(found.intersecting.size(), [&](std::size_t i) {
            for (Index f : found.intersecting[i]) splits += split_facet(f);
        });
        return splits;
    }

    std::size_t split_distant(const Findings& found) {
        std::size_t splits = 0;
        const auto split_each = [&](const std::vector<Index>& at, const auto& split) {
            for_each_in_order(at.size(), [&](std::size_t i) { splits += split(at[i]); });
        };
        split_each(found.far.fine_vertices, [&](Index v) { return split_at(places_[v]); });
        split_each(found.far.vertices, [&](Index v) { return split_at(coarse_[v]); });
        split_each(found.far.facets, [&](Index f) { return split_facet(f); });
        split_each(found.far_points.points, [&](Index p) { return split_near(points_[p]); });
        return splits;
    }

    std::size_t split_facet(Index f) {
        std::size_t splits = 0;
        for (Index v : result_.mesh.facet(f)) splits += split_at(coarse_[v]);
        return splits;
    }

    /// Subdivides the leaves around a point or, if none can be, those of the facet nearest to it.
    std::size_t split_near(const Vec3& point) {
        const std::size_t splits = split_around(point);
        if (splits > 0) return splits;
        const Index facet = checks_->distances().nearest_facet(point);
        return facet == no_index ? 0 : split_facet(facet);
    }

    /// Subdivides the leaf that holds a point or, if it cannot be, those around it.
    std::size_t split_around(const Vec3& point) {
        const MortonCode code = tree_.code_at(point);
        std::size_t splits = 0;
        for (int level = tree_.depth() - 1; level >= 0; --level)
            if (const Index cell = tree_.find(level, code >> 3 * (tree_.depth() - level)); cell != no_index)
                splits += tree_.split(level, cell);
        for (int level = tree_.depth() - 1; level >= 0 && splits == 0; --level) {
            const VoxelCoord at = morton_decode(code >> 3 * (tree_.depth() - level));
            for (int k = 0; k < 27; ++k) {
                const VoxelCoord n{at[0] + k % 3 - 1, at[1] + k / 3 % 3 - 1, at[2] + k / 9 - 1};
                if (n[0] < 0 || n[1] < 0 || n[2] < 0) continue;
                if (const Index cell = tree_.find(level, morton_encode(n)); cell != no_index)
                    splits += tree_.split(level, cell);
            }
        }
        return splits;
    }

    void count_leaves() {
        result_.leaves_per_level.assign(tree_.levels.size(), 0);
        for (int level = 0; level <= tree_.depth(); ++level)
            for_each_in_order(tree_.levels[static_cast<std::size_t>(level)].codes.size(), [&](std::size_t c) {
                result_.leaves_per_level[static_cast<std::size_t>(level)] +=
                    tree_.is_leaf(level, static_cast<Index>(c));
            });
        assign_large(result_.level, coarse_.size(), 0);
        for_each_index(coarse_.size(), chunks::light,
                       [&](Index v) { result_.level[v] = static_cast<std::uint8_t>(coarse_[v].level); });
    }

    const PolygonMesh& fine_;
    std::span<const Vec3> points_;
    const SimplifyOptions& options_;
    CellTree tree_;
    PlanarPatches patches_;
    std::vector<Quadric> planes_; // per fine vertex
    std::vector<ClusterLevel> clusters_;
    std::vector<LeafCluster> places_; // per fine vertex
    std::vector<Index> vertex_;       // per fine vertex, the vertex of the result
    std::vector<LeafCluster> coarse_; // per vertex of the result
    int kept_ = 0;                    // rounds in which doublets were kept, beyond those of splitting
    std::vector<std::uint8_t> stays_; // per fine vertex, is it to stay though only two facets are left there?
    std::vector<Index> pinched_;      // facets of the fine mesh with opposite corners in one vertex
    RemeshedGroups remeshed_;         // results of the round before
    std::optional<MeshChecks> checks_;
    FaultCounts faults_; // of the last round, including those at leaves that cannot be subdivided
    AdaptiveMesh result_;
};

} // namespace

AdaptiveMesh simplify(const PolygonMesh& fine, std::span<const Vec3> points, double extent, int depth,
                      const SimplifyOptions& options, const FacetCells* cells) {
    if (!(options.max_error > 0 && std::isfinite(options.max_error)))
        throw OptionError("max_error " + std::to_string(options.max_error) + ": must be positive and finite");
    if (options.rounds < 1)
        throw OptionError("rounds " + std::to_string(options.rounds) + ": must be 1 or more");
    return Simplification(fine, points, extent, depth, options, cells).run();
}

} // namespace hsdm
