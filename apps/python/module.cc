// hsdm._core: the library for the package hsdm.

#include "bindings.hh"
#include "interpreter.hh"

#include "hsdm/version.hh"

PYBIND11_MODULE(_core, core) {
    core.doc() = "The library, for the package hsdm alone: use what that has instead.";
    core.attr("version") = hsdm::version;
    hsdm::python::translate_errors();
    hsdm::python::bind_polygons(core);
    hsdm::python::bind_files(core);
    hsdm::python::bind_options(core);
    hsdm::python::bind_reconstruct(core);
    hsdm::python::bind_process(core);
    hsdm::python::bind_quality(core);
}
