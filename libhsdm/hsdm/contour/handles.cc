#include "hsdm/contour/handles.hh"

#include "hsdm/contour/constants.hh"
#include "hsdm/contour/witnesses.hh"
#include "hsdm/core/chunks.hh"
#include "hsdm/core/constants.hh"
#include "hsdm/core/interruption.hh"
#include "hsdm/core/large_vector.hh"
#include "hsdm/mesh/area_vector.hh"
#include "hsdm/mesh/copy_vertex.hh"
#include "hsdm/mesh/split_polygon.hh"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

namespace hsdm {
namespace {

/// Has a vertex's voxel sets, and none whose plane passes the facet and faces the same way?
bool is_contradicted(const PolygonMesh& mesh, Index f, const NormalSets& sets, std::span<const Index> voxel,
                     double voxel_size) {
    const auto facet = mesh.facet(f);
    const Vec3 area = area_vector(mesh, facet);
    const double length = area.norm();
    if (!(length > 0)) return false;
    const Vec3 centre = centroid(mesh, facet);
    bool any = false;
    for (const Index v : facet)
        for (const NormalSet& set : sets.of_voxel(voxel[mesh.origin[v]])) {
            any = true;
            if ((set.normal | area) > angles::facing * length
                && std::abs(set.normal | (centre - set.centroid)) < handles::agreeing_gap * voxel_size)
                return false;
        }
    return any;
}

/// Do two sets of a voxel face apart or each other, more than across, as the sides of a wall or gap do?
bool has_wall(std::span<const NormalSet> sets) {
    for (std::size_t i = 1; i < sets.size(); ++i)
        for (std::size_t j = 0; j < i; ++j)
            if ((sets[i].normal | sets[j].normal) <= -angles::halfway) return true;
    return false;
}

/// Per voxel whether a wall or gap passes it, between several vertices: what joins its two sides there may
/// not be the part's.
std::vector<std::uint8_t> voxels_of_walls(const NormalSets& sets, std::span<const Index> voxel,
                                          const PolygonMesh& mesh) {
    std::vector<std::uint8_t> result(sets.first.size() - 1, 0);
    for (const Index origin : mesh.origin) result[voxel[origin]] += result[voxel[origin]] < 2;
    for_each_index(result.size(), chunks::usual,
                   [&](Index v) { result[v] = result[v] > 1 && has_wall(sets.of_voxel(v)); });
    return result;
}

/// The vertices and facets within a few edges of a vertex, and the rings of edges among them.
class Vicinity {
public:
    Vicinity(const PolygonMesh& mesh, const FacetLinks& links)
        : mesh_(mesh), links_(links), side_out_(large_vector<Index>(mesh.vertex_count(), no_index)) {
        for_each_in_order(mesh.corners.size(), [&](std::size_t c) {
            if (links.accepted[links.facet[c]]) side_out_[mesh.corners[c]] = static_cast<Index>(c);
        });
        assign_large(place_, mesh.vertex_count(), no_index);
        assign_large(facet_place_, mesh.facet_count(), no_index);
    }

    /// The shortest ring round the vertex that does not bound a disc of the facets gathered; empty if there
    /// is none. Twice the reach and one edge is the longest.
    const std::vector<Index>& ring_at(Index root) {
        gather(root);
        ring_.clear();
        const Edge* const shortest = left_over();
        if (shortest) make_ring(*shortest);
        for (const Node& node : nodes_) place_[node.vertex] = no_index;
        for (const Index f : facets_) facet_place_[f] = no_index;
        return ring_;
    }

    /// The side that runs from one vertex to another, or no_index.
    Index side_between(Index from, Index to) const {
        Index found = no_index;
        for_each_side_out(from, [&](Index c) {
            if (end(c) == to) found = c;
        });
        return found;
    }
    Index end(Index c) const { return mesh_.corners[next_side(mesh_, links_.facet[c], c)]; }

private:
    struct Node {
        Index vertex, parent; ///< place of the parent among the nodes
        int depth;
        double length; ///< of the way from the root
    };
    struct Edge {
        double length; ///< of the ring that it closes
        Index side, a, b;
    };

