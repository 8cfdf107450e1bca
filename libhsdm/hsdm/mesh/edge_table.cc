#include "hsdm/mesh/edge_table.hh"

#include "hsdm/core/large_vector.hh"

namespace hsdm {

EdgeTable::EdgeTable(const PolygonMesh& mesh)
    : EdgeTable(mesh.vertex_count(), [&](const auto& visit) {
          for_each_index(mesh.facet_count(), chunks::quick, [&](Index f) {
              Index side = mesh.first[f + 1] - 1;
              for (Index next = mesh.first[f]; next < mesh.first[f + 1]; side = next++)
                  visit(mesh.corners[side], mesh.corners[next], side);
          });
      }) {}

std::vector<Index> next_sides(const PolygonMesh& mesh) {
    std::vector<Index> next = unwritten_vector<Index>(mesh.corners.size());
    for_each_index(mesh.facet_count(), chunks::quick, [&](Index f) {
        for (Index side = mesh.first[f]; side < mesh.first[f + 1]; ++side)
            next[side] = side + 1 < mesh.first[f + 1] ? side + 1 : mesh.first[f];
    });
    return next;
}

} // namespace hsdm
