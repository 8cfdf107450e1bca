#include "hsdm/contour/fans.hh"

#include "hsdm/core/chunks.hh"

#include <algorithm>
#include <cmath>

namespace hsdm {
namespace {

constexpr std::size_t crossings_per_chunk = 4096;
constexpr double side_cosine = 0.77; // a rim's own face is 40 degrees and more from the sides
constexpr double tip_reach = 1.0;    // voxels: from a voxel's centre to the tip of a wedge that it can serve
constexpr double least_width = 0.05; // voxels: a narrower face is none; one vertex serves both its creases

/// The chain of nodes through one node, inside one voxel.
class Chain {
public:
    Chain(const Crossings& crossings, const Links& links) : crossings_(crossings), links_(links) {}

    std::vector<Node> nodes;
    bool closed = false;

    /// The facets run along the chain: each comes to the vertex beside the face where the chain enters it.
    void walk(Node start) {
        nodes.clear();
        closed = false;
        const bool leaving = crossings_.crossings[start / 4].leaving;
        forward(start, leaving ? start % 4 : (start + 3) % 4);
        if (closed) return;
        // Open: the other half, then in order from end to end.
        std::vector<Node> tail = std::move(nodes);
        nodes.clear();
        forward(start, leaving ? (start + 3) % 4 : start % 4);
        std::reverse(nodes.begin(), nodes.end());
        nodes.insert(nodes.end(), tail.begin() + 1, tail.end());
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
            if (node == start) {
                closed = true;
                return;
            }
            nodes.push_back(node);
            k = link.face == j ? (j + 3) % 4 : j; // out by the other of the two faces at this ring position
        }
    }

    const Crossings& crossings_;
    const Links& links_;
};

/// The vertices one chain becomes: ranges of a rotated copy of its nodes.
struct Cut {
    struct Piece {
        std::size_t first, end; // in `nodes`
        std::uint8_t shared;    // 1: its first node is also the last of the piece before, 2: its last alike
    };
    std::vector<Node> nodes;
    std::vector<Piece> pieces;
};

/// Cuts a chain so that no vertex gets both sides of a thin part. Wherever the chain leads from one side to
/// the other there must be a cut: across the link if that goes round a rim, else in the facet of the rim's
/// own face between them.
class ChainCutter {
public:
    ChainCutter(const CornerLattice& lattice, const Crossings& crossings, const Links& links)
        : lattice_(lattice), crossings_(crossings), links_(links) {}

    void cut(const Chain& chain, Cut& result) {
        find_cuts(chain);
        const std::size_t n = chain.nodes.size();
        result.nodes.clear();
        result.pieces.clear();
        // A closed chain starts at its first cut, which is never after the last node: there are two at least.
        const std::size_t begin = chain.closed && !cuts_.empty() ? (cuts_[0] + 1) / 2 : 0;
        for (std::size_t i = 0; i < n; ++i) result.nodes.push_back(chain.nodes[(begin + i) % n]);
        const bool around = chain.closed && !cuts_.empty() && cuts_[0] % 2 == 0;
        if (around) result.nodes.push_back(result.nodes[0]);
        std::size_t first = 0;
        unsigned shared = around;
        for (std::size_t c = chain.closed ? 1 : 0; c < cuts_.size(); ++c) {
            const std::size_t at = cuts_[c] - 2 * begin;
            const unsigned at_node = at % 2 == 0;
            result.pieces.push_back({first, at / 2 + 1, static_cast<std::uint8_t>(shared | at_node << 1)});
            first = (at + 1) / 2;
            shared = at_node;
        }
        result.pieces.push_back(
            {first, result.nodes.size(), static_cast<std::uint8_t>(shared | unsigned{around} << 1)});
    }

private:
    static constexpr std::size_t none = ~std::size_t{0};

