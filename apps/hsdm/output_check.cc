#include "output_check.hh"

#include "reconstruct_arguments.hh"
#include "reconstruct_output.hh"

#include "hsdm/cloud/cloud_frame.hh"
#include "hsdm/io/read_mesh.hh"
#include "hsdm/io/scratch_file.hh"
#include "hsdm/mesh/to_mesh.hh"
#include "hsdm/mesh/triangulate.hh"
#include "hsdm/quality/mesh_digest.hh"

#include <algorithm>
#include <filesystem>

namespace hsdm::command {
namespace {

std::string numbers_of(const PolygonMesh& mesh) {
    return std::to_string(mesh.vertex_count()) + " vertices and " + std::to_string(mesh.facet_count())
           + " faces";
}

/// The most that the STL writer lets a corner move, of the mesh's diagonal.
constexpr double most_moved = 1e-6;

std::string fault_of_triangles(const PolygonMesh& mesh, const PolygonMesh& read) {
    const Triangulation cut = triangulate(mesh);
    if (read.facet_count() != cut.size())
        return "holds " + std::to_string(read.facet_count()) + " triangles instead of "
               + std::to_string(cut.size());
    const Box box = bounds_of(mesh.positions);
    const double unit = CloudFrame(box).unit();
    const double tolerance = most_moved * (box.hi / unit - box.lo / unit).norm();
    for (std::size_t t = 0; t < cut.size(); ++t)
        for (std::size_t corner = 0; corner < 3; ++corner) {
            const Vec3 moved = read.positions[read.facet(t)[corner]] / unit
                               - mesh.positions[cut.triangles[t][corner]] / unit;
            if (!(moved.norm() <= tolerance))
                return "holds triangle " + std::to_string(t) + " at another place";
        }
    return "";
}

/// As the type stores them.
bool same_values(const VertexProperty& a, const VertexProperty& b) {
    const bool coarse = a.type == VertexProperty::Type::float32;
    return std::equal(a.values.begin(), a.values.end(), b.values.begin(), b.values.end(),
                      [coarse](double x, double y) {
                          return coarse ? static_cast<float>(x) == static_cast<float>(y) : x == y;
                      });
}

bool same_properties(const PolygonMesh& mesh, const PolygonMesh& read) {
    const auto same = [](const VertexProperty& a, const VertexProperty& b) {
        return a.name == b.name && same_values(a, b);
    };
    return std::equal(mesh.properties.begin(), mesh.properties.end(), read.properties.begin(),
                      read.properties.end(), same);
}

std::string fault_of(const PolygonMesh& mesh, const PolygonMesh& read, MeshFormat format) {
    if (format == MeshFormat::stl) return fault_of_triangles(mesh, read);
    if (mesh_hash(read) != mesh_hash(mesh))
        return "holds another mesh: " + numbers_of(read) + " instead of " + numbers_of(mesh);
    if (format != MeshFormat::ply && format != MeshFormat::om) return "";
    if (read.normals != mesh.normals) return "holds other normals";
    if (!same_properties(mesh, read)) return "holds other properties of vertices";
    if (format == MeshFormat::om && read.sharp_edges != mesh.sharp_edges) return "holds other sharp edges";
    return "";
}

} // namespace

OutputCheck check_output(const Case& one, const CaseOptions& asked, const PolyMesh& mesh) {
    const ScratchFile file('.' + one.output);
    const MeshTarget target{file.path(), format_for(file.path(), ""), asked.ascii, asked.plain, "", ""};
    OutputCheck check;
    check.output.format = one.output;
    check.output.text_for_precision = write_outputs(target, mesh).text_for_precision;
    check.output.bytes = std::filesystem::file_size(file.path());
    const PolygonMesh read = read_mesh(file.path());
    check.output.vertices = read.vertex_count();
    check.output.faces = read.facet_count();
    check.output.digest = mesh_digest(read);
    check.fault = fault_of(polygons_to_write(mesh, target.plain), read, target.format);
    return check;
}

} // namespace hsdm::command
