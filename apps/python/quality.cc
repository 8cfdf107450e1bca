#include "arrays.hh"
#include "bindings.hh"
#include "interpreter.hh"

#include "hsdm/quality/compare.hh"
#include "hsdm/quality/topology.hh"

namespace hsdm::python {
namespace {

py::dict dict_of(const Distance& distance, const Percentiles& percentiles) {
    py::dict numbers;
    numbers["max"] = distance.max;
    numbers["mean"] = distance.mean;
    numbers["rms"] = distance.rms;
    numbers["median"] = percentiles.median;
    numbers["p95"] = percentiles.p95;
    numbers["p99"] = percentiles.p99;
    return numbers;
}

py::dict compare_polygons(const PolygonMesh& a, const PolygonMesh& b, std::size_t samples) {
    const Comparison result = run_interruptibly([&] { return compare(a, b, {.samples = samples}); });
    py::dict numbers;
    numbers["a_to_b"] = dict_of(result.a_to_b, result.a_to_b_percentiles);
    numbers["b_to_a"] = dict_of(result.b_to_a, result.b_to_a_percentiles);
    numbers["hausdorff"] = result.hausdorff();
    numbers["diagonal"] = result.diagonal;
    return numbers;
}

py::dict topology_of(const PolygonMesh& mesh) {
    const Topology topology = run_interruptibly([&] { return measure_topology(mesh); });
    py::dict counts;
    counts["vertices"] = topology.vertices;
    counts["isolated_vertices"] = topology.isolated_vertices;
    counts["edges"] = topology.edges;
    counts["faces"] = topology.faces;
    counts["triangles"] = topology.triangles;
    counts["quads"] = topology.quads;
    counts["larger"] = topology.larger;
    counts["components"] = topology.components;
    counts["boundary_edges"] = topology.boundary_edges;
    counts["boundary_loops"] = topology.boundary_loops;
    counts["nonmanifold_edges"] = topology.nonmanifold_edges;
    counts["nonmanifold_vertices"] = topology.nonmanifold_vertices;
    counts["misoriented_edges"] = topology.misoriented_edges;
    counts["degenerate_facets"] = topology.degenerate_facets;
    counts["duplicate_facets"] = topology.duplicate_facets;
    counts["euler"] = topology.euler;
    counts["genus"] = topology.genus();
    counts["signed_volume"] = topology.signed_volume;
    counts["manifold"] = topology.manifold();
    counts["closed"] = topology.closed();
    return counts;
}

} // namespace

void bind_quality(py::module_& core) {
    core.def("compare", &compare_polygons, py::arg("a"), py::arg("b"), py::arg("samples"));
    core.def("topology", &topology_of, py::arg("polygons"));
}

} // namespace hsdm::python