    template <class F>
    void for_each_side_out(Index v, F&& f) const {
        const Index first = side_out_[v];
        if (first == no_index) return;
        Index c = first;
        do { // one way round, as far as it goes
            f(c);
            c = links_.twin[previous_side(mesh_, links_.facet[c], c)];
        } while (c != first && c != no_index);
        if (c == first) return;
        for (c = links_.twin[first]; c != no_index; c = links_.twin[c]) { // the other way from the first
            c = next_side(mesh_, links_.facet[c], c);
            f(c);
        }
    }

    void gather(Index root) {
        nodes_.assign(1, {root, 0, 0, 0});
        facets_.clear();
        place_[root] = 0;
        for (Index i = 0; i < nodes_.size() && nodes_[i].depth < handles::reach; ++i) {
            const Node node = nodes_[i];
            beside_.clear();
            for_each_side_out(node.vertex, [&](Index c) { beside_.push_back(end(c)); });
            std::ranges::sort(beside_); // the way round a vertex turns with the normals
            for (const Index w : beside_) {
                if (place_[w] != no_index) continue;
                place_[w] = static_cast<Index>(nodes_.size());
                nodes_.push_back({w, i, node.depth + 1,
                                  node.length + (mesh_.positions[w] - mesh_.positions[node.vertex]).norm()});
            }
        }
        for (const Node& node : nodes_)
            for_each_side_out(node.vertex, [&](Index c) {
                const Index f = links_.facet[c];
                if (facet_place_[f] != no_index) return;
                for (const Index v : mesh_.facet(f))
                    if (place_[v] == no_index) return;
                facet_place_[f] = static_cast<Index>(facets_.size());
                facets_.push_back(f);
            });
    }

    /// The edges neither in the tree of shortest ways nor crossed by a tree of facets, which the edges of the
    /// longest rings join first: each closes a ring that bounds nothing. Returns the one of the shortest.
    const Edge* left_over() {
        edges_.clear();
        for (const Index f : facets_)
            for (Index c = mesh_.first[f]; c < mesh_.first[f + 1]; ++c) {
                const Index twin = links_.twin[c];
                if (twin != no_index && twin < c && facet_place_[links_.facet[twin]] != no_index) continue;
                const Index a = place_[mesh_.corners[c]], b = place_[end(c)];
                if (nodes_[a].parent == b || nodes_[b].parent == a) continue;
                const Vec3 way = mesh_.positions[nodes_[b].vertex] - mesh_.positions[nodes_[a].vertex];
                edges_.push_back({nodes_[a].length + nodes_[b].length + way.norm(), c, a, b});
            }
        std::sort(edges_.begin(), edges_.end(), [](const Edge& e, const Edge& f) {
            return e.length > f.length || (e.length == f.length && e.side < f.side);
        });
        joined_.resize(facets_.size() + 1); // the last: all that lies outside
        std::iota(joined_.begin(), joined_.end(), Index{0});
        const Edge* shortest = nullptr;
        for (const Edge& e : edges_) {
            const Index twin = links_.twin[e.side];
            const Index beyond = twin == no_index ? no_index : facet_place_[links_.facet[twin]];
            const Index x = find(facet_place_[links_.facet[e.side]]);
            const Index y = find(beyond == no_index ? static_cast<Index>(facets_.size()) : beyond);
            if (x == y)
                shortest = &e;
            else
                joined_[x] = y;
        }
        return shortest;
    }

    Index find(Index i) {
        while (joined_[i] != i) i = joined_[i] = joined_[joined_[i]];
        return i;
    }

