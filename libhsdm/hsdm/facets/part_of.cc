#include "hsdm/facets/part_of.hh"

namespace hsdm {

PolygonMesh part_of(const PolygonMesh& mesh, const std::vector<Index>& facets) {
    PolygonMesh part;
    std::vector<Index> number(mesh.vertex_count(), no_index);
    for (Index f : facets) {
        for (Index v : mesh.facet(f)) {
            if (number[v] == no_index) {
                number[v] = static_cast<Index>(part.positions.size());
                part.positions.push_back(mesh.positions[v]);
            }
            part.corners.push_back(number[v]);
        }
        part.first.push_back(static_cast<Index>(part.corners.size()));
    }
    return part;
}

} // namespace hsdm
