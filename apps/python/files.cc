#include "arrays.hh"
#include "bindings.hh"
#include "interpreter.hh"

#include "hsdm/io/read_mesh.hh"
#include "hsdm/io/read_points.hh"

#include <pybind11/stl.h>

namespace hsdm::python {
namespace {

using Place = std::array<double, 3>;

Vec3 vec3_of(const Place& place) {
    return {place[0], place[1], place[2]};
}

std::shared_ptr<PointFile> read_cloud(const std::string& path, const std::string& format,
                                      const std::string& columns, const std::vector<Place>& sensors,
                                      const std::string& sensor_column) {
    ReadOptions options{.format = format, .columns = columns, .sensor_column = sensor_column};
    for (const Place& sensor : sensors) options.sensors.push_back(vec3_of(sensor));
    return run_interruptibly([&] {
        return on_file(path, [&] { return std::make_shared<PointFile>(read_points(path, options)); });
    });
}

std::shared_ptr<PolygonMesh> read_polygons(const std::string& path) {
    return run_interruptibly(
        [&] { return on_file(path, [&] { return std::make_shared<PolygonMesh>(read_mesh(path)); }); });
}

const PointCloud& cloud_of(const py::object& self) {
    return self.cast<const PointFile&>().cloud;
}

py::array colors_of(const py::object& self) {
    const auto& colors = cloud_of(self).colors;
    return borrowed(colors.empty() ? nullptr : colors.front().data(),
                    {static_cast<py::ssize_t>(colors.size()), 4}, self);
}

/// By name, those that are labels or those that are not.
py::dict scalars_of(const py::object& self, bool labels) {
    py::dict scalars;
    for (const Scalar& scalar : cloud_of(self).scalars)
        if (scalar.is_label == labels)
            scalars[text_of(scalar.name)] =
                borrowed(scalar.values.data(), {static_cast<py::ssize_t>(scalar.values.size())}, self);
    return scalars;
}

py::object sensor_of(const py::object& self) {
    const auto& sensor = cloud_of(self).sensor;
    if (!sensor) return py::none();
    return py::make_tuple((*sensor)[0], (*sensor)[1], (*sensor)[2]);
}

py::object first_withheld_of(const PointFile& file) {
    if (file.withheld == 0) return py::none();
    const Vec3& place = file.first_withheld;
    return py::make_tuple(place[0], place[1], place[2]);
}

} // namespace

void bind_files(py::module_& core) {
    py::class_<PointFile, std::shared_ptr<PointFile>>(core, "Cloud")
        .def_property_readonly(
            "positions", [](const py::object& self) { return borrowed(cloud_of(self).positions, self); })
        .def_property_readonly("normals",
                               [](const py::object& self) { return borrowed(cloud_of(self).normals, self); })
        .def_property_readonly("colors", &colors_of)
        .def_property_readonly("scalars", [](const py::object& self) { return scalars_of(self, false); })
        .def_property_readonly("labels", [](const py::object& self) { return scalars_of(self, true); })
        .def_property_readonly("sensor", &sensor_of)
        .def_property_readonly("sensors",
                               [](const py::object& self) { return borrowed(cloud_of(self).sensors, self); })
        .def_property_readonly("sensor_of",
                               [](const py::object& self) {
                                   const auto& numbers = cloud_of(self).sensor_of;
                                   return borrowed(numbers.data(), {static_cast<py::ssize_t>(numbers.size())},
                                                   self);
                               })
        .def_readonly("format", &PointFile::format)
        .def_readonly("faces", &PointFile::faces)
        .def_readonly("nonfinite", &PointFile::nonfinite)
        .def_readonly("withheld", &PointFile::withheld)
        .def_property_readonly("first_withheld", &first_withheld_of)
        .def_property_readonly("columns", [](const PointFile& file) { return text_of(file.columns); });
    core.def("read_points", &read_cloud, py::arg("path"), py::arg("format"), py::arg("columns"),
             py::arg("sensors"), py::arg("sensor_column"));
    core.def("read_mesh", &read_polygons, py::arg("path"));
    py::list formats;
    for (const std::string_view format : point_formats()) formats.append(py::str(std::string(format)));
    core.attr("point_formats") = py::tuple(formats);
}

} // namespace hsdm::python
