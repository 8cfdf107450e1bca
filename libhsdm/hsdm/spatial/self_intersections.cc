#include "hsdm/spatial/self_intersections.hh"

#include "hsdm/core/chunks.hh"
#include "hsdm/core/parallel_sort.hh"
#include "hsdm/mesh/part_of.hh"
#include "hsdm/mesh/weld.hh"
#include "hsdm/spatial/flat_fans.hh"
#include "hsdm/spatial/triangle_tree.hh"
#include "hsdm/spatial/triangles_meet.hh"

#include <algorithm>

namespace hsdm {
namespace {

using FacetPair = std::array<Index, 2>;
constexpr std::size_t blocks_per_chunk = 64;

class Finder {
public:
    explicit Finder(const PolygonMesh& mesh)
        : mesh_(mesh),
          cut_(triangulate(mesh)),
          facet_(facet_of_triangle(cut_)),
          welded_(weld(mesh.positions)),
          tree_(mesh.positions, cut_.triangles),
          flat_(flat_fans(mesh, welded_)),
          collinear_(cut_.size()) {
        for_each_index(cut_.size(), chunks::quick,
                       [&](Index t) { collinear_[t] = is_collinear(place(t).corner); });
    }

    SelfIntersections run() const {
        SelfIntersections result;
        const auto test_blocks = [&](std::size_t block, std::size_t end, std::vector<FacetPair>& found) {
            std::vector<TrianglePair> candidates;
            for (; block < end; ++block) {
                tree_.overlapping(static_cast<Index>(block), candidates);
                test(candidates, found);
            }
        };
        result.facet_pairs = collected<FacetPair>(tree_.block_count(), blocks_per_chunk, test_blocks);
        result.skipped = static_cast<std::size_t>(std::count(collinear_.begin(), collinear_.end(), 1));
        result.triangle_pairs = result.facet_pairs.size();
        parallel_sort(result.facet_pairs);
        count_each(result);
        return result;
    }

private:
    /// Leaves each of the sorted pairs once.
    static void count_each(SelfIntersections& found) {
        std::vector<FacetPair> once;
        for (const FacetPair& pair : found.facet_pairs) {
            if (once.empty() || once.back() != pair)
                once.push_back(pair), found.triangles_of_pair.push_back(0);
            ++found.triangles_of_pair.back();
        }
        found.facet_pairs = std::move(once);
    }

    PlacedTriangle place(std::size_t t) const {
        PlacedTriangle placed;
        for (std::size_t k = 0; k < 3; ++k) {
            placed.corner[k] = mesh_.positions[cut_.triangles[t][k]];
            placed.vertex[k] = welded_[cut_.triangles[t][k]];
        }
        return placed;
    }

    /// Do two facets (or one with itself) share a vertex round which no facets meet otherwise?
    bool share_flat_fan(Index f, Index g) const {
        if (f == g && mesh_.facet(f).size() > 4) return false;
        for (Index p : mesh_.facet(f))
            for (Index q : mesh_.facet(g))
                if (welded_[p] == welded_[q] && flat_[welded_[p]]) return true;
        return false;
    }

    void test(const std::vector<TrianglePair>& candidates, std::vector<FacetPair>& found) const {
        for (const auto& [a, b] : candidates) {
            if (share_flat_fan(facet_[a], facet_[b]) || collinear_[a] || collinear_[b]
                || !triangles_meet(place(a), place(b)))
                continue;
            const auto [lesser, greater] = std::minmax(facet_[a], facet_[b]);
            found.push_back({lesser, greater});
        }
    }

    const PolygonMesh& mesh_;
    Triangulation cut_;
    std::vector<Index> facet_, welded_;
    TriangleTree tree_;
    std::vector<std::uint8_t> flat_;
    std::vector<unsigned char> collinear_;
};

/// Do all these facets share one vertex at which they are known not to meet otherwise?
bool share_flat_vertex(const PolygonMesh& mesh, std::span<const Index> facets,
                       const std::vector<std::uint8_t>& flat) {
    for (Index v : mesh.facet(facets[0])) {
        if (!flat[v]) continue;
        const bool shared = std::ranges::all_of(facets, [&](Index f) {
            return mesh.facet(f).size() <= 4 && std::ranges::find(mesh.facet(f), v) != mesh.facet(f).end();
        });
        if (shared) return true;
    }
    return false;
}

/// The facets, ascending, of all cells except those whose facets all share such a vertex. Two facets that
/// intersect do so in a cell that lists both, so all that intersect are among them.
std::vector<Index> facets_in_doubt(const PolygonMesh& mesh, const FacetCells& cells) {
    const std::vector<std::uint8_t> flat = flat_fans(mesh, indices_below(mesh.vertex_count()));
    const auto add_doubtful = [&](std::size_t c, std::size_t end, std::vector<Index>& doubtful) {
        for (; c < end; ++c) {
            const auto facets = cells.facets(static_cast<Index>(c));
            if (!share_flat_vertex(mesh, facets, flat))
                doubtful.insert(doubtful.end(), facets.begin(), facets.end());
        }
    };
    std::vector<Index> doubtful = collected<Index>(cells.size(), chunks::quick, add_doubtful);
    parallel_sort_unique(doubtful);
    return doubtful;
}

} // namespace

SelfIntersections find_self_intersections(const PolygonMesh& mesh) {
    return Finder(mesh).run();
}

SelfIntersections find_self_intersections(const PolygonMesh& mesh, const FacetCells& cells) {
    if (!cells.usable()) return find_self_intersections(mesh);
    const std::vector<Index> doubtful = facets_in_doubt(mesh, cells);
    SelfIntersections found = find_self_intersections(part_of(mesh, doubtful));
    for (auto& pair : found.facet_pairs)
        for (Index& f : pair) f = doubtful[f];
    return found;
}

} // namespace hsdm
