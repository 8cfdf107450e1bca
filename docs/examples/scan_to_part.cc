#include <hsdm/io/read_points.hh>
#include <hsdm/io/write_mesh.hh>
#include <hsdm/mesh/to_mesh.hh>
#include <hsdm/reconstruct.hh>

#include <utility>

int main() {
    hsdm::PointFile scan = hsdm::read_points("scan.ply");
    const hsdm::Reconstruction part = hsdm::reconstruct(std::move(scan.cloud), {.depth = 6});
    hsdm::write_mesh("part.stl", hsdm::to_polygons(part.mesh), hsdm::MeshFormat::stl);
    return part.report.mesh.closed ? 0 : 1;
}