    /// Fills cuts_, ascending: 2 i for node i, 2 i + 1 for the link after it.
    void find_cuts(const Chain& chain) {
        cuts_.clear();
        if (!any_opposite(chain)) return;
        const std::size_t n = chain.nodes.size();
        // The shortest way from each node to one of the other side, and where to cut it.
        length_.assign(n, 2 * n);
        place_.assign(n, none);
        for (std::size_t i = 0; i < n; ++i)
            for (std::size_t steps = 1; steps < n && (chain.closed || i + steps < n) && place_[i] == none;
                 ++steps) {
                place_[i] = place_of_cut(chain, i, steps);
                if (place_[i] != none) length_[i] = steps;
            }
        for (std::size_t i = 0; i < n; ++i)
            if (place_[i] != none && !holds_shorter(i, chain)) cuts_.push_back(place_[i]);
        std::sort(cuts_.begin(), cuts_.end());
        cuts_.erase(std::unique(cuts_.begin(), cuts_.end()), cuts_.end());
        if (chain.closed && cuts_.size() < 2) cuts_.clear();
    }

    bool any_opposite(const Chain& chain) const {
        for (std::size_t i = 0; i < chain.nodes.size(); ++i)
            for (std::size_t j = 0; j < i; ++j)
                if (opposed(of(chain.nodes[i]), of(chain.nodes[j]))) return true;
        return false;
    }

    /// Where to cut the way of so many steps from node i; none if it does not lead to the other side.
    std::size_t place_of_cut(const Chain& chain, std::size_t i, std::size_t steps) const {
        const std::size_t n = chain.nodes.size();
        const Node a = chain.nodes[i], b = chain.nodes[(i + steps) % n];
        if (steps == 1) {
            const unsigned exit = of(a).leaving ? a % 4 : (a + 3) % 4;
            return links_.of_crossing[a / 4][exit].rim && !meet_nearby(a, b) ? 2 * i + 1 : none;
        }
        if (!opposed(of(a), of(b)) || meet_nearby(a, b)) return none;
        // The middle one of the nodes between that lie on neither side.
        std::size_t best = none, best_off = n;
        for (std::size_t step = 1; step < steps; ++step) {
            const std::size_t off = 2 * step > steps ? 2 * step - steps : steps - 2 * step;
            const std::size_t node = (i + step) % n;
            if (off < best_off && width(chain.nodes[node], a, b) > least_width)
                best = 2 * node, best_off = off;
        }
        return best;
    }

    /// Do the planes of two nodes meet near the voxel? Then they make the tip of a wedge, not a thin part.
    bool meet_nearby(Node a, Node b) const {
        const unsigned octant = Ring::octant(of(a).edge % 3, a % 4);
        const VoxelCoord corner = lattice_.coord(of(a).edge / 3);
        Vec3 centre;
        for (unsigned k = 0; k < 3; ++k) centre[k] = corner[k] + static_cast<int>(octant >> k & 1u) - 0.5;
        const double k = of(a).normal | (crossing_position(lattice_, of(a), 1) - centre);
        const double l = of(b).normal | (crossing_position(lattice_, of(b), 1) - centre);
        const double cosine = of(a).normal | of(b).normal;
        return k * k + l * l - 2 * cosine * k * l < tip_reach * tip_reach * (1 - cosine * cosine);
    }

    /// How wide a face is between the planes of two sides, in voxels; 0 if it belongs to one of them.
    double width(Node face, Node a, Node b) const {
        double sum = 0;
        for (Node side : {a, b}) {
            const Vec3& n = of(side).normal;
            const double cosine = of(face).normal | n;
            if (cosine > side_cosine) return 0;
            const Vec3 d =
                crossing_position(lattice_, of(side), 1) - crossing_position(lattice_, of(face), 1);
            sum += (n | d) / std::sqrt(std::max(1 - cosine * cosine, 0.01));
        }
        return sum;
    }

    /// Does the way from node i to the other side hold another such way?
    bool holds_shorter(std::size_t i, const Chain& chain) const {
        const std::size_t n = chain.nodes.size();
        for (std::size_t step = 1; step < length_[i] && (chain.closed || i + step < n); ++step)
            if (step + length_[(i + step) % n] <= length_[i]) return true;
        return false;
    }

    const Crossing& of(Node node) const { return crossings_.crossings[node / 4]; }

