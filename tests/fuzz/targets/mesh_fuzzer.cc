// The mesh readers, one at a time by the program's name, and what looks at any mesh that was read.

#include "fuzz/targets/fuzz.hh"
#include "hsdm/errors.hh"
#include "hsdm/io/mesh_readers.hh"
#include "hsdm/mesh/to_mesh.hh"
#include "hsdm/quality/topology.hh"

#include <tbb/global_control.h>

#include <array>
#include <cmath>
#include <cstring>

using namespace hsdm;
using hsdm::fuzz::promise;

namespace {

std::string name;

void check(const PolygonMesh& mesh) {
    const std::size_t n = mesh.vertex_count();
    promise(mesh.normals.empty() || mesh.normals.size() == n, "a normal for each vertex or none");
    for (const VertexProperty& property : mesh.properties)
        promise(property.values.size() == n, "a value for each vertex");
    promise(!mesh.first.empty() && mesh.first.back() == mesh.corners.size(),
            "facets that end with the corners");
    for (Index v : mesh.corners) promise(v < n, "corners that are vertices");
    for (const auto& edge : mesh.sharp_edges)
        promise(edge[0] <= edge[1] && edge[1] < n, "sharp edges between vertices, the lower first");

    const Topology topology = measure_topology(mesh);
    promise(topology.faces == mesh.facet_count(), "as many faces as facets");
    measure_shape(mesh);

    const ToMeshResult built = to_mesh(mesh);
    promise(built.mesh.n_faces() + built.rejected == mesh.facet_count(), "facets are kept or counted");
    const Topology kept = measure_connectivity(to_polygons(built.mesh));
    promise(kept.manifold() && kept.misoriented_edges == 0 && kept.isolated_vertices == 0,
            "an oriented 2-manifold of what any file holds");
}

} // namespace

extern "C" int LLVMFuzzerInitialize(int*, char*** arguments) {
    static const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
    const std::string_view program = **arguments;
    for (const char* extension : {"ply", "off", "obj", "stl", "om"})
        if (program.ends_with(extension)) name = std::string("a.") + extension;
    promise(!name.empty(), "the program's name ends with that of a reader");
    return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
    std::unique_ptr<char[]> copy(new char[size]);
    std::memcpy(copy.get(), bytes, size);
    try {
        check(io::read_mesh(io::SourceBytes::of(std::move(copy), size, name)));
    } catch (const Error& error) {
        promise(std::string_view(error.what()).starts_with(name), "a message begins with the file's name");
    }
    return 0;
}
