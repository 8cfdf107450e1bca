#include "hsdm/contour/minimum_cut.hh"

#include "hsdm/core/chunks.hh"
#include "hsdm/core/disjoint_sets.hh"
#include "hsdm/core/groups.hh"

#include <boost/graph/adjacency_list.hpp>
#include <boost/graph/boykov_kolmogorov_max_flow.hpp>

#include <cassert>
#include <cmath>
#include <span>

namespace hsdm {
namespace {

constexpr std::size_t few = 16; // components of a task: most have a few dozen things, some have thousands

/// Whole numbers, in which flows do not depend on the order of their sums.
std::int64_t whole(double cost) {
    return std::llround(cost * (1 << 20));
}

/// Flow from label 0 to label 1 through a few things: a thing has label 0 if some flow could still reach it.
class FlowGraph {
public:
    explicit FlowGraph(std::size_t things) : graph_(things + 2), things_(things) {}

    void add(Index thing, double cost_of_one) {
        const std::int64_t cost = whole(cost_of_one);
        if (cost > 0) link(source(), thing, cost);
        if (cost < 0) link(thing, sink(), -cost);
    }
    void add(Index zero, Index one, double cost) { link(zero, one, whole(cost)); }

    /// Calls set(thing, label) for each.
    template <class Set>
    void cut(Set&& set) {
        boost::boykov_kolmogorov_max_flow(graph_, source(), sink());
        const auto colour = boost::get(boost::vertex_color, graph_);
        for (std::size_t i = 0; i < things_; ++i) set(i, colour[i] == colour[source()] ? 0 : 1);
    }

private:
    using Traits = boost::adjacency_list_traits<boost::vecS, boost::vecS, boost::directedS>;
    using Vertex = boost::property<
        boost::vertex_color_t, boost::default_color_type,
        boost::property<boost::vertex_distance_t, std::int64_t,
                        boost::property<boost::vertex_predecessor_t, Traits::edge_descriptor>>>;
    using Edge =
        boost::property<boost::edge_capacity_t, std::int64_t,
                        boost::property<boost::edge_residual_capacity_t, std::int64_t,
                                        boost::property<boost::edge_reverse_t, Traits::edge_descriptor>>>;
    using Graph = boost::adjacency_list<boost::vecS, boost::vecS, boost::directedS, Vertex, Edge>;

    std::size_t source() const { return things_; }
    std::size_t sink() const { return things_ + 1; }

    void link(std::size_t from, std::size_t to, std::int64_t capacity) {
        const auto forth = boost::add_edge(from, to, graph_).first;
        const auto back = boost::add_edge(to, from, graph_).first;
        boost::put(boost::edge_capacity, graph_, forth, capacity);
        boost::put(boost::edge_capacity, graph_, back, 0);
        boost::put(boost::edge_reverse, graph_, forth, back);
        boost::put(boost::edge_reverse, graph_, back, forth);
    }

    Graph graph_;
    std::size_t things_;
};

/// Per thing the number of its component; returns how many there are.
std::size_t find_components(const LabelCosts& costs, std::vector<Index>& component) {
    DisjointSets joined(costs.size());
    for (const LabelCosts::Pair& pair : costs.pairs()) joined.join(pair.zero, pair.one);
    component.resize(costs.size());
    std::size_t count = 0;
    for (Index i = 0; i < component.size(); ++i) {
        const Index least = joined.find(i);
        component[i] = least == i ? static_cast<Index>(count++) : component[least];
    }
    return count;
}

} // namespace

void LabelCosts::add(Index first, Index second, const Table& cost) {
    of_one_[first] += cost[1][0] - cost[0][0];
    of_one_[second] += cost[1][1] - cost[1][0];
    const double different = cost[0][1] + cost[1][0] - cost[0][0] - cost[1][1];
    assert(different > -1e-9);
    if (different > 0) pairs_.push_back({first, second, different});
}

std::vector<std::uint8_t> cheapest_labels(const LabelCosts& costs) {
    std::vector<Index> component;
    const std::size_t count = find_components(costs, component);
    const Groups things(component, count);
    std::vector<Index> of_pairs;
    for (const LabelCosts::Pair& pair : costs.pairs()) of_pairs.push_back(component[pair.zero]);
    const Groups pairs(of_pairs, count);
    std::vector<Index> place(costs.size()); // among the things of its component
    std::vector<std::uint8_t> labels(costs.size());
    for_chunks(count, few, [&](std::size_t begin, std::size_t end, std::size_t) {
        for (std::size_t c = begin; c < end; ++c) {
            const std::span<const Index> mine = things.of(c);
            FlowGraph graph(mine.size());
            for (std::size_t i = 0; i < mine.size(); ++i) {
                place[mine[i]] = static_cast<Index>(i);
                graph.add(static_cast<Index>(i), costs.of_one()[mine[i]]);
            }
            for (const Index p : pairs.of(c)) {
                const LabelCosts::Pair& pair = costs.pairs()[p];
                graph.add(place[pair.zero], place[pair.one], pair.cost);
            }
            graph.cut([&](std::size_t i, int label) { labels[mine[i]] = static_cast<std::uint8_t>(label); });
        }
    });
    return labels;
}

} // namespace hsdm
