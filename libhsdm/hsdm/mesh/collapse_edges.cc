#include "hsdm/mesh/collapse_edges.hh"

#include "hsdm/core/chunks.hh"
#include "hsdm/core/constants.hh"
#include "hsdm/mesh/area_vector.hh"
#include "hsdm/mesh/constants.hh"

#include <algorithm>
#include <iterator>

namespace hsdm {
namespace {

using RingVertices = std::vector<Index>;

/// The position of a vertex in a ring, or the ring's size.
std::size_t find_in(const RingVertices& ring, Index v) {
    return static_cast<std::size_t>(std::find(ring.begin(), ring.end(), v) - ring.begin());
}

/// The ring rotated to start at position `at`.
RingVertices starting_at(const RingVertices& ring, std::size_t at) {
    RingVertices turned = ring;
    std::rotate(turned.begin(), turned.begin() + static_cast<std::ptrdiff_t>(at), turned.end());
    return turned;
}

bool is_simple(RingVertices ring) {
    std::sort(ring.begin(), ring.end());
    return std::adjacent_find(ring.begin(), ring.end()) == ring.end();
}

/// What is asked of the facets round an edge.
enum class Asked : std::uint8_t {
    shape, ///< that they keep an area, their sides and their direction, and vertices a third facet
    facets ///< that vertices keep a second one
};

/// The facets around the edges to collapse, as rings that can be changed.
class Patch {
public:
    Patch(PolygonMesh& mesh, std::span<const EdgeCollapse> edges, Asked asked)
        : mesh_(mesh),
          asked_(asked),
          slot_(mesh.vertex_count(), no_index),
          facet_count_(mesh.vertex_count(), 0) {
        for (const EdgeCollapse& edge : edges)
            for (Index v : {edge.from, edge.to})
                if (slot_[v] == no_index) {
                    slot_[v] = static_cast<Index>(rings_at_.size());
                    rings_at_.emplace_back();
                    stand_in_.push_back(v);
                }
        for (Index v : mesh.corners) ++facet_count_[v];
        for (std::size_t f = 0; f < mesh.facet_count(); ++f) {
            const auto facet = mesh.facet(f);
            if (std::any_of(facet.begin(), facet.end(), [&](Index v) { return slot_[v] != no_index; })) {
                facets_.push_back(static_cast<Index>(f));
                rings_.emplace_back(facet.begin(), facet.end());
                list(static_cast<Index>(rings_.size() - 1));
            }
        }
    }

    bool collapse(const EdgeCollapse& edge) {
        const Index to = stand_in(edge.to);
        if (!meets_link_condition(edge.from, to)) return false;
        gather(edge.from, to);
        const Vec3 placed = mesh_.positions[to];
        if (to == edge.to) mesh_.positions[to] = edge.position;
        if ((asked_ == Asked::facets || (unite_flat(to) && keeps_facets(to))) && keeps_counts(edge.from)) {
            commit();
            stand_in_[slot_[edge.from]] = to;
            return true;
        }
        mesh_.positions[to] = placed;
        return false;
    }

    /// Writes the rings back to the mesh, without those of fewer than three vertices.
    void write() const {
        PolygonMesh kept;
        std::size_t next = 0;
        for (std::size_t f = 0; f < mesh_.facet_count(); ++f) {
            if (next == facets_.size() || facets_[next] != f)
                kept.add_facet(mesh_.facet(f));
            else if (rings_[next++].size() > 2)
                kept.add_facet(rings_[next - 1]);
        }
        mesh_.corners = std::move(kept.corners);
        mesh_.first = std::move(kept.first);
    }

private:
    struct Change {
        Index ring;
        RingVertices after;
        Vec3 area_before;
        double least_area; // smallest area allowed, over the longest side squared
    };

    /// The vertex that has replaced v, v itself at first.
    Index stand_in(Index v) const {
        while (stand_in_[slot_[v]] != v) v = stand_in_[slot_[v]];
        return v;
    }

    const std::vector<Index>& rings_at(Index v) const { return rings_at_[slot_[v]]; }

    /// Enters a ring at those of its vertices that are ends of edges to collapse.
    void list(Index ring) {
        for (Index v : rings_[ring])
            if (slot_[v] != no_index) rings_at_[slot_[v]].push_back(ring);
    }

