#include "hsdm/adaptive/coarsen.hh"

#include "hsdm/adaptive/clusters.hh"
#include "hsdm/adaptive/dissolve.hh"
#include "hsdm/adaptive/tidy.hh"
#include "hsdm/adaptive/trouble.hh"
#include "hsdm/chunks.hh"
#include "hsdm/errors.hh"
#include "hsdm/facets/straight_corners.hh"
#include "hsdm/octree/morton_index.hh"
#include "hsdm/quality/distance.hh"
#include "hsdm/quality/self_intersections.hh"

#include <tbb/parallel_sort.h>

#include <algorithm>
#include <optional>

namespace hsdm {
namespace {

constexpr std::size_t vertices_per_chunk = 2048;
constexpr std::size_t far_per_chunk = 64; // distances of places that are far take long
constexpr std::size_t fewest_samples = 10000, most_samples = 100000;
constexpr double planes_share =
    0.35; // of the error: what planes of a leaf may be missed by, root mean square

constexpr double reflex = -0.01; // sine of a corner; straight ones do no harm, and a cut costs a facet

constexpr std::uint64_t no_key = 0;

/// A bijection that spreads every bit over all.
std::uint64_t mixed(std::uint64_t x) {
    x = (x ^ x >> 30) * 0xbf58476d1ce4e5b9ull;
    x = (x ^ x >> 27) * 0x94d049bb133111ebull;
    return x ^ x >> 31;
}

/// A cluster: a vertex of the result.
struct Place {
    int level = 0;
    Index cluster = no_index;
    Index cell = no_index;
};

class Coarsening {
public:
    Coarsening(const PolygonMesh& fine, std::span<const Vec3> points, double extent, int depth,
               const CoarsenOptions& options)
        : fine_(fine),
          points_(points),
          options_(options),
          tree_(build_cell_tree(fine.positions, extent, depth)) {
        clusters_ = build_clusters(fine, tree_, planes_share * options.max_error);
    }

    AdaptiveMesh run() {
        int round = 0;
        while (round < options_.rounds && split_what_is_wrong() > 0) ++round;
        if (round == options_.rounds || result_.points_beyond > result_.unreachable) settle_for_fine();
        count_leaves();
        const std::size_t samples = std::clamp(2 * result_.mesh.facet_count(), fewest_samples, most_samples);
        if (to_fine_) result_.to_fine = (*to_fine_)(sample_surface(result_.mesh, samples));
        result_.vertex = std::move(vertex_);
        return std::move(result_);
    }

private:
    /// One mesh over the leaves as they are; returns how many leaves have to be smaller.
    std::size_t split_what_is_wrong() {
        result_.balance_splits += balance(tree_);
        collapse();
        drop_doublets();
        const std::size_t troubled = split_troubled();
        result_.topology_splits += troubled;
        if (troubled > 0) return troubled; // all else needs a 2-manifold
        tidy();
        const std::size_t crossing = split_intersecting(), distant = split_distant(crossing == 0);
        result_.intersection_splits += crossing;
        result_.error_splits += distant;
        return crossing + distant;
    }

    void settle_for_fine() {
        for (CellLevel& level : tree_.levels)
            if (&level != &tree_.levels.back()) level.whole.assign(level.whole.size(), 0);
        collapse();
        split_distant(true);
    }

