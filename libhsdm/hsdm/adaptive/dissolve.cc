#include "hsdm/adaptive/dissolve.hh"

#include <algorithm>
#include <array>
#include <numeric>

namespace hsdm {
namespace {

constexpr int most_rounds = 16;

/// The ring of a facet from the corner after v round to the one before it.
void append_without(std::span<const Index> ring, Index v, std::vector<Index>& rest) {
    const auto at = std::find(ring.begin(), ring.end(), v);
    rest.insert(rest.end(), at + 1, ring.end());
    rest.insert(rest.end(), ring.begin(), at);
}

class Dissolving {
public:
    explicit Dissolving(PolygonMesh& mesh) : mesh_(mesh), stands_for_(mesh.vertex_count()) {
        std::iota(stands_for_.begin(), stands_for_.end(), Index{0});
    }

    std::vector<Index> run() {
        for (int round = 0; round < most_rounds && dissolve() > 0; ++round) {
        }
        for (Index& v : stands_for_)
            while (stands_for_[v] != v) v = stands_for_[v];
        return std::move(stands_for_);
    }

private:
    /// The facets at each vertex with one or two of them.
    void find_facets() {
        count_.assign(mesh_.vertex_count(), 0);
        facets_.resize(mesh_.vertex_count());
        for (std::size_t f = 0; f < mesh_.facet_count(); ++f)
            for (Index v : mesh_.facet(f)) {
                if (count_[v] < 2) facets_[v][count_[v]] = static_cast<Index>(f);
                if (count_[v] < 3) ++count_[v];
            }
    }

    std::size_t dissolve() {
        find_facets();
        constexpr Index stays = no_index, goes = no_index - 1;
        std::vector<Index> fate(mesh_.facet_count(), stays);
        std::vector<std::vector<Index>> unions;
        std::size_t dissolved = 0;
        for (Index v = 0; v < mesh_.vertex_count(); ++v) {
            const auto [f, g] = facets_[v];
            if (count_[v] != 2 || f == g || fate[f] != stays || fate[g] != stays) continue;
            std::vector<Index> ring;
            if (!unite(f, g, v, ring)) continue;
            stands_for_[v] = ring.front();
            fate[f] = fate[g] = goes;
            if (ring.size() > 2) {
                fate[f] = static_cast<Index>(unions.size());
                unions.push_back(std::move(ring));
            }
            ++dissolved;
        }
        if (dissolved == 0) return 0;
        PolygonMesh kept;
        for (std::size_t f = 0; f < mesh_.facet_count(); ++f) {
            if (fate[f] == stays)
                kept.add_facet(mesh_.facet(f));
            else if (fate[f] != goes)
                kept.add_facet(unions[fate[f]]);
        }
        mesh_.corners = std::move(kept.corners);
        mesh_.first = std::move(kept.first);
        return dissolved;
    }

    /// Both rings without the vertex between them. False if it lies on a border, if the union has a vertex
    /// twice, or if two triangles are all there is.
    bool unite(Index f, Index g, Index v, std::vector<Index>& ring) const {
        append_without(mesh_.facet(f), v, ring);
        std::vector<Index> other;
        append_without(mesh_.facet(g), v, other);
        if (ring.front() != other.back() || ring.back() != other.front()) return false;
        ring.insert(ring.end(), other.begin() + 1, other.end() - 1);
        if (ring.size() < 3) return count_[ring.front()] > 2 && count_[ring.back()] > 2;
        std::vector<Index> sorted = ring;
        std::sort(sorted.begin(), sorted.end());
        return std::adjacent_find(sorted.begin(), sorted.end()) == sorted.end();
    }

    PolygonMesh& mesh_;
    std::vector<Index> stands_for_;
    std::vector<std::array<Index, 2>> facets_;
    std::vector<std::uint8_t> count_; // 3: more than two
};

} // namespace

std::vector<Index> dissolve_doublets(PolygonMesh& mesh) {
    return Dissolving(mesh).run();
}

} // namespace hsdm
