#include "hsdm/quality/self_intersections.hh"

#include "hsdm/facets/weld.hh"
#include "hsdm/quality/flat_fans.hh"
#include "hsdm/quality/triangle_tree.hh"
#include "hsdm/quality/triangles_meet.hh"

#include <tbb/parallel_for.h>
#include <tbb/parallel_sort.h>

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
          flat_(flat_fans(mesh.positions, cut_.triangles, welded_)),
          collinear_(cut_.size()) {
        tbb::parallel_for(std::size_t{0}, cut_.size(),
                          [&](std::size_t t) { collinear_[t] = is_collinear(place(t).corner); });
    }

    SelfIntersections run() const {
        const std::size_t chunks = (tree_.block_count() + blocks_per_chunk - 1) / blocks_per_chunk;
        std::vector<std::vector<FacetPair>> found(chunks);
        tbb::parallel_for(std::size_t{0}, chunks, [&](std::size_t chunk) {
            const std::size_t end = std::min(tree_.block_count(), (chunk + 1) * blocks_per_chunk);
            std::vector<TrianglePair> candidates;
            for (std::size_t block = chunk * blocks_per_chunk; block < end; ++block) {
                tree_.overlapping(static_cast<Index>(block), candidates);
                test(candidates, found[chunk]);
            }
        });
        SelfIntersections result;
        result.skipped = static_cast<std::size_t>(std::count(collinear_.begin(), collinear_.end(), 1));
        for (const auto& pairs : found)
            result.facet_pairs.insert(result.facet_pairs.end(), pairs.begin(), pairs.end());
        result.triangle_pairs = result.facet_pairs.size();
        tbb::parallel_sort(result.facet_pairs.begin(), result.facet_pairs.end());
        result.facet_pairs.erase(std::unique(result.facet_pairs.begin(), result.facet_pairs.end()),
                                 result.facet_pairs.end());
        return result;
    }

private:
    PlacedTriangle place(std::size_t t) const {
        PlacedTriangle placed;
        for (std::size_t k = 0; k < 3; ++k) {
            placed.corner[k] = mesh_.positions[cut_.triangles[t][k]];
            placed.vertex[k] = welded_[cut_.triangles[t][k]];
        }
        return placed;
    }

    bool share_flat_fan(std::size_t a, std::size_t b) const {
        for (Index p : cut_.triangles[a])
            for (Index q : cut_.triangles[b])
                if (welded_[p] == welded_[q] && flat_[welded_[p]]) return true;
        return false;
    }

    void test(const std::vector<TrianglePair>& candidates, std::vector<FacetPair>& found) const {
        for (const auto& [a, b] : candidates) {
            if (share_flat_fan(a, b) || collinear_[a] || collinear_[b] || !triangles_meet(place(a), place(b)))
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

} // namespace

SelfIntersections find_self_intersections(const PolygonMesh& mesh) {
    return Finder(mesh).run();
}

} // namespace hsdm