    void make_ring(const Edge& e) {
        std::array<std::vector<Index>, 2> way;
        for (const unsigned k : {0u, 1u})
            for (Index i = k == 0 ? e.a : e.b;; i = nodes_[i].parent) {
                way[k].push_back(i);
                if (i == 0) break;
            }
        while (way[0].size() > 1 && way[1].size() > 1
               && way[0][way[0].size() - 2] == way[1][way[1].size() - 2])
            way[0].pop_back(), way[1].pop_back();
        way[1].pop_back(); // where they meet
        for (const Index i : way[0]) ring_.push_back(nodes_[i].vertex);
        for (auto i = way[1].rbegin(); i != way[1].rend(); ++i) ring_.push_back(nodes_[*i].vertex);
    }

    const PolygonMesh& mesh_;
    const FacetLinks& links_;
    std::vector<Index> side_out_;    // per vertex, a side that starts there
    std::vector<Index> place_;       // per vertex, among the nodes
    std::vector<Index> facet_place_; // per facet, among those gathered
    std::vector<Node> nodes_;
    std::vector<Index> facets_;
    std::vector<Edge> edges_;
    std::vector<Index> joined_;
    std::vector<Index> ring_, beside_;
};

/// What was looked at in each block of voxels, by the first voxel of each.
class WorkOfBlocks {
public:
    explicit WorkOfBlocks(const OctreeLevel& level) : codes_(level.codes) {}

    std::size_t& of(Index voxel) {
        constexpr int to_block = 3 * handles::block_levels;
        if (work_.empty()) work_ = large_vector<std::size_t>(codes_.size()); // most meshes have no doubts
        const auto first = std::ranges::lower_bound(codes_, codes_[voxel] >> to_block << to_block);
        return work_[static_cast<std::size_t>(first - codes_.begin())];
    }
    /// Did a block whose first voxel is one of these take more than half of what it may?
    bool is_crowded(const PartVoxels& voxels) const {
        for (Index v = 0; v < work_.size(); ++v)
            if (2 * work_[v] > handles::most_work && voxels.owns(v)) return true;
        return false;
    }

private:
    const std::vector<MortonCode>& codes_;
    std::vector<std::size_t> work_; // facets
};

/// One round: all rings that can be cut without touching each other.
class Round {
public:
    Round(const Octree& octree, const OctreeLevel& level, const NormalSets& sets,
          std::span<const Index> voxel, WorkOfBlocks& done, PolygonMesh& mesh,
          std::optional<FacetLinks>& links)
        : mesh_(mesh),
          known_links_(links),
          sets_(sets),
          voxel_(voxel),
          witnesses_(octree, level, voxel, mesh),
          done_(done) {
        const double voxel_size = level.voxel_size;
        has_wall_ = voxels_of_walls(sets, voxel, mesh);
        assign_large(contradicted_, mesh.facet_count(), 0);
        for_each_index(mesh.facet_count(), chunks::quick, [&](Index f) {
            contradicted_[f] = is_contradicted(mesh, f, sets, voxel, voxel_size);
        });
    }

    std::size_t cut() {
        const std::vector<Index> roots = doubtful_vertices();
        if (roots.empty()) return 0;
        links_ = known_links_ ? std::move(*known_links_) : link_facets(mesh_);
        known_links_.reset();
        Vicinity vicinity(mesh_, links_);
        assign_large(touched_, mesh_.vertex_count(), 0);
        assign_large(seen_, mesh_.facet_count(), 0);
        for_each_in_order(roots.size(), [&](std::size_t i) {
            std::size_t& done = done_.of(voxel_at(roots[i]));
            if (done > handles::most_work) return;
            Interruption::poll();
            work_ = 0;
            look_at(roots[i], vicinity);
            done += work_;
        });
        for (const Ring& ring : rings_) open(ring);
        for (const auto& [v, place] : moves_) mesh_.positions[v] = place;
        if (rings_.empty()) known_links_ = std::move(links_);
        return rings_.size();
    }

private:
    struct Ring {
        std::vector<Index> vertices, sides;
    };

