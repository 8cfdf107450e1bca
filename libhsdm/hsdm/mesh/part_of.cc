#include "hsdm/mesh/part_of.hh"

#include "hsdm/core/chunks.hh"

#include <algorithm>
#include <array>
#include <utility>

namespace hsdm {

PolygonMesh part_of(const PolygonMesh& mesh, const std::vector<Index>& facets, std::vector<Index>* number) {
    PolygonMesh part;
    std::vector<Index> in_part = large_vector<Index>(mesh.vertex_count(), no_index);
    for_each_in_order(facets.size(), [&](std::size_t i) {
        for (Index v : mesh.facet(facets[i])) {
            if (in_part[v] == no_index) {
                in_part[v] = static_cast<Index>(part.positions.size());
                push_large(part.positions, mesh.positions[v]);
            }
            push_large(part.corners, in_part[v]);
        }
        push_large(part.first, static_cast<Index>(part.corners.size()));
    });
    if (number) *number = std::move(in_part);
    return part;
}

PolygonMesh copy_of(const PolygonMesh& mesh) {
    PolygonMesh copy;
    copy.positions = copy_of_large(mesh.positions);
    copy.corners = copy_of_large(mesh.corners);
    copy.first = copy_of_large(mesh.first);
    copy.origin = copy_of_large(mesh.origin);
    return copy;
}

std::vector<Index> border_of(const PolygonMesh& mesh, const std::vector<Index>& facets) {
    using Side = std::array<Index, 2>;
    std::vector<Side> sides, border;
    for (const Index f : facets) {
        const auto corners = mesh.facet(f);
        for (std::size_t k = 0; k < corners.size(); ++k)
            sides.push_back({corners[k], corners[(k + 1) % corners.size()]});
    }
    std::ranges::sort(sides);
    for (const auto& [from, to] : sides)
        if (!std::ranges::binary_search(sides, Side{to, from})) border.push_back({from, to});
    std::vector<Index> ring;
    for (Index at = border.empty() ? no_index : border[0][0]; ring.size() < border.size();) {
        const auto side = std::ranges::lower_bound(border, Side{at, 0});
        if (side == border.end() || (*side)[0] != at || (side + 1 != border.end() && side[1][0] == at))
            return {};
        ring.push_back(at);
        at = (*side)[1];
        if (at == ring.front()) break;
    }
    return ring.size() == border.size() ? ring : std::vector<Index>();
}

void append_facets(PolygonMesh& mesh, const std::vector<PolygonMesh>& parts) {
    std::vector<std::size_t> corner(parts.size()), facet(parts.size());
    std::size_t corners = mesh.corners.size(), facets = mesh.facet_count();
    for (std::size_t i = 0; i < parts.size(); ++i) {
        corner[i] = std::exchange(corners, corners + parts[i].corners.size());
        facet[i] = std::exchange(facets, facets + parts[i].facet_count());
    }
    resize_unwritten(mesh.corners, corners);
    resize_large(mesh.first, facets + 1);
    for_each_task(parts.size(), [&](std::size_t i) {
        std::ranges::copy(parts[i].corners, mesh.corners.begin() + static_cast<std::ptrdiff_t>(corner[i]));
        for (std::size_t f = 0; f < parts[i].facet_count(); ++f)
            mesh.first[facet[i] + f + 1] = static_cast<Index>(corner[i] + parts[i].first[f + 1]);
    });
}

} // namespace hsdm
