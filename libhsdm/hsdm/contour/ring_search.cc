#include "hsdm/contour/ring_search.hh"

#include "hsdm/contour/constants.hh"
#include "hsdm/core/interruption.hh"
#include "hsdm/core/large_vector.hh"

#include <algorithm>
#include <array>
#include <numeric>

namespace hsdm {

VertexFans::VertexFans(const PolygonMesh& of, const FacetLinks& its)
    : mesh(of), links(its), side_out_(large_vector<Index>(of.vertex_count(), no_index)) {
    for_each_in_order(mesh.corners.size(), [&](std::size_t c) {
        if (links.accepted[links.facet[c]]) side_out_[mesh.corners[c]] = static_cast<Index>(c);
    });
}

Index VertexFans::side_between(Index from, Index to) const {
    Index found = no_index;
    for_each_side_out(from, [&](Index c) {
        if (end(c) == to) found = c;
    });
    return found;
}

std::vector<Index> VertexFans::sides_of(std::span<const Index> ring) const {
    std::vector<Index> sides;
    for (std::size_t i = 0; i < ring.size(); ++i) {
        const Index side = side_between(ring[i], ring[(i + 1) % ring.size()]);
        if (side == no_index || links.twin[side] == no_index) return {};
        sides.push_back(side);
    }
    for (std::size_t i = 0; i < ring.size(); ++i) // a vertex may have other fans of facets, too
        if (corners_left_of(sides, i).empty() || corners_right_of(sides, i).empty()) return {};
    return sides;
}

std::vector<Index> VertexFans::facets_beside(std::span<const Index> sides) const {
    std::vector<Index> facets;
    for (const Index side : sides)
        for (const Index c : {side, links.twin[side]}) facets.push_back(facet_of(c));
    return facets;
}

/// The corners at the start of a side, of the facets on its left one after the other, until one has `last`
/// before it; none if none has.
std::vector<Index> VertexFans::corners_between(Index side, Index last) const {
    std::vector<Index> corners;
    for (Index c = side; c != no_index;) {
        corners.push_back(c);
        const Index before = previous_side(mesh, facet_of(c), c);
        if (before == last) return corners;
        c = links.twin[before];
        if (c == side) break;
    }
    return {};
}

std::vector<Index> RingSearch::ring_at(Index root) {
    gather(root);
    const Edge* const shortest = left_over();
    return shortest ? ring_of(*shortest) : std::vector<Index>();
}

/// The vertices and facets within reach.
void RingSearch::gather(Index root) {
    const PolygonMesh& mesh = fans_.mesh;
    nodes_.assign(1, {root, 0, 0, 0});
    facets_.clear();
    place_.clear(), facet_place_.clear();
    place_.add(root, 0);
    for (Index i = 0; i < nodes_.size() && nodes_[i].depth < handles::reach; ++i) {
        const Node node = nodes_[i];
        beside_.clear();
        fans_.for_each_side_out(node.vertex, [&](Index c) { beside_.push_back(fans_.end(c)); });
        std::ranges::sort(beside_); // the way round a vertex turns with the normals
        for (const Index w : beside_)
            if (place_.add(w, static_cast<Index>(nodes_.size())))
                nodes_.push_back({w, i, node.depth + 1,
                                  node.length + (mesh.positions[w] - mesh.positions[node.vertex]).norm()});
    }
    for (const Node& node : nodes_)
        fans_.for_each_side_out(node.vertex, [&](Index c) {
            const Index f = fans_.facet_of(c);
            const auto is_known = [&](Index v) { return place_.contains(v); };
            if (!facet_place_.contains(f) && std::ranges::all_of(mesh.facet(f), is_known)) {
                facet_place_.add(f, static_cast<Index>(facets_.size()));
                facets_.push_back(f);
            }
        });
}

/// The edges neither in the tree of shortest ways nor crossed by a tree of facets, which the edges of the
/// longest rings join first: each closes a ring that bounds nothing. Returns the one of the shortest.
const RingSearch::Edge* RingSearch::left_over() {
    const PolygonMesh& mesh = fans_.mesh;
    const FacetLinks& links = fans_.links;
    edges_.clear();
    for (const Index f : facets_)
        for (Index c = mesh.first[f]; c < mesh.first[f + 1]; ++c) {
            const Index twin = links.twin[c];
            if (twin != no_index && twin < c && facet_place_.contains(links.facet[twin])) continue;
            const Index a = place_.at(mesh.corners[c]), b = place_.at(fans_.end(c));
            if (nodes_[a].parent == b || nodes_[b].parent == a) continue;
            const Vec3 way = mesh.positions[nodes_[b].vertex] - mesh.positions[nodes_[a].vertex];
            edges_.push_back({nodes_[a].length + nodes_[b].length + way.norm(), c, a, b});
        }
    std::sort(edges_.begin(), edges_.end(), [](const Edge& e, const Edge& f) {
        return e.length > f.length || (e.length == f.length && e.side < f.side);
    });
    joined_.resize(facets_.size() + 1); // the last: all that lies outside
    std::iota(joined_.begin(), joined_.end(), Index{0});
    const Edge* shortest = nullptr;
    for (const Edge& e : edges_) {
        const Index twin = links.twin[e.side];
        const Index beyond = twin == no_index ? no_index : facet_place_.at(links.facet[twin]);
        const Index x = find(facet_place_.at(links.facet[e.side]));
        const Index y = find(beyond == no_index ? static_cast<Index>(facets_.size()) : beyond);
        if (x == y)
            shortest = &e;
        else
            joined_[x] = y;
    }
    return shortest;
}

Index RingSearch::find(Index i) {
    while (joined_[i] != i) i = joined_[i] = joined_[joined_[i]];
    return i;
}

std::vector<Index> RingSearch::ring_of(const Edge& e) const {
    std::array<std::vector<Index>, 2> way;
    for (const unsigned k : {0u, 1u})
        for (Index i = k == 0 ? e.a : e.b;; i = nodes_[i].parent) {
            way[k].push_back(i);
            if (i == 0) break;
        }
    while (way[0].size() > 1 && way[1].size() > 1 && way[0][way[0].size() - 2] == way[1][way[1].size() - 2])
        way[0].pop_back(), way[1].pop_back();
    way[1].pop_back(); // where they meet
    std::vector<Index> ring;
    for (const Index i : way[0]) ring.push_back(nodes_[i].vertex);
    for (auto i = way[1].rbegin(); i != way[1].rend(); ++i) ring.push_back(nodes_[*i].vertex);
    return ring;
}

} // namespace hsdm