    /// Facets within four edges of a vertex, and the points that are asked about a ring: about so many.
    static constexpr std::size_t work_at_vertex = 64;

    Index facet_of(Index side) const { return links_.facet[side]; }

    /// Does the facet face aside from a set of a voxel that a wall or gap passes?
    bool joins_wall(std::size_t f, Index v) const {
        if (!has_wall_[v]) return false;
        const Vec3 area = area_vector(mesh_, mesh_.facet(f));
        const double most = angles::halfway * area.norm();
        return std::ranges::any_of(sets_.of_voxel(v),
                                   [&](const NormalSet& set) { return std::abs(set.normal | area) < most; });
    }

    /// Those of facets that join the sides of walls and gaps, or that no set speaks for, and where two edges
    /// of a facet meet that are shorter together than a narrow ring is across: where points are as dense as
    /// in the fullest voxel at the facet.
    std::vector<Index> doubtful_vertices() const {
        const auto add = [&](std::size_t begin, std::size_t end, std::vector<Index>& found) {
            for (std::size_t f = begin; f < end; ++f) {
                const auto facet = mesh_.facet(f);
                const std::size_t n = facet.size();
                const auto length = [&](std::size_t i) {
                    return (mesh_.positions[facet[i % n]] - mesh_.positions[facet[(i + 1) % n]]).norm();
                };
                double spacing = std::numeric_limits<double>::infinity();
                for (const Index v : facet) spacing = std::min(spacing, witnesses_.spacing_at(v));
                double before = length(n - 1);
                for (std::size_t i = 0; i < n; ++i) {
                    const double after = length(i);
                    if (contradicted_[f] || joins_wall(f, voxel_at(facet[i])) || before + after < 2 * spacing)
                        found.push_back(facet[i]);
                    before = after;
                }
            }
        };
        std::vector<Index> found = collected<Index>(mesh_.facet_count(), chunks::usual, add);
        sort_unique(found);
        return found;
    }

    Index voxel_at(Index root) const { return voxel_[mesh_.origin[root]]; }

    /// Keeps the ring at a vertex if it is to be cut.
    void look_at(Index root, Vicinity& vicinity) {
        const std::vector<Index> ring = vicinity.ring_at(root);
        const double share = share_contradicted(vicinity, ring);
        if (share < 0) return;
        const bool is_denied = witnesses_.deny(ring), is_narrow = !is_denied && witnesses_.is_narrow(ring);
        const bool is_contradicted = share >= handles::least_contradicted;
        if (!(is_denied || is_narrow || is_contradicted) || bounds())
            return; // to look behind it takes longest
        if (is_denied
            || ((is_narrow || are_contradicted_beside(vicinity, ring)) && !witnesses_.surround(ring)
                && !witnesses_.are_missing_across(ring, facets_beside(vicinity, ring))))
            keep(vicinity, ring);
    }

    /// The facets on both sides of a ring, each as often as it has an edge of it.
    std::vector<Index> facets_beside(const Vicinity& vicinity, const std::vector<Index>& ring) {
        list_sides(vicinity, ring);
        std::vector<Index> facets;
        for (const Index side : sides_)
            for (const Index c : {side, links_.twin[side]}) facets.push_back(facet_of(c));
        return facets;
    }

    /// The ring's sides, on its left; false if one has none on its right, or another ring has come near.
    bool list_sides(const Vicinity& vicinity, const std::vector<Index>& ring) {
        sides_.clear();
        for (std::size_t i = 0; i < ring.size(); ++i) {
            const Index side = vicinity.side_between(ring[i], ring[(i + 1) % ring.size()]);
            if (touched_[ring[i]] || side == no_index || links_.twin[side] == no_index) return false;
            sides_.push_back(side);
        }
        for (std::size_t i = 0; i < ring.size(); ++i) // a vertex may have other fans of facets, too
            if (corners_left_of(sides_, i).empty() || corners_right_of(sides_, i).empty()) return false;
        return true;
    }

