#include "hsdm/sheets/fans.hh"

#include "hsdm/chunks.hh"

#include <algorithm>

namespace hsdm {
namespace {

constexpr std::size_t crossings_per_chunk = 4096;

/// The chain of nodes through one node, inside one voxel.
class Chain {
public:
    explicit Chain(const Links& links) : links_(links) {}

    std::vector<Node> nodes;
    std::vector<bool> rim_after; // is the join from node i to node i + 1 (closed: cyclic) a rim?
    bool closed = false;

    void walk(Node start) {
        nodes.clear();
        rim_after.clear();
        closed = false;
        forward(start, start % 4);
        if (closed) return;
        // Open: the other half, then in order from end to end.
        Chain& back = *this;
        std::vector<Node> tail = std::move(nodes);
        std::vector<bool> tail_rims = std::move(rim_after);
        nodes.clear();
        rim_after.clear();
        back.forward(start, (start + 3) % 4);
        std::reverse(nodes.begin(), nodes.end());
        std::reverse(rim_after.begin(), rim_after.end());
        nodes.insert(nodes.end(), tail.begin() + 1, tail.end());
        rim_after.insert(rim_after.end(), tail_rims.begin(), tail_rims.end());
    }

    std::size_t rims() const {
        return static_cast<std::size_t>(std::count(rim_after.begin(), rim_after.end(), true));
    }

private:
    /// Leaves `start` through face k of its ring and goes on until the chain closes or ends.
    void forward(Node start, unsigned k) {
        Node node = start;
        nodes.push_back(node);
        for (;;) {
            const Link& link = links_.of_crossing[node / 4][k];
            if (link.crossing == no_index) return;
            const unsigned j = Ring::across(node % 4, k, link.face);
            node = 4 * link.crossing + j;
            rim_after.push_back(link.rim);
            if (node == start) {
                closed = true;
                return;
            }
            nodes.push_back(node);
            k = link.face == j ? (j + 3) % 4 : j; // out by the other of the two faces at this ring position
        }
    }

    const Links& links_;
};

/// The vertices one chain becomes: ranges of a rotated copy of its nodes.
struct Cut {
    std::vector<Node> nodes;
    std::vector<std::size_t> first{0};
};

Cut cut_at_rims(const Chain& chain) {
    Cut cut;
    const std::size_t n = chain.nodes.size();
    const std::size_t rims = chain.rims();
    const bool cuts = chain.closed ? rims >= 2 : rims >= 1;
    std::size_t begin = 0; // a closed chain starts just after a rim
    if (cuts && chain.closed)
        while (!chain.rim_after[(begin + n - 1) % n]) ++begin;
    for (std::size_t i = 0; i < n; ++i) {
        const std::size_t at = (begin + i) % n;
        cut.nodes.push_back(chain.nodes[at]);
        const bool last = i + 1 == n;
        if (last || (cuts && chain.rim_after[at])) cut.first.push_back(cut.nodes.size());
    }
    return cut;
}

struct ChunkFans {
    std::vector<Node> nodes;
    std::vector<Index> sizes;
    std::vector<std::pair<std::size_t, std::size_t>> caps; // first fan, number of fans
    std::vector<std::size_t> after_cut;
    std::size_t cut = 0;
};

} // namespace

Fans build_fans(const Crossings& crossings, const Links& links) {
    Fans fans;
    const std::size_t n = crossings.crossings.size();
    std::vector<ChunkFans> chunks(chunk_count(n, crossings_per_chunk));
    for_chunks(n, crossings_per_chunk, [&](std::size_t begin, std::size_t end, std::size_t c) {
        ChunkFans& chunk = chunks[c];
        Chain chain(links);
        for (std::size_t node = 4 * begin; node < 4 * end; ++node) {
            chain.walk(static_cast<Node>(node));
            if (*std::min_element(chain.nodes.begin(), chain.nodes.end()) != node)
                continue; // another node's chain
            const Cut cut = cut_at_rims(chain);
            const std::size_t pieces = cut.first.size() - 1;
            if (pieces > 1) ++chunk.cut;
            for (std::size_t i = 1; i < pieces; ++i) chunk.after_cut.push_back(chunk.sizes.size() + i);
            if (pieces > 2 && chain.closed) chunk.caps.emplace_back(chunk.sizes.size(), pieces);
            chunk.nodes.insert(chunk.nodes.end(), cut.nodes.begin(), cut.nodes.end());
            for (std::size_t i = 0; i < pieces; ++i)
                chunk.sizes.push_back(static_cast<Index>(cut.first[i + 1] - cut.first[i]));
        }
    });
    fans.of_node.resize(4 * n);
    for (const ChunkFans& chunk : chunks) {
        const auto base = static_cast<Index>(fans.size());
        fans.cut += chunk.cut;
        fans.nodes.insert(fans.nodes.end(), chunk.nodes.begin(), chunk.nodes.end());
        for (Index size : chunk.sizes) fans.first.push_back(fans.first.back() + size);
        for (std::size_t fan : chunk.after_cut) fans.after_cut.push_back(base + static_cast<Index>(fan));
        for (const auto& [first, count] : chunk.caps) {
            std::vector<Index> cap;
            for (std::size_t i = 0; i < count; ++i) cap.push_back(base + static_cast<Index>(first + i));
            fans.caps.push_back(std::move(cap));
        }
    }
    for_chunks(fans.size(), crossings_per_chunk, [&](std::size_t begin, std::size_t end, std::size_t) {
        for (std::size_t v = begin; v < end; ++v)
            for (Node node : fans.fan(static_cast<Index>(v))) fans.of_node[node] = static_cast<Index>(v);
    });
    return fans;
}

} // namespace hsdm
