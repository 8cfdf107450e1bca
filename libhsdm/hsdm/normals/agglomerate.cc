#include "hsdm/normals/agglomerate.hh"

#include "hsdm/chunks.hh"
#include "hsdm/octree/radix_sort.hh"

#include <tbb/parallel_sort.h>

#include <algorithm>
#include <bit>
#include <cmath>

namespace hsdm {
namespace {

/// Union-find that knows every node's sign relative to its root.
class SignedForest {
public:
    explicit SignedForest(std::size_t nodes) : parent_(nodes), sign_(nodes, 1) {
        std::iota(parent_.begin(), parent_.end(), Index{0});
    }
    Index find(Index node, int& sign) {
        Index root = node;
        sign = 1;
        while (parent_[root] != root) sign *= sign_[root], root = parent_[root];
        for (int rest = sign; parent_[node] != root && node != root;) {
            const Index next = parent_[node];
            const int step = sign_[node];
            parent_[node] = root;
            sign_[node] = static_cast<std::int8_t>(rest);
            rest *= step;
            node = next;
        }
        return root;
    }
    /// Joins the trees of two nodes, the larger root below the smaller; false if they are one already.
    bool join(Index a, Index b, int relation) {
        int sign_a = 1, sign_b = 1;
        Index root_a = find(a, sign_a), root_b = find(b, sign_b);
        if (root_a == root_b) return false;
        if (root_b < root_a) std::swap(root_a, root_b);
        parent_[root_b] = root_a;
        sign_[root_b] = static_cast<std::int8_t>(relation * sign_a * sign_b);
        return true;
    }

private:
    std::vector<Index> parent_;
    std::vector<std::int8_t> sign_;
};

double strength(const SignedEdge& e) {
    return e.total > 0 ? static_cast<double>(e.weight) * e.weight / e.total : 0;
}

std::uint64_t key_of(const SignedEdge& e, int bits) {
    return std::uint64_t{e.a} << bits | e.b;
}

/// Sorts by both ends and adds up edges between the same nodes.
void sort_and_merge(std::vector<SignedEdge>& edges, std::size_t nodes) {
    const int bits = static_cast<int>(std::bit_width(nodes));
    std::vector<CodeIndex> keys(edges.size());
    for (std::size_t e = 0; e < edges.size(); ++e) keys[e] = {key_of(edges[e], bits), static_cast<Index>(e)};
    radix_sort(keys, 2 * bits);
    std::vector<SignedEdge> merged;
    merged.reserve(edges.size());
    for (const CodeIndex& key : keys) {
        const SignedEdge& e = edges[key.index];
        if (merged.empty() || merged.back().a != e.a || merged.back().b != e.b) {
            merged.push_back(e);
        } else {
            merged.back().weight += e.weight;
            merged.back().total += e.total;
        }
    }
    edges.swap(merged);
}

/// The edge that each node has the strongest evidence by, strongest first; ties by place.
std::vector<Index> picked_edges(const std::vector<SignedEdge>& edges, std::size_t nodes) {
    std::vector<Index> best(nodes, no_index);
    const auto stronger = [&](Index e, Index than) {
        if (than == no_index) return true;
        const double s = strength(edges[e]), t = strength(edges[than]);
        return s != t ? s > t : e < than;
    };
    for (Index e = 0; e < edges.size(); ++e) {
        if (strength(edges[e]) <= 0) continue;
        if (stronger(e, best[edges[e].a])) best[edges[e].a] = e;
        if (stronger(e, best[edges[e].b])) best[edges[e].b] = e;
    }
    std::erase(best, no_index);
    tbb::parallel_sort(best.begin(), best.end(), stronger);
    best.erase(std::unique(best.begin(), best.end()), best.end());
    return best;
}

/// Names the edges' ends by their roots, turns the evidence with them and drops what became internal.
void contract(std::vector<SignedEdge>& edges, SignedForest& forest) {
    std::size_t kept = 0;
    for (SignedEdge e : edges) {
        int sign_a = 1, sign_b = 1;
        e.a = forest.find(e.a, sign_a);
        e.b = forest.find(e.b, sign_b);
        if (e.a == e.b) continue;
        if (e.b < e.a) std::swap(e.a, e.b);
        e.weight *= static_cast<float>(sign_a * sign_b);
        edges[kept++] = e;
    }
    edges.resize(kept);
}

} // namespace

Signs agglomerate(std::size_t nodes, std::vector<SignedEdge> edges) {
    SignedForest forest(nodes);
    while (!edges.empty()) {
        sort_and_merge(edges, nodes);
        bool joined_any = false;
        for (Index e : picked_edges(edges, nodes))
            joined_any |= forest.join(edges[e].a, edges[e].b, edges[e].weight < 0 ? -1 : 1);
        if (!joined_any) break;
        contract(edges, forest);
    }
    Signs result;
    result.sign.resize(nodes);
    result.component.resize(nodes);
    std::vector<Index> number(nodes, no_index);
    for (Index v = 0; v < nodes; ++v) {
        int sign = 1;
        const Index root = forest.find(v, sign);
        if (number[root] == no_index) number[root] = static_cast<Index>(result.components++);
        result.component[v] = number[root];
        result.sign[v] = static_cast<std::int8_t>(sign);
    }
    return result;
}

} // namespace hsdm