    void unlist(Index ring) {
        for (Index v : rings_[ring])
            if (slot_[v] != no_index) std::erase(rings_at_[slot_[v]], ring);
    }

    /// The vertices before and after v round its facets, sorted, each once.
    std::vector<Index> neighbours_of(Index v) const {
        std::vector<Index> neighbours;
        for (Index r : rings_at(v)) {
            const RingVertices& ring = rings_[r];
            const std::size_t at = find_in(ring, v);
            neighbours.push_back(ring[(at + 1) % ring.size()]);
            neighbours.push_back(ring[(at + ring.size() - 1) % ring.size()]);
        }
        sort_unique(neighbours);
        return neighbours;
    }

    bool meets_link_condition(Index from, Index to) const {
        if (from == to) return false;
        std::size_t both = 0, triangles = 0;
        for (Index r : rings_at(from)) {
            const RingVertices& ring = rings_[r];
            const std::size_t at = find_in(ring, from), other = find_in(ring, to);
            if (other == ring.size()) continue;
            const std::size_t apart = at < other ? other - at : at - other;
            const bool is_diagonal = apart == 2 && ring.size() == 4; // cut there it is two triangles
            if (!is_diagonal && apart != 1 && apart + 1 != ring.size()) return false;
            both += is_diagonal ? 2 : 1;
            triangles += is_diagonal ? 2 : ring.size() == 3;
        }
        if (both != 2) return false;
        const std::vector<Index> one = neighbours_of(from), other = neighbours_of(to);
        // A border vertex has one neighbour more than facets; merging two would pinch the surface.
        if (one.size() > rings_at(from).size() && other.size() > rings_at(to).size()) return false;
        std::vector<Index> common;
        std::set_intersection(one.begin(), one.end(), other.begin(), other.end(), std::back_inserter(common));
        return common.size() == triangles;
    }

    /// Lists the changes to the rings around an edge that its collapse makes.
    void gather(Index from, Index to) {
        std::vector<Index> around = rings_at(from);
        around.insert(around.end(), rings_at(to).begin(), rings_at(to).end());
        sort_unique(around);
        changes_.clear();
        for (Index r : around) {
            RingVertices after = rings_[r];
            const std::size_t at = find_in(after, from), other = find_in(after, to);
            if (at == after.size() || other == after.size())
                std::replace(after.begin(), after.end(), from, to);
            else if (at + 2 == other || other + 2 == at)
                after.clear(); // a triangle, or a quad along its diagonal
            else
                after.erase(after.begin() + static_cast<std::ptrdiff_t>(at));
            // half of what it had: what was thin already does not refuse
            changes_.push_back({r, std::move(after), area_vector(mesh_, rings_[r]),
                                std::min(edge_collapses::least_area, 0.5 * relative_area(rings_[r]))});
        }
    }

    double squared_length(Index a, Index b) const {
        return (mesh_.positions[b] - mesh_.positions[a]).sqrnorm();
    }

    /// Where the longest side of a ring begins.
    std::size_t longest_side(const RingVertices& ring) const {
        std::size_t longest = 0;
        double length = 0;
        for (std::size_t i = 0; i < ring.size(); ++i) {
            const double side = squared_length(ring[i], ring[(i + 1) % ring.size()]);
            if (side > length) length = side, longest = i;
        }
        return longest;
    }

    double relative_area(const RingVertices& ring) const {
        const std::size_t i = longest_side(ring);
        const double longest = squared_length(ring[i], ring[(i + 1) % ring.size()]);
        return longest > 0 ? area_vector(mesh_, ring).norm() / longest : 0;
    }

    bool has_area(const Change& change) const { return relative_area(change.after) > change.least_area; }

    /// Unites each ring without area with the one across its longest side, which must end at `centre`; false
    /// if that is impossible.
    bool unite_flat(Index centre) {
        for (Change& flat : changes_) {
            if (flat.after.size() < 3 || has_area(flat)) continue;
            const std::size_t side = longest_side(flat.after);
            const Index a = flat.after[side], b = flat.after[(side + 1) % flat.after.size()];
            if (a != centre && b != centre) return false;
            Change* beyond = across(flat, a, b);
            if (!beyond) return false;
            // From b along the flat ring to a, then along the other from after a to before b.
            RingVertices united = starting_at(flat.after, find_in(flat.after, b));
            const RingVertices other = starting_at(beyond->after, find_in(beyond->after, a));
            united.insert(united.end(), other.begin() + 1, other.end() - 1);
            if (united.size() > edge_collapses::most_corners || !is_simple(united)) return false;
            beyond->after = std::move(united);
            flat.after.clear();
        }
        return true;
    }

