#include "hsdm/mesh/facet_links.hh"

#include "hsdm/core/chunks.hh"
#include "hsdm/core/interruption.hh"
#include "hsdm/core/large_vector.hh"

#include <algorithm>
#include <atomic>
#include <span>

namespace hsdm {
namespace {

bool is_proper(std::span<const Index> facet, std::size_t vertex_count) {
    if (facet.size() < 3) return false;
    if (std::any_of(facet.begin(), facet.end(), [&](Index v) { return v >= vertex_count; })) return false;
    if (facet.size() <= 8) {
        for (std::size_t i = 1; i < facet.size(); ++i)
            if (std::find(facet.begin(), facet.begin() + static_cast<std::ptrdiff_t>(i), facet[i])
                != facet.begin() + static_cast<std::ptrdiff_t>(i))
                return false;
        return true;
    }
    std::vector<Index> sorted(facet.begin(), facet.end());
    std::sort(sorted.begin(), sorted.end());
    return std::adjacent_find(sorted.begin(), sorted.end()) == sorted.end();
}

/// The sides out of each vertex, sorted by (end vertex, side): key = end << 32 | side.
class Linker {
public:
    explicit Linker(const PolygonMesh& facets) : facets_(facets) {}

    FacetLinks run() {
        find_proper_facets();
        list_sides_out();
        if (is_contested()) accept_in_order();
        find_twins();
        find_fan_starts();
        release(out_); // twins say all the rest
        find_fans();
        return std::move(links_);
    }

private:
    static Index side_of(std::uint64_t key) { return static_cast<Index>(key); }
    static Index end_of(std::uint64_t key) { return static_cast<Index>(key >> 32); }
    Index start(Index side) const { return facets_.corners[side]; }
    Index end(Index side) const { return facets_.corners[next_side(facets_, links_.facet[side], side)]; }
    std::span<const std::uint64_t> sides_out(Index v) const {
        return {out_.data() + first_out_[v], out_.data() + first_out_[v + 1]};
    }
    /// Slot of the first side from u to v, or of where it would be.
    std::size_t slot(Index u, Index v) const {
        const auto sides = sides_out(u);
        const auto key = static_cast<std::uint64_t>(v) << 32;
        return first_out_[u]
               + static_cast<std::size_t>(std::lower_bound(sides.begin(), sides.end(), key) - sides.begin());
    }

    void find_proper_facets() {
        resize_unwritten(links_.accepted, facets_.facet_count());
        resize_unwritten(links_.facet, facets_.corners.size());
        for_each_index(facets_.facet_count(), chunks::quick, [&](Index f) {
            links_.accepted[f] = static_cast<char>(is_proper(facets_.facet(f), facets_.vertex_count()));
            for (Index c = facets_.first[f]; c < facets_.first[f + 1]; ++c) links_.facet[c] = f;
        });
        count_rejected();
    }

    void count_rejected() {
        links_.rejected =
            static_cast<std::size_t>(std::count(links_.accepted.begin(), links_.accepted.end(), char{0}));
    }

    void list_sides_out() {
        assign_large(first_out_, facets_.vertex_count() + 1, 0);
        for_each_accepted_side([&](Index c) {
            std::atomic_ref(first_out_[start(c) + 1]).fetch_add(1, std::memory_order_relaxed);
        });
        counts_to_first(first_out_);
        resize_unwritten(out_, first_out_.back());
        std::vector<Index> fill(first_out_.begin(), first_out_.end() - 1);
        for_each_accepted_side([&](Index c) { // in any order: sorted below
            const Index place = std::atomic_ref(fill[start(c)]).fetch_add(1, std::memory_order_relaxed);
            out_[place] = static_cast<std::uint64_t>(end(c)) << 32 | c;
        });
        for_each_index(facets_.vertex_count(), chunks::quick, [&](Index v) {
            std::sort(out_.begin() + first_out_[v], out_.begin() + first_out_[v + 1]);
        });
    }

    template <class Body>
    void for_each_accepted_side(const Body& body) const {
        for_each_index(facets_.facet_count(), chunks::quick, [&](Index f) {
            if (!links_.accepted[f]) return;
            for (Index c = facets_.first[f]; c < facets_.first[f + 1]; ++c) body(c);
        });
    }

    /// Whether two facets run along an edge the same way.
    bool is_contested() const {
        std::atomic<bool> contested = false;
        for_each_index(facets_.vertex_count(), chunks::quick, [&](Index v) {
            const auto sides = sides_out(v);
            for (std::size_t i = 1; i < sides.size(); ++i)
                if (end_of(sides[i]) == end_of(sides[i - 1])) contested = true;
        });
        return contested;
    }

