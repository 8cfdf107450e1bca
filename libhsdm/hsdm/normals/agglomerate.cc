#include "hsdm/normals/agglomerate.hh"

#include "hsdm/core/chunks.hh"
#include "hsdm/core/constants.hh"
#include "hsdm/core/interruption.hh"
#include "hsdm/core/large_vector.hh"
#include "hsdm/core/parallel_sort.hh"
#include "hsdm/normals/constants.hh"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>

namespace hsdm {
namespace {

struct Joint {
    Index root, joined;
    std::int8_t sign; ///< sign of the joined tree relative to the other root
};

/// The joins of one round, and the evidence between the roots before it.
struct Round {
    std::vector<SignedEdge> edges;
    std::vector<Joint> joints;
};

/// Union-find that knows every node's sign relative to its root.
class SignedForest {
public:
    explicit SignedForest(std::size_t nodes)
        : parent_(large_vector<Index>(nodes)), sign_(large_vector<std::int8_t>(nodes, 1)) {
        for_each_index(nodes, chunks::light, [&](Index i) { parent_[i] = i; });
    }
    Index find(Index node, int& sign) {
        Index root = node;
        sign = 1;
        while (parent_[root] != root) sign *= sign_[root], root = parent_[root];
        for (int rest = sign; parent_[node] != root && node != root;) {
            const Index next = parent_[node];
            const std::int8_t step = sign_[node];
            parent_[node] = root;
            sign_[node] = static_cast<std::int8_t>(rest);
            rest *= step;
            node = next;
        }
        return root;
    }
    /// Joins the trees of two nodes, the larger root below the smaller; returns equal ends if they are one
    /// tree already.
    Joint join(Index a, Index b, int relation) {
        int sign_a = 1, sign_b = 1;
        Index root_a = find(a, sign_a), root_b = find(b, sign_b);
        if (root_b < root_a) std::swap(root_a, root_b);
        const auto sign = static_cast<std::int8_t>(relation * sign_a * sign_b);
        if (root_a != root_b) parent_[root_b] = root_a, sign_[root_b] = sign;
        return {root_a, root_b, sign};
    }

private:
    std::vector<Index> parent_;
    std::vector<std::int8_t> sign_;
};

/// Sort key: strength of the evidence, then the edge's place; smaller is stronger.
std::uint64_t rank_of(const SignedEdge& e, std::size_t place) {
    const float strength = e.total > 0 ? e.weight / e.total * e.weight : 0;
    return std::uint64_t{~std::bit_cast<std::uint32_t>(strength)} << 32 | place;
}

/// Per node, the edge with its strongest evidence, of those that may_join(); the strongest edges first.
template <class MayJoin>
std::vector<Index> picked_edges(const std::vector<SignedEdge>& edges, std::size_t nodes,
                                const MayJoin& may_join) {
    const std::uint64_t none = rank_of({}, 0);
    std::vector<std::uint64_t> best = large_vector<std::uint64_t>(nodes, none);
    for_each_in_order(edges.size(), [&](std::size_t e) {
        if (!may_join(edges[e])) return;
        const std::uint64_t rank = rank_of(edges[e], e);
        for (Index v : {edges[e].a, edges[e].b}) best[v] = std::min(best[v], rank);
    });
    std::erase(best, none);
    parallel_sort_unique(best);
    return {best.begin(), best.end()};
}

/// The edges between the roots of their ends, their evidence turned by the signs of these; without edges
/// inside one tree.
std::vector<SignedEdge> contracted(const std::vector<SignedEdge>& edges, SignedForest& forest) {
    std::vector<SignedEdge> result;
    reserve_large(result, edges.size());
    for_each_in_order(edges.size(), [&](std::size_t i) {
        SignedEdge e = edges[i];
        int sign_a = 1, sign_b = 1;
        e.a = forest.find(e.a, sign_a);
        e.b = forest.find(e.b, sign_b);
        if (e.a == e.b) return;
        if (e.b < e.a) std::swap(e.a, e.b);
        e.weight *= static_cast<float>(sign_a * sign_b);
        result.push_back(e);
    });
    return result;
}

/// Joins nodes in rounds until no edge that may_join() is left between two trees. `edges`: merged.
template <class MayJoin>
std::vector<Round> join_all(SignedForest& forest, std::vector<SignedEdge> edges, std::size_t nodes,
                            const MayJoin& may_join) {
    std::vector<Round> rounds;
    while (!edges.empty()) {
        std::vector<Joint> joints;
        const std::vector<Index> picked = picked_edges(edges, nodes, may_join);
        for_each_in_order(picked.size(), [&](std::size_t i) {
            const SignedEdge& e = edges[picked[i]];
            const Joint joint = forest.join(e.a, e.b, e.weight < 0 ? -1 : 1);
            if (joint.root != joint.joined) push_large(joints, joint);
        });
        if (joints.empty()) {
            rounds.push_back({std::move(edges), {}});
            break;
        }
        std::vector<SignedEdge> rest = contracted(edges, forest);
        merge_edges(rest, nodes);
        rounds.push_back({std::move(edges), std::move(joints)});
        edges = std::move(rest);
    }
    return rounds;
}

/// Turns nodes that the sum of their evidence contradicts; of two neighbours the more contradicted one first,
/// which may settle the other. Each turn raises the agreement summed over all edges.
class Improvement {
public:
    explicit Improvement(std::vector<std::int8_t>& sign)
        : sign_(sign),
          support_(large_vector<double>(sign.size())),
          mark_(large_vector<Mark>(sign.size(), Mark::stays)) {}

