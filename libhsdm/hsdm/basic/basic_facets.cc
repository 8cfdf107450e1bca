#include "hsdm/basic/basic_facets.hh"

#include "hsdm/basic/false_facets.hh"
#include "hsdm/core/check_option.hh"
#include "hsdm/core/chunks.hh"
#include "hsdm/core/interruption.hh"
#include "hsdm/core/large_vector.hh"
#include "hsdm/mesh/split_polygon.hh"

#include <algorithm>
#include <numbers>
#include <string>

namespace hsdm {
namespace {

/// A facet or a candidate: its half-edges in order, and the same as vertices.
struct Facet {
    std::array<Index, max_loop_edges> half_edges{}, vertices{};
    int size = 0;
    std::span<const Index> edges() const { return {half_edges.data(), static_cast<std::size_t>(size)}; }
    std::span<const Index> corners() const { return {vertices.data(), static_cast<std::size_t>(size)}; }
};

class Propagation {
public:
    Propagation(const Octree& octree, const OctreeLevel& level, const ConnectivityGraph& graph,
                const BasicFacetOptions& options, BasicFacets& result)
        : octree_(octree),
          level_(level),
          graph_(graph),
          options_(options),
          counts_(result.counts),
          mesh_(result.mesh),
          loops_(find_short_loops(graph)),
          facet_of_(large_vector<Index>(graph.half_edge_count(), no_index)) {
        counts_.short_loops = loops_.size();
        reserve_large(mesh_.corners, 4 * graph.vertex_count()); // quads, about as many as vertices
        reserve_large(mesh_.first, graph.vertex_count() + 1);
        index_loops();
        if (options.hit_test) test_hits();
    }

    void run() {
        for (const Facet& seed : seeds()) {
            lay(seed);
            ++counts_.seeds;
            spread(4);
        }
        // For edges still open: first candidates that the hit test rejected, where nothing else is left, so
        // that the facets of narrow grooves come back; then longer and longer loops.
        if (options_.hit_test) {
            enqueue_open_sides();
            assign_large(hit_, hit_.size(), 0);
            spread(4);
        }
        for (int length = 5; length <= options_.max_loop_edges; ++length) {
            enqueue_open_sides();
            spread(length);
        }
        mesh_.positions = copy_of_large(graph_.positions);
    }

private:
    /// Loop i gives two candidates, one per direction: 2 i as listed, 2 i + 1 reversed.
    Facet candidate(Index c) const {
        const auto loop = loops_[c / 2];
        Facet facet;
        facet.size = static_cast<int>(loop.size());
        for (std::size_t i = 0; i < loop.size(); ++i)
            facet.half_edges[i] = c % 2 == 0 ? loop[i] : graph_.twin[loop[loop.size() - 1 - i]];
        set_vertices(facet);
        return facet;
    }
    void set_vertices(Facet& facet) const {
        for (unsigned i = 0; i < static_cast<unsigned>(facet.size); ++i)
            facet.vertices[i] = graph_.start(facet.half_edges[i]);
    }

    /// Per half-edge, the candidates that run along it, ascending.
    void index_loops() {
        assign_large(first_candidate_, graph_.half_edge_count() + 1, 0);
        for_each_in_order(loops_.half_edges.size(), [&](std::size_t k) {
            const Index h = loops_.half_edges[k];
            ++first_candidate_[h + 1];
            ++first_candidate_[graph_.twin[h] + 1];
        });
        counts_to_first(first_candidate_);
        resize_large(candidates_, first_candidate_.back());
        std::vector<Index> next = copy_of_large(first_candidate_);
        for_each_in_order(loops_.size(), [&](std::size_t place) {
            const auto i = static_cast<Index>(place);
            for (Index h : loops_[i]) {
                candidates_[next[h]++] = 2 * i;
                candidates_[next[graph_.twin[h]]++] = 2 * i + 1;
            }
        });
    }

