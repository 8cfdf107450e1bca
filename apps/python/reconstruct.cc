#include "hsdm/reconstruct.hh"

#include "arrays.hh"
#include "bindings.hh"
#include "interpreter.hh"

#include "hsdm/io/read_points.hh"
#include "hsdm/mesh/to_mesh.hh"

#include <pybind11/stl.h>

namespace hsdm::python {
namespace {

using Place = std::array<double, 3>;

/// A PointView and the arrays that it looks at.
struct View {
    View(const py::array& positions, const std::optional<py::array>& normals,
         const std::optional<py::array>& colors, const std::optional<Place>& sensor,
         const std::optional<std::vector<Place>>& places, const std::optional<py::array>& sensor_of) {
        points.positions = keep(positions, 3);
        if (normals) points.normals = keep(*normals, 3);
        if (colors) {
            points.color_channels = static_cast<int>(colors->shape(1));
            points.colors = keep(*colors, colors->shape(1) == 3 ? 3 : 4);
        }
        if (sensor) points.sensor = Vec3((*sensor)[0], (*sensor)[1], (*sensor)[2]);
        if (places)
            for (const Place& place : *places) sensors.emplace_back(place[0], place[1], place[2]);
        points.sensors = sensors;
        if (sensor_of) points.sensor_of = keep(*sensor_of, 1);
    }
    View(const View&) = delete; // the points look at its own sensors
    View& operator=(const View&) = delete;

    void add_scalar(const std::string& name, const py::array& values, bool is_label) {
        points.scalars.push_back({name, keep(values, 1), is_label});
    }

    PointView points;
    std::shared_ptr<const PointFile> file; ///< that the positions come from, if any

private:
    StridedSpan keep(const py::array& array, py::ssize_t columns) {
        kept_.push_back(array);
        return rows_of(array, columns);
    }

    std::vector<Vec3> sensors;
    std::vector<py::array> kept_;
};

/// Polygons and the report as JSON; without the lock.
struct Made {
    std::shared_ptr<PolygonMesh> polygons;
    std::string report;
};

Made made_of(const View& view, Reconstruction result) {
    if (view.file) note_reading(*view.file, result.report);
    return {std::make_shared<PolygonMesh>(to_polygons(result.mesh)), to_json(result.report)};
}

py::tuple tuple_of(const Made& made) {
    return py::make_tuple(made.polygons, text_of(made.report));
}

ReconstructOptions watched(ReconstructOptions options, Watch& watch) {
    if (watch.is_needed())
        options.progress = [&watch](const char* phase, double done) { return watch.goes_on(phase, done); };
    return options;
}

py::tuple reconstruct_one(const View& view, const ReconstructOptions& given, const py::object& progress) {
    Watch watch(progress);
    const ReconstructOptions options = watched(given, watch);
    return tuple_of(watch.run([&] { return made_of(view, reconstruct(view.points, options)); }));
}

py::list reconstruct_several(const View& view, int first_depth, int last_depth,
                             const ReconstructOptions& given, const py::object& progress) {
    Watch watch(progress);
    const ReconstructOptions options = watched(given, watch);
    const std::vector<Made> levels = watch.run([&] {
        std::vector<Made> made;
        for (Reconstruction& result : reconstruct_levels(view.points, first_depth, last_depth, options))
            made.push_back(made_of(view, std::move(result)));
        return made;
    });
    py::list list;
    for (const Made& made : levels) list.append(tuple_of(made));
    return list;
}

} // namespace

void bind_reconstruct(py::module_& core) {
    py::class_<View>(core, "View")
        .def(py::init<const py::array&, const std::optional<py::array>&, const std::optional<py::array>&,
                      const std::optional<Place>&, const std::optional<std::vector<Place>>&,
                      const std::optional<py::array>&>(),
             py::arg("positions"), py::arg("normals"), py::arg("colors"), py::arg("sensor"),
             py::arg("sensors"), py::arg("sensor_of"))
        .def("add_scalar", &View::add_scalar, py::arg("name"), py::arg("values"), py::arg("is_label"))
        .def(
            "note_file", [](View& view, std::shared_ptr<PointFile> file) { view.file = std::move(file); },
            py::arg("cloud"))
        .def("address",
             [](const View& view) { return reinterpret_cast<std::uintptr_t>(view.points.positions.data); });
    core.def("reconstruct", &reconstruct_one, py::arg("view"), py::arg("options"), py::arg("progress"));
    core.def("reconstruct_levels", &reconstruct_several, py::arg("view"), py::arg("first_depth"),
             py::arg("last_depth"), py::arg("options"), py::arg("progress"));
}

} // namespace hsdm::python
