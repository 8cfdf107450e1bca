#pragma once
// NumPy's arrays as the library's views, and the library's vectors as NumPy's arrays; nothing is copied.

#include "hsdm/point_view.hh"

#include <pybind11/numpy.h>

#include <memory>
#include <vector>

namespace hsdm::python {

namespace py = pybind11;

/// The rows of an array of `columns` numbers each (1: of one dimension too) where they are. The array must
/// live as long as they are looked at. Throws ValueError for another shape or rows whose numbers do not
/// stand one after the other, TypeError for other numbers than the library reads; hsdm/_arrays.py has
/// converted these.
StridedSpan rows_of(const py::array& array, py::ssize_t columns);

/// An array over memory that belongs to `owner`, which lives as long as the array; read-only, as several
/// arrays may share it.
template <class Number>
py::array borrowed(const Number* first, std::vector<py::ssize_t> shape, const py::handle& owner) {
    py::array array(py::dtype::of<Number>(), std::move(shape), first, owner);
    array.attr("setflags")(py::arg("write") = false);
    return array;
}

/// The same of vectors of three numbers.
inline py::array borrowed(const std::vector<Vec3>& vectors, const py::handle& owner) {
    return borrowed(vectors.empty() ? nullptr : vectors.front().data(),
                    {static_cast<py::ssize_t>(vectors.size()), 3}, owner);
}

/// An array of `shape` that owns a vector of numbers, or of rows of them, whose memory becomes its own.
template <class Number, class Row>
py::array owning(std::vector<Row>&& values, std::vector<py::ssize_t> shape) {
    static_assert(sizeof(Row) % sizeof(Number) == 0);
    auto kept = std::make_unique<std::vector<Row>>(std::move(values));
    const py::capsule owner(kept.get(), [](void* v) { delete static_cast<std::vector<Row>*>(v); });
    return borrowed(reinterpret_cast<const Number*>(kept.release()->data()), std::move(shape), owner);
}

/// Values of doubles as an array of numbers that all of them fit; read-only.
template <class Number>
py::array converted(const std::vector<double>& values) {
    std::vector<Number> numbers(values.size());
    for (std::size_t i = 0; i < values.size(); ++i) numbers[i] = static_cast<Number>(values[i]);
    return owning<Number>(std::move(numbers), {static_cast<py::ssize_t>(values.size())});
}

} // namespace hsdm::python
