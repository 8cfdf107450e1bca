#pragma once
// The parts of the module hsdm._core, which the package's Python files wrap. Its functions take what these
// have checked and converted.

#include <pybind11/pybind11.h>

namespace hsdm::python {

/// Polygons: the library's PolygonMesh and what is measured, written and done with it.
void bind_polygons(pybind11::module_& core);
/// read_points, read_mesh and Cloud, what the first returns.
void bind_files(pybind11::module_& core);
/// ReconstructOptions.
void bind_options(pybind11::module_& core);
/// reconstruct, reconstruct_levels, and View, the points that they take.
void bind_reconstruct(pybind11::module_& core);
/// process: stages.
void bind_process(pybind11::module_& core);
/// compare, topology.
void bind_quality(pybind11::module_& core);

} // namespace hsdm::python
