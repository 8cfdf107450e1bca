#include "arrays.hh"

#include <string>

namespace hsdm::python {
namespace {

NumberType number_type_of(const py::dtype& type) {
    if (type.kind() == 'u' && type.itemsize() == 1) return NumberType::uint8;
    if (type.kind() == 'u' && type.itemsize() == 2) return NumberType::uint16;
    if (type.kind() == 'i' && type.itemsize() == 4) return NumberType::int32;
    if (type.kind() == 'f' && type.itemsize() == 4) return NumberType::float32;
    if (type.kind() == 'f' && type.itemsize() == 8) return NumberType::float64;
    throw py::type_error("no array of " + type.attr("name").cast<std::string>() + " can be read in place");
}

} // namespace

StridedSpan rows_of(const py::array& array, py::ssize_t columns) {
    const bool is_table = array.ndim() == 2 && array.shape(1) == columns;
    if (!is_table && !(columns == 1 && array.ndim() == 1))
        throw py::value_error("rows of " + std::to_string(columns) + " numbers are wanted");
    if (array.shape(0) == 0) return {};
    if (columns > 1 && array.strides(1) != array.itemsize())
        throw py::value_error("the numbers of a row must stand one after the other");
    if (array.shape(0) > 1 && array.strides(0) < columns * array.itemsize())
        throw py::value_error("rows must not overlap");
    StridedSpan rows;
    rows.data = array.data();
    rows.count = static_cast<std::size_t>(array.shape(0));
    rows.stride =
        static_cast<std::size_t>(array.shape(0) > 1 ? array.strides(0) : columns * array.itemsize());
    rows.type = number_type_of(array.dtype());
    return rows;
}

} // namespace hsdm::python
