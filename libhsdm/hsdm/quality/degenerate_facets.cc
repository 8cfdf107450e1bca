#include "hsdm/quality/degenerate_facets.hh"

#include "hsdm/core/chunks.hh"
#include "hsdm/core/large_vector.hh"
#include "hsdm/mesh/remove_facets.hh"
#include "hsdm/quality/topology.hh"

#include <algorithm>
#include <array>
#include <vector>

namespace hsdm {
namespace {

/// Does a neighbouring facet have the same vertices? Two facets over the same four vertices or fewer always
/// share a side.
bool is_of_pillow(const PolygonMesh& mesh, const FacetLinks& links, std::size_t f) {
    const auto facet = mesh.facet(f);
    for (std::size_t k = 0; k < facet.size(); ++k) {
        const Index twin = links.twin[mesh.first[f] + k];
        const std::size_t beyond = k + 2 < facet.size() ? k + 2 : k + 2 - facet.size(); // the side's ends
        if (twin != no_index && have_same_vertices(facet, mesh.facet(links.facet[twin]), beyond)) return true;
    }
    return false;
}

/// Does the facet belong to a closed surface of fewer than four facets, which encloses no space?
bool is_of_flat_component(const PolygonMesh& mesh, const FacetLinks& links, std::size_t f) {
    constexpr std::size_t fewest = 4;
    std::array<std::size_t, fewest> found{f};
    std::size_t count = 1;
    for (std::size_t i = 0; i < count; ++i)
        for (Index side = mesh.first[found[i]]; side < mesh.first[found[i] + 1]; ++side) {
            if (links.twin[side] == no_index) return false;
            const std::size_t next = links.facet[links.twin[side]];
            if (std::find(found.begin(), found.begin() + count, next) != found.begin() + count) continue;
            if (count + 1 == fewest) return false;
            found[count++] = next;
        }
    return true;
}

/// Does the facet span empty space that the frame has cut out?
bool spans_cut(const PolygonMesh& mesh, const Vec3& origin, const CloudFrame& frame, std::size_t f) {
    const auto facet = mesh.facet(f);
    const auto stretch = frame.stretch_of(mesh.positions[facet[0]] + origin);
    return std::any_of(facet.begin(), facet.end(),
                       [&](Index v) { return frame.stretch_of(mesh.positions[v] + origin) != stretch; });
}

} // namespace

Occurrences drop_degenerate_facets(PolygonMesh& mesh, const Vec3& origin, const CloudFrame& frame,
                                   FacetLinks& links, FeatureHints& hints) {
    std::vector<std::uint8_t> unsound = large_vector<std::uint8_t>(mesh.facet_count());
    for_chunks(mesh.facet_count(), chunks::quick, [&](std::size_t begin, std::size_t end, std::size_t) {
        std::vector<Vec3> ring;
        for (std::size_t f = begin; f < end; ++f) {
            ring.clear();
            for (Index v : mesh.facet(f)) ring.push_back(frame.to_cloud(mesh.positions[v] + origin));
            unsound[f] = has_no_area(ring) || is_of_pillow(mesh, links, f)
                         || is_of_flat_component(mesh, links, f)
                         || (frame.has_cuts() && spans_cut(mesh, origin, frame, f));
        }
    });
    if (std::find(unsound.begin(), unsound.end(), 1) == unsound.end()) return {};
    const Occurrences dropped =
        remove_facets(mesh, hints.sides, [&](std::size_t f) { return unsound[f] != 0; });
    links = FacetLinks(); // its memory first
    links = link_facets(mesh);
    return dropped;
}

} // namespace hsdm
