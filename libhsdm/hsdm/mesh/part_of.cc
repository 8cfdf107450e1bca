#include "hsdm/mesh/part_of.hh"

#include <utility>

namespace hsdm {

PolygonMesh part_of(const PolygonMesh& mesh, const std::vector<Index>& facets, std::vector<Index>* number) {
    PolygonMesh part;
    std::vector<Index> in_part(mesh.vertex_count(), no_index);
    for (Index f : facets) {
        for (Index v : mesh.facet(f)) {
            if (in_part[v] == no_index) {
                in_part[v] = static_cast<Index>(part.positions.size());
                part.positions.push_back(mesh.positions[v]);
            }
            part.corners.push_back(in_part[v]);
        }
        part.first.push_back(static_cast<Index>(part.corners.size()));
    }
    if (number) *number = std::move(in_part);
    return part;
}

} // namespace hsdm