    void test_hits() {
        resize_large(hit_, 2 * loops_.size());
        for_each_index(hit_.size(), chunks::usual, [&](std::size_t c) {
            hit_[c] = hits_neighbor_voxel(level_, graph_, candidate(static_cast<Index>(c)).corners());
        });
        counts_.hit_test = static_cast<std::size_t>(std::count(hit_.begin(), hit_.end(), 1));
    }

    /// Per component of the graph, the facet its orientation is propagated from: at its highest vertex that
    /// has a true candidate, the one that faces most upwards. There, up is outward.
    std::vector<Facet> seeds() const {
        std::vector<Facet> seeds;
        std::vector<Index> stack;
        std::vector<std::uint8_t> seen(graph_.vertex_count(), 0);
        for (Index root = 0; root < graph_.vertex_count(); ++root) {
            if (seen[root]) continue;
            Index top = no_index;
            Facet seed;
            seen[root] = 1;
            stack.push_back(root);
            for (std::size_t looks = 0; !stack.empty(); ++looks) {
                if (looks % chunks::heavy == 0) Interruption::poll();
                const Index v = stack.back();
                stack.pop_back();
                if (top == no_index || higher(v, top)) {
                    const Facet facet = upward_facet(v);
                    if (facet.size > 0) {
                        top = v;
                        seed = facet;
                    }
                }
                for (Index h = graph_.first_edge[v]; h < graph_.first_edge[v + 1]; ++h) {
                    if (seen[graph_.end[h]]) continue;
                    seen[graph_.end[h]] = 1;
                    stack.push_back(graph_.end[h]);
                }
            }
            if (seed.size > 0) seeds.push_back(seed);
        }
        return seeds;
    }

    bool higher(Index a, Index b) const {
        const Vec3 &p = graph_.positions[a], &q = graph_.positions[b];
        return std::tie(p[2], p[1], p[0]) > std::tie(q[2], q[1], q[0]);
    }

    Facet upward_facet(Index v) const {
        Facet best;
        double best_up = 0;
        for (Index h = graph_.first_edge[v]; h < graph_.first_edge[v + 1]; ++h)
            for (Index i = first_candidate_[h]; i < first_candidate_[h + 1]; ++i) {
                const Index c = candidates_[i];
                if (options_.hit_test && hit_[c]) continue;
                const Facet facet = candidate(c);
                const Vec3 area = facet_area(graph_, facet.corners());
                const double up = area[2] / std::max(area.norm(), std::numeric_limits<double>::min());
                if (up <= best_up) continue;
                best = facet;
                best_up = up;
            }
        return best;
    }

    bool free(const Facet& facet) const {
        bool reverse = true;
        for (Index h : facet.edges()) {
            if (facet_of_[h] != no_index) return false;
            const Index other = facet_of_[graph_.twin[h]];
            reverse &= other != no_index && other == facet_of_[graph_.twin[facet.half_edges[0]]];
        }
        return !reverse;
    }

    void lay(const Facet& facet) {
        const auto f = static_cast<Index>(facets_.size());
        push_large(facets_, facet);
        mesh_.add_facet(facet.corners());
        for (Index h : facet.edges()) {
            facet_of_[h] = f;
            if (facet_of_[graph_.twin[h]] == no_index) push_large(queue_, graph_.twin[h]);
        }
    }

    void spread(int max_edges) {
        for (; head_ < queue_.size(); ++head_) {
            if (head_ % chunks::heavy == 0) Interruption::poll();
            const Index h = queue_[head_];
            if (facet_of_[h] != no_index) continue;
            gather(h, max_edges);
            if (!choices_.empty()) lay(choices_[choose(h)]);
        }
        queue_.clear();
        head_ = 0;
    }

