#include <hsdm/io/read_points.hh>
#include <hsdm/io/write_mesh.hh>
#include <hsdm/mesh/to_mesh.hh>
#include <hsdm/reconstruct.hh>

int main() {
    const hsdm::Reconstruction part = hsdm::reconstruct(hsdm::read_points("scan.ply"), {.depth = 6});
    hsdm::write_mesh("part.stl", hsdm::to_polygons(part.mesh), hsdm::MeshFormat::stl);
    return part.report.mesh.closed ? 0 : 1;
}