    void run(const std::vector<SignedEdge>& edges) {
        for_each_in_order(edges.size(),
                          [&](std::size_t e) { support_[edges[e].a] = support_[edges[e].b] = 0; });
        for_each_in_order(edges.size(), [&](std::size_t i) {
            const SignedEdge& e = edges[i];
            const double agreement = agreement_of(e);
            support_[e.a] += agreement;
            support_[e.b] += agreement;
        });
        for (int sweep = 0; sweep < enough_rounds && find_contradicted(edges); ++sweep) {
            mark();
            turn();
        }
    }

private:
    enum class Mark : std::int8_t { stays, held, turns };

    double agreement_of(const SignedEdge& e) const {
        return static_cast<double>(e.weight) * sign_[e.a] * sign_[e.b];
    }
    /// Collects the edges of contradicted nodes: no others matter to a turn.
    bool find_contradicted(const std::vector<SignedEdge>& edges) {
        contradicted_.clear();
        for_each_in_order(edges.size(), [&](std::size_t i) {
            if (const SignedEdge& e = edges[i]; support_[e.a] < 0 || support_[e.b] < 0)
                push_large(contradicted_, e);
        });
        return !contradicted_.empty();
    }
    void mark() {
        for_each_contradicted([&](const SignedEdge& e) {
            for (Index v : {e.a, e.b})
                if (support_[v] < 0 && mark_[v] == Mark::stays) mark_[v] = Mark::turns;
            if (support_[e.a] < 0 && support_[e.b] < 0)
                mark_[support_[e.b] < support_[e.a] ? e.a : e.b] = Mark::held;
        });
    }
    void turn() {
        for_each_contradicted([&](const SignedEdge& e) {
            if (mark_[e.a] != Mark::turns && mark_[e.b] != Mark::turns) return;
            const double change = 2 * agreement_of(e);
            support_[e.a] -= change;
            support_[e.b] -= change;
        });
        for_each_contradicted([&](const SignedEdge& e) {
            for (Index v : {e.a, e.b}) {
                if (mark_[v] == Mark::turns) sign_[v] = static_cast<std::int8_t>(-sign_[v]);
                mark_[v] = Mark::stays;
            }
        });
    }
    template <class F>
    void for_each_contradicted(F&& f) const {
        for_each_in_order(contradicted_.size(), [&](std::size_t i) { f(contradicted_[i]); });
    }

