#include "hsdm/pipeline/voxel_order.hh"

#include "hsdm/core/chunks.hh"
#include "hsdm/core/groups.hh"
#include "hsdm/core/large_vector.hh"

#include <algorithm>
#include <atomic>
#include <cassert>

namespace hsdm {
namespace {

/// Which of the vertices have facets.
std::vector<std::uint8_t> used_vertices(const PolygonMesh& mesh) {
    std::vector<std::uint8_t> used = large_vector<std::uint8_t>(mesh.vertex_count(), 0);
    for_each_index(mesh.corners.size(), chunks::light, [&](Index c) {
        std::atomic_ref(used[mesh.corners[c]]).store(1, std::memory_order_relaxed);
    });
    return used;
}

/// The facets in this order, of renumbered vertices.
PolygonMesh rearranged(const PolygonMesh& mesh, const std::vector<Index>& vertices,
                       const std::vector<Index>& facets, const std::vector<Index>& number) {
    PolygonMesh result;
    result.positions = gathered(mesh.positions, vertices);
    resize_large(result.first, facets.size() + 1);
    for_each_in_order(facets.size(), [&](std::size_t f) {
        result.first[f + 1] = result.first[f] + mesh.first[facets[f] + 1] - mesh.first[facets[f]];
    });
    resize_unwritten(result.corners, mesh.corners.size());
    for_each_index(facets.size(), chunks::quick, [&](Index f) {
        Index c = result.first[f];
        for (const Index v : mesh.facet(facets[f])) result.corners[c++] = number[v];
    });
    return result;
}

/// What was known of the sides of facets.
std::vector<EdgeHint> rearranged(const std::vector<EdgeHint>& sides, const PolygonMesh& before,
                                 const std::vector<Index>& facets, const PolygonMesh& mesh) {
    std::vector<EdgeHint> result = large_vector<EdgeHint>(sides.size(), EdgeHint::none);
    if (!sides.empty())
        for_each_index(facets.size(), chunks::quick, [&](Index f) {
            Index side = before.first[facets[f]];
            for (Index c = mesh.first[f]; c < mesh.first[f + 1]; ++c) result[c] = sides[side++];
        });
    return result;
}

/// Links of rearranged facets, as link_facets() would find them: of the sides out of a vertex the one without
/// a twin comes first, or else the one to the least vertex.
FacetLinks rearranged(const FacetLinks& before, const PolygonMesh& old_mesh, const std::vector<Index>& facets,
                      const PolygonMesh& mesh) {
    FacetLinks links;
    links.accepted = std::vector<char>(mesh.facet_count(), 1);
    links.source = indices_below(mesh.vertex_count());
    links.vertex = copy_of_large(mesh.corners);
    const std::size_t sides = mesh.corners.size();
    std::vector<Index> now = unwritten_vector<Index>(sides); // per side before
    resize_unwritten(links.facet, sides);
    for_each_index(facets.size(), chunks::quick, [&](Index f) {
        Index side = old_mesh.first[facets[f]];
        for (Index c = mesh.first[f]; c < mesh.first[f + 1]; ++c) now[side++] = c, links.facet[c] = f;
    });
    resize_unwritten(links.twin, sides);
    for_each_index(sides, chunks::light, [&](Index side) {
        const Index twin = before.twin[side];
        links.twin[now[side]] = twin == no_index ? no_index : now[twin];
    });
    resize_unwritten(links.side_out, mesh.vertex_count());
    resize_unwritten(links.open_in, mesh.vertex_count());
    const auto end = [&](Index c) { return mesh.corners[next_side(mesh, links.facet[c], c)]; };
    for_each_index(before.source.size(), chunks::quick, [&](Index v) {
        const Index first = now[before.side_out[v]], open_in = before.open_in[v];
        Index out = first;
        if (open_in == no_index) // else the fan begins with the side that has no twin
            for (Index c = first; (c = links.twin[previous_side(mesh, links.facet[c], c)]) != first;)
                if (end(c) < end(out)) out = c;
        links.side_out[mesh.corners[first]] = out;
        links.open_in[mesh.corners[first]] = open_in == no_index ? no_index : now[open_in];
    });
    return links;
}

/// Do vertices, all of which have facets, and facets come as order_by_voxels() puts them?
bool are_in_order(const std::vector<Index>& voxel, const std::vector<std::uint8_t>& used,
                  const PolygonMesh& mesh) {
    const auto least = [&](std::size_t f) { return std::ranges::min(mesh.facet(f)); };
    std::atomic<bool> are = true;
    const auto check = [&](std::size_t count, std::size_t chunk, const auto& holds) {
        for_chunks(count, chunk, [&](std::size_t begin, std::size_t end, std::size_t) {
            for (std::size_t i = begin; i < end && are; ++i)
                if (!holds(i)) are = false;
        });
    };
    check(voxel.size(), chunks::light,
          [&](std::size_t v) { return used[v] && (v == 0 || voxel[v - 1] <= voxel[v]); });
    check(mesh.facet_count(), chunks::quick,
          [&](std::size_t f) { return f == 0 || least(f - 1) <= least(f); });
    return are;
}

} // namespace

void order_by_voxels(std::size_t voxels, std::vector<Index>& voxel, PolygonMesh& mesh,
                     FacetKnowledge& known) {
    assert(mesh.properties.empty() && mesh.normals.empty() && mesh.origin.empty());
    const std::vector<std::uint8_t> used = used_vertices(mesh);
    if (known.links && (known.links->rejected > 0 || known.links->split_vertices > 0)) known.links.reset();
    if (are_in_order(voxel, used, mesh)) return;
    std::vector<Index> key =
        unwritten_vector<Index>(mesh.vertex_count()); // things are ordered by, ties as they are
    for_each_index(key.size(), chunks::light, [&](Index v) { key[v] = used[v] ? voxel[v] : no_index; });
    const Groups by_voxel(key, voxels);
    const std::vector<Index>& vertices = by_voxel.members();
    std::vector<Index> number = large_vector<Index>(mesh.vertex_count(), no_index);
    for_each_index(vertices.size(), chunks::light, [&](Index v) { number[vertices[v]] = v; });
    resize_large(key, mesh.facet_count());
    for_each_index(key.size(), chunks::quick, [&](Index f) {
        key[f] = no_index;
        for (const Index v : mesh.facet(f)) key[f] = std::min(key[f], number[v]);
    });
    const Groups by_least_vertex(key, vertices.size());
    const std::vector<Index>& facets = by_least_vertex.members();
    PolygonMesh result = rearranged(mesh, vertices, facets, number);
    voxel = gathered(voxel, vertices);
    known.hints.sides = rearranged(known.hints.sides, mesh, facets, result);
    if (known.links) known.links = rearranged(*known.links, mesh, facets, result);
    if (known.cells) {
        assign_large(number, facets.size(), no_index);
        for_each_index(facets.size(), chunks::light, [&](Index f) { number[facets[f]] = f; });
        known.cells->renumber(number);
    }
    mesh = std::move(result);
}

} // namespace hsdm
