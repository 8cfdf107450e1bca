#include "bindings.hh"

#include "hsdm/reconstruct.hh"

#include <pybind11/stl.h>

namespace hsdm::python {

namespace py = pybind11;

void bind_options(py::module_& core) {
    py::enum_<Method>(core, "Method")
        .value("automatic", Method::automatic)
        .value("basic", Method::basic)
        .value("extended", Method::extended);
    py::enum_<NormalSource>(core, "NormalSource")
        .value("automatic", NormalSource::automatic)
        .value("given", NormalSource::given)
        .value("estimate", NormalSource::estimate);
    py::enum_<Holes>(core, "Holes")
        .value("automatic", Holes::automatic)
        .value("keep", Holes::keep)
        .value("close", Holes::close)
        .value("complete", Holes::complete);
    py::enum_<Grid>(core, "Grid")
        .value("automatic", Grid::automatic)
        .value("uniform", Grid::uniform)
        .value("adaptive", Grid::adaptive);
    py::class_<ReconstructOptions>(core, "ReconstructOptions")
        .def(py::init<>())
        .def_readwrite("depth", &ReconstructOptions::depth)
        .def_readwrite("voxel_size", &ReconstructOptions::voxel_size)
        .def("set_max_error",
             [](ReconstructOptions& options, double value, bool of_diagonal) {
                 options.max_error = MaxError{value, of_diagonal};
             })
        .def_readwrite("grid", &ReconstructOptions::grid)
        .def_readwrite("method", &ReconstructOptions::method)
        .def_readwrite("normals", &ReconstructOptions::normals)
        .def_readwrite("holes", &ReconstructOptions::holes)
        .def_readwrite("merge_layers", &ReconstructOptions::merge_layers)
        .def("set_min_component",
             [](ReconstructOptions& options, double value, bool of_largest) {
                 options.min_component = MinComponent{value, of_largest};
             })
        .def_readwrite("confidence", &ReconstructOptions::confidence)
        .def_readwrite("trim", &ReconstructOptions::trim)
        .def_readwrite("crease_angle", &ReconstructOptions::crease_angle)
        .def_readwrite("normal_smoothing", &ReconstructOptions::normal_smoothing)
        .def_readwrite("threads", &ReconstructOptions::threads)
        .def_readwrite("classify", &ReconstructOptions::classify)
        .def_readwrite("vertex_normals", &ReconstructOptions::vertex_normals)
        .def_readwrite("measure", &ReconstructOptions::measure)
        .def("set_debug_dir",
             [](ReconstructOptions& options, const std::string& folder) { options.debug_dir = folder; });
}

} // namespace hsdm::python