    /// The earlier facet keeps the edge; the later one is rejected whole and frees its other edges.
    void accept_in_order() {
        std::vector<char> taken(out_.size(), 0);
        for_each_in_order(facets_.facet_count(), [&](std::size_t f) {
            if (!links_.accepted[f]) return;
            bool free = true;
            for (Index c = facets_.first[f]; c < facets_.first[f + 1]; ++c)
                free = free && !taken[slot(start(c), end(c))];
            links_.accepted[f] = static_cast<char>(free);
            if (!free) return;
            for (Index c = facets_.first[f]; c < facets_.first[f + 1]; ++c) taken[slot(start(c), end(c))] = 1;
        });
        count_rejected();
        list_sides_out();
    }

    void find_twins() {
        assign_large(links_.twin, facets_.corners.size(), no_index);
        for_each_index(facets_.facet_count(), chunks::quick, [&](Index f) {
            if (!links_.accepted[f]) return;
            for (Index c = facets_.first[f]; c < facets_.first[f + 1]; ++c) {
                const Index u = start(c), v = end(c);
                const std::size_t s = slot(v, u);
                if (s < first_out_[v + 1] && end_of(out_[s]) == u) links_.twin[c] = side_of(out_[s]);
            }
        });
    }

    /// The next side out of the same vertex around the fan, or no_index at its open end.
    Index rotate(Index c) const { return links_.twin[previous_side(facets_, links_.facet[c], c)]; }

    /// Per vertex of facets, where to start rotating so that the whole fan of the side is visited.
    void find_fan_starts() {
        links_.source = indices_where(facets_.vertex_count(), chunks::light,
                                      [&](Index v) { return !sides_out(v).empty(); });
        resize_unwritten(links_.side_out, links_.source.size());
        for_each_index(links_.source.size(), chunks::quick, [&](Index i) {
            const auto sides = sides_out(links_.source[i]);
            const auto open = std::find_if(sides.begin(), sides.end(), [&](std::uint64_t key) {
                return links_.twin[side_of(key)] == no_index;
            });
            links_.side_out[i] = side_of(open == sides.end() ? sides.front() : *open);
        });
    }

    /// Assigns the fan that starts with side c to the vertex; returns the number of its sides.
    std::size_t assign_fan(Index c, Index vertex) {
        const Index begin = c;
        Index last = c;
        std::size_t count = 0;
        do {
            links_.vertex[c] = vertex;
            last = c;
            c = rotate(c);
            ++count;
        } while (c != no_index && c != begin);
        links_.side_out[vertex] = begin;
        links_.open_in[vertex] = c == no_index ? previous_side(facets_, links_.facet[last], last) : no_index;
        return count;
    }

    void find_fans() {
        const std::size_t count = links_.source.size();
        assign_large(links_.vertex, facets_.corners.size(), no_index);
        resize_unwritten(links_.open_in, count);
        const std::vector<Index> several = indices_where(count, chunks::quick, [&](Index i) {
            const Index v = links_.source[i];
            return assign_fan(links_.side_out[i], i) < first_out_[v + 1] - first_out_[v];
        });
        if (several.empty()) return;
        list_sides_out();
        for (const Index i : several) split_vertex(links_.source[i]);
    }

    /// The first fan has its vertex already; each of the others gets a new one.
    void split_vertex(Index v) {
        const auto add_fan = [&](Index c) {
            const auto copy = static_cast<Index>(links_.source.size());
            links_.source.push_back(v);
            links_.side_out.push_back(no_index);
            links_.open_in.push_back(no_index);
            assign_fan(c, copy);
            ++links_.split_vertices;
        };
        const auto is_free = [&](Index c) { return links_.vertex[c] == no_index; };
        for (const std::uint64_t key : sides_out(v))
            if (is_free(side_of(key)) && links_.twin[side_of(key)] == no_index) add_fan(side_of(key));
        for (const std::uint64_t key : sides_out(v))
            if (is_free(side_of(key))) add_fan(side_of(key));
    }

    const PolygonMesh& facets_;
    FacetLinks links_;
    std::vector<Index> first_out_;
    std::vector<std::uint64_t> out_;
};

} // namespace

FacetLinks link_facets(const PolygonMesh& facets) {
    return Linker(facets).run();
}

} // namespace hsdm