    /// Of the facets beside a ring, the share that no points speak for; below 0 if it cannot be cut.
    double share_contradicted(const Vicinity& vicinity, const std::vector<Index>& ring) {
        work_ += work_at_vertex;
        if (ring.size() < 3 || !list_sides(vicinity, ring)) return -1;
        std::size_t count = 0;
        for (const Index side : sides_)
            for (const Index c : {side, links_.twin[side]}) count += !witnesses_.speak_for(facet_of(c));
        return static_cast<double>(count) / static_cast<double>(2 * ring.size());
    }

    /// Is what holds for a ring true of those round the vertices beside it, on average? A hole or rod of the
    /// part is spoken for along most of its length.
    bool are_contradicted_beside(Vicinity& vicinity, const std::vector<Index>& ring) {
        std::vector<Index> beside;
        for (const Index f : facets_beside(vicinity, ring))
            for (const Index v : mesh_.facet(f)) beside.push_back(v);
        sort_unique(beside);
        double sum = 0, count = 0;
        for (const Index v : beside) {
            const std::vector<Index> other = vicinity.ring_at(v);
            const double share = share_contradicted(vicinity, other);
            if (share < 0 || bounds()) continue;
            sum += share;
            ++count;
        }
        return sum >= handles::least_contradicted * count;
    }

    /// Does the ring bound a small part of its own, a knob rather than one of two parts that a bridge joins?
    /// Facets are gathered on both sides by turns, until they meet behind the ring, or one side has no more.
    bool bounds() {
        std::array<std::vector<Index>, 2> pending;
        std::vector<Index> all;
        bool met = false;
        const auto visit = [&](Index f, unsigned side) {
            if (seen_[f] == 0) {
                seen_[f] = static_cast<std::uint8_t>(side + 1);
                pending[side].push_back(f);
                all.push_back(f);
            } else if (seen_[f] != side + 1) {
                met = true;
            }
        };
        for (const Index side : sides_) {
            visit(facet_of(side), 0);
            visit(facet_of(links_.twin[side]), 1);
        }
        std::array<std::size_t, 2> next{0, 0};
        bool ended = false;
        for (unsigned side = 0; !met && all.size() < handles::far; side = 1 - side) {
            ended = next[side] == pending[side].size();
            if (ended) break;
            const Index f = pending[side][next[side]++];
            for (Index c = mesh_.first[f]; c < mesh_.first[f + 1]; ++c) {
                const Index twin = links_.twin[c];
                if (twin == no_index || std::ranges::find(sides_, c) != sides_.end()
                    || std::ranges::find(sides_, twin) != sides_.end())
                    continue;
                visit(facet_of(twin), side);
            }
        }
        for (const Index f : all) seen_[f] = 0;
        work_ += all.size();
        const std::size_t smaller = std::min(pending[0].size(), pending[1].size());
        return ended && smaller < handles::fewest_of_part;
    }

    void keep(const Vicinity& vicinity, const std::vector<Index>& ring) {
        list_sides(vicinity, ring);
        rings_.push_back({ring, sides_});
        for (const Index side : sides_)
            for (const Index c : {side, links_.twin[side]})
                for (const Index v : mesh_.facet(facet_of(c))) touched_[v] = 1;
    }

    /// Gives the facets on the left of a ring vertices of their own, and closes both sides.
    void open(const Ring& cut) {
        const std::vector<Index>&ring = cut.vertices, &sides = cut.sides;
        const std::size_t n = ring.size();
        std::vector<Index> left(n);
        std::vector<std::vector<Index>> corners(n); // on the left
        for (std::size_t i = 0; i < n; ++i) {
            corners[i] = corners_left_of(sides, i);
            draw_back(ring[i], ring, corners[i]);
            left[i] = copy_vertex(mesh_, ring[i]);
            if (!moves_.empty() && moves_.back().first == ring[i]) moves_.back().first = left[i];
            draw_back(ring[i], ring, corners_right_of(sides, i));
        }
        for (std::size_t i = 0; i < n; ++i)
            for (const Index c : corners[i]) mesh_.corners[c] = left[i];
        std::reverse(left.begin(), left.end());
        close(ring);
        close(left);
    }

