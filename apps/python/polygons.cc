#include "arrays.hh"
#include "bindings.hh"
#include "interpreter.hh"

#include "hsdm/io/write_mesh.hh"
#include "hsdm/mesh/triangulate.hh"
#include "hsdm/quality/mesh_digest.hh"

#include <pybind11/stl.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <iterator>

namespace hsdm::python {
namespace {

using Type = VertexProperty::Type;
using Indices = py::array_t<Index, py::array::c_style>;
using Doubles = py::array_t<double, py::array::c_style>;

template <class Value, class Number>
std::vector<Value> vector_of(const py::array_t<Number, py::array::c_style>& array) {
    static_assert(sizeof(Value) % sizeof(Number) == 0);
    std::vector<Value> values(static_cast<std::size_t>(array.nbytes()) / sizeof(Value));
    if (!values.empty())
        std::memcpy(static_cast<void*>(values.data()), array.data(), values.size() * sizeof(Value));
    return values;
}

Type type_of(const py::dtype& type) {
    if (type.kind() == 'u' && type.itemsize() == 1) return Type::uint8;
    if (type.kind() == 'i' && type.itemsize() == 4) return Type::int32;
    if (type.kind() == 'f' && type.itemsize() == 4) return Type::float32;
    return Type::float64;
}

/// Throws ValueError where an index would lead nowhere.
void check(const PolygonMesh& mesh) {
    const auto refuse = [](const std::string& what) { throw py::value_error(what); };
    if (mesh.first.empty() || mesh.first.front() != 0 || mesh.first.back() != mesh.corners.size())
        refuse("face_offsets must begin with 0 and end with " + std::to_string(mesh.corners.size())
               + ", the number of face_vertices");
    for (std::size_t f = 0; f < mesh.facet_count(); ++f)
        if (mesh.first[f + 1] < mesh.first[f] || mesh.first[f + 1] - mesh.first[f] < 3)
            refuse("face " + std::to_string(f) + " has fewer than three vertices");
    const auto check_vertex = [&](Index v, const char* whose) {
        if (v >= mesh.vertex_count())
            refuse(std::string(whose) + " refers to vertex " + std::to_string(v) + ", but there are "
                   + std::to_string(mesh.vertex_count()));
    };
    for (const Index v : mesh.corners) check_vertex(v, "a face");
    for (const auto& edge : mesh.sharp_edges)
        for (const Index v : edge) check_vertex(v, "a sharp edge");
}

std::shared_ptr<PolygonMesh> make_polygons(const Doubles& positions, const Indices& corners,
                                           const Indices& first, const Doubles& normals,
                                           const Indices& sharp_edges, const py::dict& properties) {
    auto mesh = std::make_shared<PolygonMesh>();
    mesh->positions = vector_of<Vec3>(positions);
    mesh->corners = vector_of<Index>(corners);
    mesh->first = vector_of<Index>(first);
    mesh->normals = vector_of<Vec3>(normals);
    mesh->sharp_edges = vector_of<std::array<Index, 2>>(sharp_edges);
    for (auto& [v, w] : mesh->sharp_edges)
        if (w < v) std::swap(v, w);
    for (const auto& [name, values] : properties)
        mesh->properties.push_back({name.cast<std::string>(), type_of(values.cast<py::array>().dtype()),
                                    vector_of<double>(values.cast<Doubles>())});
    check(*mesh);
    return mesh;
}

py::array values_of(const VertexProperty& property, const py::handle& owner) {
    switch (property.type) {
    case Type::uint8:
        return converted<std::uint8_t>(property.values);
    case Type::int32:
        return converted<std::int32_t>(property.values);
    case Type::float32:
        return converted<float>(property.values);
    case Type::float64:
        break;
    }
    return borrowed(property.values.data(), {static_cast<py::ssize_t>(property.values.size())}, owner);
}

py::dict properties_of(const py::object& self) {
    py::dict properties;
    for (const VertexProperty& property : self.cast<const PolygonMesh&>().properties)
        properties[text_of(property.name)] = values_of(property, self);
    return properties;
}

py::array sharp_edges_of(const py::object& self) {
    const auto& edges = self.cast<const PolygonMesh&>().sharp_edges;
    return borrowed(edges.empty() ? nullptr : edges.front().data(),
                    {static_cast<py::ssize_t>(edges.size()), 2}, self);
}

py::array triangles_of(const PolygonMesh& mesh) {
    Triangulation cut = run_interruptibly([&] { return triangulate(mesh); });
    const auto count = static_cast<py::ssize_t>(cut.triangles.size());
    return owning<Index>(std::move(cut.triangles), {count, 3});
}

constexpr LengthUnit units_known[] = {LengthUnit::millimetre, LengthUnit::centimetre, LengthUnit::metre,
                                      LengthUnit::inch};

/// None of an empty name; others _mesh.py has checked.
LengthUnit unit_of(const std::string& name) {
    const auto found = std::ranges::find(units_known, name, &name_of);
    return found == std::end(units_known) ? LengthUnit::none : *found;
}

/// The shift that recentring took off all positions.
py::tuple write(const PolygonMesh& mesh, const std::string& path, bool ascii, const std::string& units,
                bool recentre) {
    const WriteOptions options{.ascii = ascii, .unit = unit_of(units), .recentre = recentre};
    const Vec3 shift = run_interruptibly([&] {
        return on_file(path, [&] { return write_mesh(path, mesh, mesh_format(path), options).shift; });
    });
    return py::make_tuple(shift[0], shift[1], shift[2]);
}

} // namespace

void bind_polygons(py::module_& core) {
    const auto count = [](std::size_t n) { return static_cast<py::ssize_t>(n); };
    py::class_<PolygonMesh, std::shared_ptr<PolygonMesh>>(core, "Polygons")
        .def(py::init(&make_polygons), py::arg("positions"), py::arg("corners"), py::arg("first"),
             py::arg("normals"), py::arg("sharp_edges"), py::arg("properties"))
        .def_property_readonly(
            "positions",
            [](const py::object& self) { return borrowed(self.cast<const PolygonMesh&>().positions, self); })
        .def_property_readonly(
            "normals",
            [](const py::object& self) { return borrowed(self.cast<const PolygonMesh&>().normals, self); })
        .def_property_readonly("corners",
                               [count](const py::object& self) {
                                   const auto& corners = self.cast<const PolygonMesh&>().corners;
                                   return borrowed(corners.data(), {count(corners.size())}, self);
                               })
        .def_property_readonly("first",
                               [count](const py::object& self) {
                                   const auto& first = self.cast<const PolygonMesh&>().first;
                                   return borrowed(first.data(), {count(first.size())}, self);
                               })
        .def_property_readonly("sharp_edges", &sharp_edges_of)
        .def("properties", &properties_of)
        .def("triangles", &triangles_of)
        .def("write", &write, py::arg("path"), py::arg("ascii"), py::arg("units"), py::arg("recentre"))
        .def("digest", [](const PolygonMesh& mesh) { return mesh_digest(mesh); });
    py::list units;
    for (const LengthUnit unit : units_known) units.append(py::str(std::string(name_of(unit))));
    core.attr("length_units") = py::tuple(units);
}

} // namespace hsdm::python