    const CornerLattice& lattice_;
    const Crossings& crossings_;
    const Links& links_;
    std::vector<std::size_t> cuts_, length_, place_;
};

struct ChunkFans {
    std::vector<Node> nodes;
    std::vector<Index> sizes;
    std::vector<std::uint8_t> shared, open;
    std::vector<std::pair<std::size_t, std::size_t>> caps; // first fan, number of fans
    std::vector<std::size_t> after_cut;
    std::size_t cut = 0;

    void add(const Cut& cut_chain, bool closed) {
        const std::size_t pieces = cut_chain.pieces.size();
        if (pieces > 1) ++cut;
        for (std::size_t i = 1; i < pieces; ++i) after_cut.push_back(sizes.size() + i);
        if (pieces > 2 && closed) caps.emplace_back(sizes.size(), pieces);
        for (const Cut::Piece& piece : cut_chain.pieces) {
            nodes.insert(nodes.end(), cut_chain.nodes.begin() + static_cast<std::ptrdiff_t>(piece.first),
                         cut_chain.nodes.begin() + static_cast<std::ptrdiff_t>(piece.end));
            sizes.push_back(static_cast<Index>(piece.end - piece.first));
            shared.push_back(piece.shared);
            open.push_back(!closed);
        }
    }
};

void append(const ChunkFans& chunk, Fans& fans) {
    const auto base = static_cast<Index>(fans.size());
    fans.cut += chunk.cut;
    fans.nodes.insert(fans.nodes.end(), chunk.nodes.begin(), chunk.nodes.end());
    fans.open.insert(fans.open.end(), chunk.open.begin(), chunk.open.end());
    for (Index size : chunk.sizes) fans.first.push_back(fans.first.back() + size);
    for (std::size_t fan : chunk.after_cut) fans.after_cut.push_back(base + static_cast<Index>(fan));
    for (const auto& [first, count] : chunk.caps) {
        std::vector<Index> cap; // the facets at the cuts run from fan to fan, the cap against them
        for (std::size_t i = count; i-- > 0;) cap.push_back(base + static_cast<Index>(first + i));
        fans.caps.push_back(std::move(cap));
    }
}

/// The sides of every node that belong to a fan: both, but of a node shared with another fan one.
void number_sides(const Crossings& crossings, std::span<const std::uint8_t> shared, Fans& fans) {
    fans.of_side.assign(8 * crossings.crossings.size(), no_index);
    for_chunks(fans.size(), crossings_per_chunk, [&](std::size_t begin, std::size_t end, std::size_t) {
        for (std::size_t v = begin; v < end; ++v) {
            const auto nodes = fans.fan(static_cast<Index>(v));
            for (std::size_t i = 0; i < nodes.size(); ++i) {
                const std::size_t leaves_by = crossings.crossings[nodes[i] / 4].leaving;
                const std::size_t node = nodes[i];
                if (i > 0 || !(shared[v] & 1u))
                    fans.of_side[2 * node + 1 - leaves_by] = static_cast<Index>(v);
                if (i + 1 < nodes.size() || !(shared[v] & 2u))
                    fans.of_side[2 * node + leaves_by] = static_cast<Index>(v);
            }
        }
    });
}

} // namespace

Fans build_fans(const CornerLattice& lattice, const Crossings& crossings, const Links& links) {
    const std::size_t n = crossings.crossings.size();
    std::vector<ChunkFans> chunks(chunk_count(n, crossings_per_chunk));
    for_chunks(n, crossings_per_chunk, [&](std::size_t begin, std::size_t end, std::size_t c) {
        Chain chain(crossings, links);
        ChainCutter cutter(lattice, crossings, links);
        Cut cut;
        for (std::size_t node = 4 * begin; node < 4 * end; ++node) {
            chain.walk(static_cast<Node>(node));
            if (*std::min_element(chain.nodes.begin(), chain.nodes.end()) != node)
                continue; // another node's chain
            cutter.cut(chain, cut);
            chunks[c].add(cut, chain.closed);
        }
    });
    Fans fans;
    std::vector<std::uint8_t> shared;
    for (const ChunkFans& chunk : chunks) {
        append(chunk, fans);
        shared.insert(shared.end(), chunk.shared.begin(), chunk.shared.end());
    }
    number_sides(crossings, shared, fans);
    return fans;
}

} // namespace hsdm