    /// The change of the other ring that has the side from b to a.
    Change* across(const Change& flat, Index a, Index b) {
        for (Change& change : changes_) {
            const std::size_t at = find_in(change.after, b);
            if (&change != &flat && change.after.size() > 2 && at < change.after.size()
                && change.after[(at + 1) % change.after.size()] == a)
                return &change;
        }
        return nullptr;
    }

    bool keeps_facets(Index centre) const {
        return std::all_of(changes_.begin(), changes_.end(), [&](const Change& change) {
            if (change.after.size() < 3) return true;
            return has_area(change) && has_sides(change.after, centre)
                   && (area_vector(mesh_, change.after) | change.area_before) >= 0;
        });
    }

    /// Are the sides of a ring at `centre` long enough?
    bool has_sides(const RingVertices& ring, Index centre) const {
        const std::size_t at = find_in(ring, centre), i = longest_side(ring);
        const double least = edge_collapses::least_area * edge_collapses::least_area
                             * squared_length(ring[i], ring[(i + 1) % ring.size()]);
        return squared_length(centre, ring[(at + 1) % ring.size()]) > least
               && squared_length(centre, ring[(at + ring.size() - 1) % ring.size()]) > least;
    }

    /// Updates the facet count of each vertex; false, and no update, if a vertex other than `gone` would lose
    /// its third facet, or its second.
    bool keeps_counts(Index gone) {
        const int least = asked_ == Asked::shape ? 3 : 2;
        const auto has_enough = [&](Index v) { return v == gone || facet_count_[v] >= least; };
        std::vector<Index> with_enough;
        for (const Change& change : changes_)
            std::copy_if(rings_[change.ring].begin(), rings_[change.ring].end(),
                         std::back_inserter(with_enough), has_enough);
        count_changes(-1, 1);
        if (std::all_of(with_enough.begin(), with_enough.end(), has_enough)) return true;
        count_changes(1, -1);
        return false;
    }

    void count_changes(int before, int after) {
        for (const Change& change : changes_) {
            for (Index v : rings_[change.ring]) facet_count_[v] += before;
            if (change.after.size() < 3) continue;
            for (Index v : change.after) facet_count_[v] += after;
        }
    }

    void commit() {
        for (Change& change : changes_) {
            unlist(change.ring);
            rings_[change.ring] = change.after.size() < 3 ? RingVertices() : std::move(change.after);
            list(change.ring);
        }
    }

    PolygonMesh& mesh_;
    Asked asked_;
    std::vector<Index> slot_; // per vertex that is an end of an edge to collapse, its place in
    std::vector<std::vector<Index>> rings_at_; // per such vertex, the rings around it
    std::vector<Index> stand_in_;              // per such vertex, the vertex that replaces it
    std::vector<Index> facets_;                // the facet of each ring, ascending
    std::vector<RingVertices> rings_;
    std::vector<int> facet_count_; // per vertex
    std::vector<Change> changes_;  // of the current collapse
};

std::vector<std::uint8_t> collapse(PolygonMesh& mesh, std::span<const EdgeCollapse> edges, Asked asked) {
    std::vector<std::uint8_t> collapsed(edges.size(), 0);
    if (edges.empty()) return collapsed;
    Patch patch(mesh, edges, asked);
    bool changed = true, any = false;
    for (int round = 0; changed && round < enough_rounds; ++round) {
        changed = false;
        for (std::size_t i = 0; i < edges.size(); ++i)
            if (!collapsed[i] && patch.collapse(edges[i])) collapsed[i] = 1, changed = any = true;
    }
    if (any) patch.write();
    return collapsed;
}

} // namespace

std::vector<std::uint8_t> collapse_edges(PolygonMesh& mesh, std::span<const EdgeCollapse> edges) {
    return collapse(mesh, edges, Asked::shape);
}

std::vector<std::uint8_t> collapse_empty_edges(PolygonMesh& mesh, std::span<const EdgeCollapse> edges) {
    return collapse(mesh, edges, Asked::facets);
}

} // namespace hsdm
