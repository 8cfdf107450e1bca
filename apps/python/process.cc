#include "bindings.hh"
#include "interpreter.hh"

#include "hsdm/cloud/cloud_frame.hh"
#include "hsdm/features/features.hh"
#include "hsdm/mesh/to_mesh.hh"
#include "hsdm/stages/stages.hh"

#include <pybind11/stl.h>

namespace hsdm::python {
namespace {

/// A name that there is not is a wrong argument here, as one that does not fit its stage is.
StageCall stage_of(const std::string& text) {
    try {
        StageCall call = parse_stage_call(text);
        if (call.takes_scan())
            throw OptionError(call.stage.name + ": " + call.stage.instead_of_scan
                              + ": not given, and a mesh has no scan with it; name a file");
        return call;
    } catch (const Error& error) {
        throw OptionError(error.what());
    }
}

/// Stages multiply lengths by each other many times over.
void check_size(const PolygonMesh& mesh) {
    if (CloudFrame(bounds_of(mesh.positions)).unit() != 1)
        throw Error("stages work on meshes between 2^-30 and 2^30 across; scale the mesh first");
}

void build(const PolygonMesh& facets, PolyMesh& mesh) {
    const ToMeshCounts counts = to_mesh(facets, mesh);
    if (counts.rejected > 0)
        throw Error(std::to_string(counts.rejected)
                    + " facets meet where a half-edge mesh cannot hold them; stages work on 2-manifolds");
    mark_edges_by_normals(mesh);
}

/// The polygons that stages leave, and what each says it did.
py::tuple process(const PolygonMesh& facets, const std::vector<std::string>& stages) {
    const auto left = std::make_shared<PolygonMesh>();
    std::vector<std::string> summaries;
    run_interruptibly([&] {
        std::vector<StageCall> calls;
        for (const std::string& text : stages) calls.push_back(stage_of(text));
        check_size(facets);
        PolyMesh mesh;
        build(facets, mesh);
        for (const StageCall& call : calls) summaries.push_back(call(mesh));
        *left = to_polygons(mesh);
    });
    py::list said;
    for (const std::string& summary : summaries) said.append(text_of(summary));
    return py::make_tuple(left, said);
}

} // namespace

void bind_process(py::module_& core) {
    core.def("process", &process, py::arg("polygons"), py::arg("stages"));
}

} // namespace hsdm::python