    void gather(Index h, int max_edges) {
        choices_.clear();
        for (Index i = first_candidate_[h]; i < first_candidate_[h + 1]; ++i) {
            const Index c = candidates_[i];
            if (options_.hit_test && hit_[c]) continue;
            const Facet facet = candidate(c);
            if (free(facet)) choices_.push_back(facet);
        }
        if (!choices_.empty() || max_edges <= 4) return;
        for (const Loop& loop : minimal_loops_through(graph_, h, max_edges)) {
            if (loop.size <= 4) continue;
            Facet facet{loop.half_edges, {}, loop.size};
            set_vertices(facet);
            if (!free(facet)) continue;
            if (options_.hit_test && hits_neighbor_voxel(level_, graph_, facet.corners())) continue;
            choices_.push_back(facet);
        }
    }

    void enqueue_open_sides() {
        for_each_in_order(graph_.half_edge_count(), [&](std::size_t h) {
            if (facet_of_[h] == no_index && facet_of_[graph_.twin[h]] != no_index)
                push_large(queue_, static_cast<Index>(h));
        });
    }

    std::size_t choose(Index h) {
        if (choices_.size() == 1) return 0;
        if (options_.distance_criterion) {
            std::vector<double> deviation;
            for (const Facet& facet : choices_)
                deviation.push_back(deviation_from_close_points(octree_, level_, graph_, facet.corners()));
            const double least = *std::min_element(deviation.begin(), deviation.end());
            std::size_t kept = 0;
            for (std::size_t i = 0; i < choices_.size(); ++i)
                if (deviation[i] <= distance_slack * least) choices_[kept++] = choices_[i];
            counts_.distance_criterion += choices_.size() - kept;
            choices_.resize(kept);
        }
        if (choices_.size() == 1) return 0;
        std::size_t best = 0;
        if (options_.angle_comparison) {
            double least = 4 * std::numbers::pi;
            const Facet& previous = facets_[facet_of_[graph_.twin[h]]];
            for (std::size_t i = 0; i < choices_.size(); ++i) {
                const double angle = outer_angle(graph_, graph_.start(h), graph_.end[h], previous.corners(),
                                                 choices_[i].corners());
                if (angle >= least) continue;
                least = angle;
                best = i;
            }
            counts_.angle_comparison += choices_.size() - 1;
        }
        return best;
    }

    static constexpr double distance_slack = 1.5;

    const Octree& octree_;
    const OctreeLevel& level_;
    const ConnectivityGraph& graph_;
    const BasicFacetOptions& options_;
    BasicFacets::Counts& counts_;
    PolygonMesh& mesh_;
    LoopList loops_;
    std::vector<Index> first_candidate_, candidates_;
    std::vector<std::uint8_t> hit_; ///< per candidate
    std::vector<Index> facet_of_;   ///< per half-edge
    std::vector<Facet> facets_;
    std::vector<Index> queue_;
    std::size_t head_ = 0;
    std::vector<Facet> choices_;
};

} // namespace

BasicFacets reconstruct_facets(const Octree& octree, const OctreeLevel& level, const ConnectivityGraph& graph,
                               const BasicFacetOptions& options, std::vector<VertexProperty> properties) {
    check_option(options.max_loop_edges >= 3 && options.max_loop_edges <= max_loop_edges, "max_loop_edges",
                 options.max_loop_edges, "lie in [3, " + std::to_string(max_loop_edges) + "]");
    BasicFacets result;
    Propagation(octree, level, graph, options, result).run();
    result.mesh.properties = std::move(properties);
    for_each_index(result.mesh.vertex_count(), chunks::light,
                   [&](Index v) { result.mesh.positions[v] += octree.origin; });
    if (options.max_hole_edges > 0) {
        FillHolesOptions holes;
        holes.max_edges = options.max_hole_edges;
        result.counts.holes = fill_holes(result.mesh, holes);
    }
    result.counts.manifold = make_manifold(result.mesh);
    if (options.split_large) result.counts.split_facets = split_large_facets(result.mesh);
    return result;
}

} // namespace hsdm