    std::vector<std::int8_t>& sign_;
    std::vector<double> support_;
    std::vector<Mark> mark_;
    std::vector<SignedEdge> contradicted_;
};

/// Undoes the rounds, last one first: joined nodes take the signs of their roots, then those that the sum of
/// their evidence contradicts are turned. Returns the edges that the first round began with.
std::vector<SignedEdge> undo(std::vector<Round> rounds, std::vector<std::int8_t>& sign) {
    Improvement improvement(sign);
    std::vector<SignedEdge> first;
    for (; !rounds.empty(); rounds.pop_back()) {
        const std::vector<Joint>& joints = rounds.back().joints;
        for_each_in_order(joints.size(), [&](std::size_t i) {
            const Joint& joint = joints[joints.size() - 1 - i];
            sign[joint.joined] = static_cast<std::int8_t>(sign[joint.root] * joint.sign);
        });
        improvement.run(rounds.back().edges);
        first.swap(rounds.back().edges);
    }
    return first;
}

/// Multiplies the evidence by the signs of its ends: positive where they agree with it.
void turn_evidence(std::vector<SignedEdge>& edges, const std::vector<std::int8_t>& sign) {
    for_each_index(edges.size(), chunks::light, [&](std::size_t i) {
        edges[i].weight *= static_cast<float>(sign[edges[i].a] * sign[edges[i].b]);
    });
}

/// Turns whole regions that the sum of their evidence contradicts, though it bears out each of their nodes:
/// nodes are joined anew, by agreeing evidence alone, so that a region whose border contradicts it grows up
/// to that border. `edges`: the evidence times the signs, merged; so it is after, too. Returns whether any
/// turned.
bool turn_regions(std::vector<SignedEdge>& edges, std::vector<std::int8_t>& sign, Index pole) {
    SignedForest forest(sign.size());
    std::vector<std::int8_t> turned = large_vector<std::int8_t>(sign.size(), 1);
    const auto may_join = [&](const SignedEdge& e) { return e.weight > 0 && e.a != pole && e.b != pole; };
    edges = undo(join_all(forest, std::move(edges), sign.size(), may_join), turned);
    if (std::ranges::none_of(turned, [](std::int8_t t) { return t < 0; })) return false;
    turn_evidence(edges, turned);
    for_each_index(sign.size(), chunks::light,
                   [&](Index v) { sign[v] = static_cast<std::int8_t>(sign[v] * turned[v]); });
    return true;
}

} // namespace

void merge_edges(std::vector<SignedEdge>& edges, std::size_t nodes) {
    std::vector<Index> end = large_vector<Index>(nodes + 1); // of each node's edges, once they are there
    for_each_in_order(edges.size(), [&](std::size_t e) { ++end[edges[e].a + 1]; });
    counts_to_first(end);
    std::vector<SignedEdge> sorted = large_vector<SignedEdge>(edges.size());
    for_each_in_order(edges.size(), [&](std::size_t e) { sorted[end[edges[e].a]++] = edges[e]; });
    for_each_index(nodes, chunks::quick, [&](Index v) {
        std::sort(sorted.begin() + (v == 0 ? 0 : end[v - 1]), sorted.begin() + end[v],
                  [](const SignedEdge& e, const SignedEdge& f) { return e.b < f.b; });
    });
    std::size_t kept = 0;
    double weight = 0, total = 0; // exact, and rounded once, whatever the order
    for_each_in_order(sorted.size(), [&](std::size_t i) {
        const SignedEdge& e = sorted[i];
        if (kept == 0 || sorted[kept - 1].a != e.a || sorted[kept - 1].b != e.b) {
            sorted[kept++] = e;
            weight = e.weight, total = e.total;
        } else {
            sorted[kept - 1].weight = static_cast<float>(weight += e.weight);
            sorted[kept - 1].total = static_cast<float>(total += e.total);
        }
    });
    sorted.resize(kept);
    edges.swap(sorted);
}

Signs agglomerate(std::size_t nodes, const std::vector<SignedEdge>& edges, Index pole) {
    SignedForest forest(nodes);
    Signs result;
    assign_large(result.sign, nodes, 1);
    std::vector<SignedEdge> merged = copy_of_large(edges);
    merge_edges(merged, nodes);
    const auto may_join = [](const SignedEdge&) { return true; };
    merged = undo(join_all(forest, std::move(merged), nodes, may_join), result.sign);
    turn_evidence(merged, result.sign);
    for (int cycle = 0; cycle < enough_rounds && turn_regions(merged, result.sign, pole);) ++cycle;
    double against = 0, all = 0; // before edges between the same nodes were added up
    for_each_in_order(edges.size(), [&](std::size_t i) {
        const SignedEdge& e = edges[i];
        all += std::abs(e.weight);
        against += std::max(-e.weight * static_cast<float>(result.sign[e.a] * result.sign[e.b]), 0.0f);
    });
    result.contradicted = all > 0 ? against / all : 0;
    resize_large(result.component, nodes);
    std::vector<Index> number = large_vector<Index>(nodes, no_index);
    for_each_in_order(nodes, [&](std::size_t v) {
        int sign = 1;
        const Index root = forest.find(static_cast<Index>(v), sign);
        if (number[root] == no_index) number[root] = static_cast<Index>(result.components++);
        result.component[v] = number[root];
    });
    return result;
}

} // namespace hsdm