    /// The corners of a ring's vertex on the left of the ring, one after the other.
    std::vector<Index> corners_left_of(const std::vector<Index>& sides, std::size_t i) const {
        return corners_between(sides[i], sides[(i == 0 ? sides.size() : i) - 1]);
    }
    std::vector<Index> corners_right_of(const std::vector<Index>& sides, std::size_t i) const {
        return corners_between(links_.twin[sides[(i == 0 ? sides.size() : i) - 1]], links_.twin[sides[i]]);
    }

    /// The corners at the start of a side, of the facets on its left one after the other, until one has
    /// `last` before it; none if none has.
    std::vector<Index> corners_between(Index side, Index last) const {
        std::vector<Index> corners;
        for (Index c = side; c != no_index;) {
            corners.push_back(c);
            const Index before = previous_side(mesh_, facet_of(c), c);
            if (before == last) return corners;
            c = links_.twin[before];
            if (c == side) break;
        }
        return {};
    }

    /// A vertex of the ring goes half of the way to its neighbours on one side, so that the sides part.
    void draw_back(Index v, const std::vector<Index>& ring, const std::vector<Index>& corners) {
        Vec3 sum(0, 0, 0);
        double count = 0;
        for (const Index c : corners) {
            const Index w = mesh_.corners[previous_side(mesh_, facet_of(c), c)];
            if (std::ranges::find(ring, w) != ring.end()) continue;
            sum += mesh_.positions[w];
            ++count;
        }
        if (count > 0) moves_.emplace_back(v, 0.5 * (mesh_.positions[v] + sum / count));
    }

    void close(const std::vector<Index>& ring) {
        const EdgeSet edges(mesh_, ring);
        const std::vector<Vec3> none(ring.size(), Vec3(0, 0, 0));
        const Pieces pieces = split_polygon(mesh_, ring, none, edges);
        for (const std::vector<Index>& piece : pieces) mesh_.add_facet(piece);
        if (pieces.empty()) mesh_.add_facet(ring);
    }

    PolygonMesh& mesh_;
    std::optional<FacetLinks>& known_links_;
    const NormalSets& sets_;
    std::span<const Index> voxel_;
    Witnesses witnesses_;
    WorkOfBlocks& done_;
    std::size_t work_ = 0; // facets looked at for a vertex
    FacetLinks links_;
    std::vector<std::uint8_t> has_wall_;     // per voxel: passed by a wall or gap
    std::vector<std::uint8_t> contradicted_; // per facet
    std::vector<std::uint8_t> touched_;      // per vertex, near a ring that is to be cut
    std::vector<std::uint8_t> seen_;         // per facet, the side of the ring it is on, from 1
    std::vector<Index> sides_;               // of a ring, on its left
    std::vector<Ring> rings_;
    std::vector<std::pair<Index, Vec3>> moves_;
};

} // namespace

HandleCounts cut_handles(const Octree& octree, const OctreeLevel& level, const NormalSets& sets,
                         std::span<const Index> voxel, PolygonMesh& mesh, std::optional<FacetLinks>& links,
                         const PartVoxels& part) {
    HandleCounts counts;
    WorkOfBlocks done(level);
    for (int round = 0; round < enough_rounds; ++round) {
        const std::size_t rings = Round(octree, level, sets, voxel, done, mesh, links).cut();
        counts.cut += rings;
        if (rings == 0) break;
    }
    counts.is_crowded = part.is_part() && done.is_crowded(part);
    return counts;
}

} // namespace hsdm