    /// The leaf and the cluster of every fine vertex.
    void locate() {
        places_.resize(fine_.vertex_count());
        for_chunks(places_.size(), vertices_per_chunk, [&](std::size_t begin, std::size_t end, std::size_t) {
            for (std::size_t v = begin; v < end; ++v) {
                Place place{tree_.depth(), static_cast<Index>(v), tree_.of_vertex[v]};
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

    /// The mesh over the leaves: a facet stays while it has three different vertices.
    void collapse() {
        locate();
        std::vector<std::vector<Index>> number(clusters_.size());
        for (std::size_t level = 0; level < clusters_.size(); ++level)
            number[level].assign(clusters_[level].size(), no_index);
        PolygonMesh& mesh = result_.mesh = PolygonMesh();
        coarse_.clear();
        pinched_.clear();
        vertex_.resize(fine_.vertex_count());
        for (std::size_t v = 0; v < places_.size(); ++v) {
            const Place& place = places_[v];
            Index& n = number[static_cast<std::size_t>(place.level)][place.cluster];
            if (n == no_index) {
                n = static_cast<Index>(coarse_.size());
                coarse_.push_back(place);
                mesh.positions.push_back(
                    clusters_[static_cast<std::size_t>(place.level)].positions[place.cluster]);
            }
            vertex_[v] = n;
        }
        std::vector<Index> ring;
        for (std::size_t f = 0; f < fine_.facet_count(); ++f) {
            ring.clear();
            for (Index v : fine_.facet(f)) ring.push_back(vertex_[v]);
            if (!add_loops(ring, mesh)) pinched_.push_back(static_cast<Index>(f));
        }
    }

    /// The vertices taken out are renumbered away; their neighbours take over the fine vertices.
    void drop_doublets() {
        PolygonMesh& mesh = result_.mesh;
        const std::vector<Index> stands_for = dissolve_doublets(mesh);
        std::vector<Index> number(stands_for.size(), no_index);
        Index kept = 0;
        for (Index v = 0; v < number.size(); ++v) {
            if (stands_for[v] != v) continue;
            mesh.positions[kept] = mesh.positions[v];
            coarse_[kept] = coarse_[v];
            number[v] = kept++;
        }
        mesh.positions.resize(kept);
        coarse_.resize(kept);
        for (Index& v : mesh.corners) v = number[v];
        for (Index& v : vertex_) v = number[stands_for[v]];
    }

    void tidy() {
        if (!to_fine_) to_fine_.emplace(fine_);
        tidy_facets(result_.mesh, *to_fine_, planes_share * options_.max_error,
                    [&](Index v) { return coarse_[v].level == tree_.depth(); });
        cut_straight_corners(result_.mesh, reflex);
    }

    /// The simple loops of three vertices and more that are left of a facet whose vertices coincide in part.
    /// False if corners coincide that are not next to each other: what the surface has between them could be
    /// a handle.
    static bool add_loops(std::vector<Index>& ring, PolygonMesh& mesh) {
        ring.erase(std::unique(ring.begin(), ring.end()), ring.end());
        while (ring.size() > 1 && ring.front() == ring.back()) ring.pop_back();
        bool simple = true;
        std::vector<Index> open;
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

    std::size_t split_at(const Place& place) { return tree_.split(place.level, place.cell); }

    std::size_t split_troubled() {
        std::size_t splits = 0;
        std::vector<std::uint8_t> due(result_.mesh.vertex_count(), 0);
        std::vector<Index> troubled = troubled_vertices(result_.mesh);
        add_lost(troubled);
        for (Index v : troubled) splits += split_at(coarse_[v]);
        for (Index f : pinched_)
            for (Index v : fine_.facet(f)) splits += split_at(places_[v]);
        if (splits > 0 || troubled.empty()) return splits;
        // Vertices of the deepest level alone cannot be helped: their neighbours can.
        for (Index v : troubled) due[v] = 1;
        for (std::size_t f = 0; f < result_.mesh.facet_count(); ++f) {
            const auto ring = result_.mesh.facet(f);
            if (std::none_of(ring.begin(), ring.end(), [&](Index v) { return due[v]; })) continue;
            for (Index v : ring) splits += split_at(coarse_[v]);
        }
        return splits;
    }

    /// Vertices whose facets have all gone: a piece of the surface as small as a leaf.
    void add_lost(std::vector<Index>& troubled) const {
        std::vector<std::uint8_t> lost(coarse_.size(), 0);
        for (Index v : fine_.corners) lost[vertex_[v]] = 1;
        for (Index v : result_.mesh.corners) lost[v] = 0;
        for (Index v = 0; v < lost.size(); ++v)
            if (lost[v]) troubled.push_back(v);
    }

    std::size_t split_intersecting() {
        const SelfIntersections found = find_self_intersections(result_.mesh);
        std::size_t splits = 0;
        for (const auto& pair : found.facet_pairs)
            for (Index f : pair)
                for (Index v : result_.mesh.facet(f)) splits += split_at(coarse_[v]);
        return splits;
    }

    /// The points last, as there are most of them.
    std::size_t split_distant(bool with_points) {
        const MeshDistance to_result(result_.mesh);
        std::size_t splits = 0;
        find_keys();
        for (Index v : far_from(to_result, fine_.positions, near_vertex_)) splits += split_at(places_[v]);
        splits += split_far_vertices() + split_far_facets();
        return splits > 0 || !with_points ? splits : split_for_points(to_result);
    }

    /// A facet is the same in two meshes if its corners are the same clusters in the same order: their key,
    /// as clusters stay where they are.
    void find_keys() {
        const PolygonMesh& mesh = result_.mesh;
        keys_.resize(mesh.facet_count());
        for_chunks(keys_.size(), vertices_per_chunk, [&](std::size_t begin, std::size_t end, std::size_t) {
            const auto id = [&](Index v) {
                return static_cast<std::uint64_t>(coarse_[v].level) << 32 | coarse_[v].cluster;
            };
            for (std::size_t f = begin; f < end; ++f) {
                const auto ring = mesh.facet(f);
                std::size_t least = 0;
                for (std::size_t i = 1; i < ring.size(); ++i)
                    if (id(ring[i]) < id(ring[least])) least = i;
                std::uint64_t key = ring.size();
                for (std::size_t i = 0; i < ring.size(); ++i)
                    key = mixed(key ^ id(ring[(least + i) % ring.size()]));
                keys_[f] = key;
            }
        });
        index_keys(keys_, present_);
    }

    static void index_keys(std::vector<std::uint64_t> keys, MortonIndex& index) {
        tbb::parallel_sort(keys.begin(), keys.end());
        keys.erase(std::unique(keys.begin(), keys.end()), keys.end());
        if (!keys.empty() && keys.front() == no_key) keys.erase(keys.begin());
        index.build(keys);
    }

    /// Which of some places are farther from the result than the bound. A place that was near a facet still
    /// is if the facet has stayed: `near` keeps its key.
    std::vector<Index> far_from(const MeshDistance& to_result, std::span<const Vec3> places,
                                std::vector<std::uint64_t>& near) const {
        near.resize(places.size(), no_key);
        std::vector<std::vector<Index>> parts(chunk_count(places.size(), vertices_per_chunk));
        for_chunks(places.size(), vertices_per_chunk, [&](std::size_t begin, std::size_t end, std::size_t c) {
            for (std::size_t i = begin; i < end; ++i)
                if (present_.find(near[i]) == no_index) parts[c].push_back(static_cast<Index>(i));
        });
        const std::vector<Index> doubtful = joined(parts);
        std::vector<Vec3> at(doubtful.size());
        for (std::size_t i = 0; i < at.size(); ++i) at[i] = places[doubtful[i]];
        const std::vector<Index> facets = to_result.facets_within(at, options_.max_error);
        std::vector<Index> far;
        for (std::size_t i = 0; i < at.size(); ++i) {
            near[doubtful[i]] = facets[i] == no_index ? no_key : keys_[facets[i]];
            if (facets[i] == no_index) far.push_back(doubtful[i]);
        }
        return far;
    }

    /// Vertices of the result, but for the fine mesh's own, against the fine mesh.
    std::size_t split_far_vertices() {
        std::vector<Index> moved;
        std::vector<Vec3> at;
        for (Index v = 0; v < coarse_.size(); ++v) {
            if (coarse_[v].level == tree_.depth()) continue;
            moved.push_back(v);
            at.push_back(result_.mesh.positions[v]);
        }
        if (!to_fine_) to_fine_.emplace(fine_);
        const std::vector<Index> near = to_fine_->facets_within(at, options_.max_error);
        std::size_t splits = 0;
        for (std::size_t i = 0; i < moved.size(); ++i)
            if (near[i] == no_index) splits += split_at(coarse_[moved[i]]);
        return splits;
    }

    /// Vertices at a border: each vertex of a whole fan is as often behind the one in the middle as before
    /// it.
    static std::vector<std::uint8_t> border_vertices(const PolygonMesh& mesh) {
        std::vector<std::int64_t> balance(mesh.vertex_count(), 0);
        for (std::size_t f = 0; f < mesh.facet_count(); ++f) {
            const auto ring = mesh.facet(f);
            Index before = ring.back();
            for (std::size_t i = 0; i < ring.size(); before = ring[i++])
                balance[ring[i]] += std::int64_t{ring[(i + 1) % ring.size()]} - std::int64_t{before};
        }
        std::vector<std::uint8_t> border(balance.size());
        std::transform(balance.begin(), balance.end(), border.begin(), [](std::int64_t b) { return b != 0; });
        return border;
    }

    /// Middles of facets, of their sides, and between middle and corners, against the fine mesh.
    std::size_t split_far_facets() {
        const PolygonMesh& mesh = result_.mesh;
        std::vector<Vec3> middles;
        std::vector<Index> facet;
        const std::vector<std::uint8_t> border = border_vertices(mesh);
        for (std::size_t f = 0; f < mesh.facet_count(); ++f) {
            if (passed_.find(keys_[f]) != no_index) continue;
            const auto ring = mesh.facet(f);
            if (std::all_of(ring.begin(), ring.end(),
                            [&](Index v) { return coarse_[v].level == tree_.depth(); }))
                continue;
            Vec3 sum(0, 0, 0);
            for (Index v : ring) sum += mesh.positions[v];
            const Vec3 centre = sum / static_cast<double>(ring.size());
            for (std::size_t i = 0; i < ring.size(); ++i) {
                const Index next = ring[(i + 1) % ring.size()];
                const Vec3 &a = mesh.positions[ring[i]], &b = mesh.positions[next];
                middles.push_back(0.5 * (a + centre));
                facet.push_back(static_cast<Index>(f));
                if (ring[i] > next && !(border[ring[i]] && border[next])) continue; // the other facet has it
                middles.push_back(0.5 * (a + b));
                facet.push_back(static_cast<Index>(f));
            }
            middles.push_back(centre);
            facet.push_back(static_cast<Index>(f));
        }
        const std::vector<Index> near = to_fine_->facets_within(middles, options_.max_error);
        std::size_t splits = 0;
        std::vector<std::uint64_t> passed = keys_;
        for (std::size_t i = 0; i < near.size(); ++i) {
            if (near[i] != no_index) continue;
            for (Index v : mesh.facet(facet[i])) splits += split_at(coarse_[v]);
            passed[facet[i]] = no_key;
        }
        index_keys(passed, passed_);
        return splits;
    }

    std::size_t split_for_points(const MeshDistance& to_result) {
        const std::vector<Index> far = far_from(to_result, points_, near_point_);
        measure_to_fine(far);
        std::vector<Index> missed; // by the fine mesh already
        std::size_t splits = 0;
        double farthest = 0;
        result_.points_beyond = far.size();
        for (Index p : far) {
            if (const double off = off_fine_[p]; off > options_.max_error) {
                missed.push_back(p);
                farthest = std::max(farthest, off);
            } else {
                splits += split_near(p, to_result);
            }
        }
        result_.unreachable = missed.size();
        // The largest distance of all is the fine mesh's, if that is beyond the bound.
        std::vector<double> off(missed.size());
        for_chunks(missed.size(), far_per_chunk, [&](std::size_t begin, std::size_t end, std::size_t) {
            for (std::size_t i = begin; i < end; ++i) off[i] = to_result(points_[missed[i]]);
        });
        for (std::size_t i = 0; i < missed.size(); ++i)
            if (off[i] > farthest) splits += split_near(missed[i], to_result);
        return splits;
    }

    /// Of points that were not measured in a round before.
    void measure_to_fine(const std::vector<Index>& far) {
        if (!far.empty()) off_fine_.resize(points_.size(), -1);
        for_chunks(far.size(), far_per_chunk, [&](std::size_t begin, std::size_t end, std::size_t) {
            for (std::size_t i = begin; i < end; ++i)
                if (double& off = off_fine_[far[i]]; off < 0) off = (*to_fine_)(points_[far[i]]);
        });
    }

    /// The leaves around a point; where there are none to subdivide, those of the facet nearest to it.
    std::size_t split_near(Index p, const MeshDistance& to_result) {
        std::size_t splits = split_around(points_[p]);
        if (splits > 0) return splits;
        const Index facet = to_result.nearest_facet(points_[p]);
        if (facet != no_index)
            for (Index v : result_.mesh.facet(facet)) splits += split_at(coarse_[v]);
        return splits;
    }

    /// The leaf that holds a point, or else those around it.
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
            for (Index c = 0; c < tree_.levels[static_cast<std::size_t>(level)].codes.size(); ++c)
                result_.leaves_per_level[static_cast<std::size_t>(level)] += tree_.is_leaf(level, c);
        result_.level.clear();
        for (const Place& place : coarse_) result_.level.push_back(static_cast<std::uint8_t>(place.level));
    }

    const PolygonMesh& fine_;
    std::span<const Vec3> points_;
    const CoarsenOptions& options_;
    CellTree tree_;
    std::vector<ClusterLevel> clusters_;
    std::vector<Place> places_;  // per fine vertex
    std::vector<Index> vertex_;  // per fine vertex, the vertex of the result
    std::vector<Place> coarse_;  // per vertex of the result
    std::vector<Index> pinched_; // facets of the fine mesh with opposite corners in one vertex
    std::optional<MeshDistance> to_fine_;
    std::vector<std::uint64_t> keys_; // per facet of the result
    MortonIndex present_, passed_;    // keys of its facets; of those found near the fine mesh
    std::vector<std::uint64_t> near_vertex_, near_point_; // of a facet that a fine vertex, a point is near to
    std::vector<double> off_fine_;                        // per point, from the fine mesh; -1: not known
    AdaptiveMesh result_;
};

} // namespace

AdaptiveMesh coarsen(const PolygonMesh& fine, std::span<const Vec3> points, double extent, int depth,
                     const CoarsenOptions& options) {
    if (!(options.max_error > 0))
        throw OptionError("max_error " + std::to_string(options.max_error) + ": must be positive");
    if (options.rounds < 1)
        throw OptionError("rounds " + std::to_string(options.rounds) + ": must be 1 or more");
    return Coarsening(fine, points, extent, depth, options).run();
}

} // namespace hsdm
