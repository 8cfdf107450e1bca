#include "interpreter.hh"

#include <new>

namespace hsdm::python {
namespace {

thread_local bool is_in_callable = false;

/// While the caller's callable runs.
class InCallable {
public:
    InCallable() { is_in_callable = true; }
    ~InCallable() { is_in_callable = false; }
    InCallable(const InCallable&) = delete;
    InCallable& operator=(const InCallable&) = delete;
};

bool is_main_thread() {
    const py::module_ threading = py::module_::import("threading");
    return threading.attr("current_thread")().is(threading.attr("main_thread")());
}

bool is_true(const py::object& answer) {
    const int truth = PyObject_IsTrue(answer.ptr());
    if (truth < 0) throw py::error_already_set();
    return truth != 0;
}

py::object error_type(const char* name) {
    return py::module_::import("hsdm._errors").attr(name);
}

void set_error(const char* type, const char* message) {
    PyErr_SetObject(error_type(type).ptr(), text_of(message).ptr());
}

void set_file_error(const FileError& error) {
    const py::object made = error_type("FileError")(text_of(error.what()));
    made.attr("filename") = text_of(error.path());
    PyErr_SetObject(py::type::of(made).ptr(), made.ptr());
}

void translate(std::exception_ptr thrown) {
    try {
        if (thrown) std::rethrow_exception(thrown);
    } catch (const FileError& error) {
        set_file_error(error);
    } catch (const OptionError& error) {
        set_error("OptionError", error.what());
    } catch (const Cancelled& error) {
        set_error("Cancelled", error.what());
    } catch (const Error& error) {
        set_error("CloudError", error.what());
    } catch (const std::bad_alloc&) {
        set_error("OutOfMemory", "out of memory; use a smaller depth, a larger max_error or fewer points");
    }
}

} // namespace

Watch::Watch(py::object progress) : progress_(std::move(progress)) {
    if (is_in_callable)
        throw std::runtime_error("progress called back into hsdm; it may look and cancel, no more");
    listens_ = !progress_.is_none() || is_main_thread();
}

bool Watch::goes_on(const char* phase, double done) {
    const py::gil_scoped_acquire held;
    try {
        if (PyErr_CheckSignals() != 0) throw py::error_already_set();
        if (progress_.is_none()) return true;
        const InCallable inside;
        const py::object answer = progress_(phase, done);
        return answer.is_none() || is_true(answer);
    } catch (py::error_already_set& raised) {
        failure_.emplace(raised);
        return false;
    }
}

py::str text_of(const std::string& bytes) {
    const auto size = static_cast<Py_ssize_t>(bytes.size());
    PyObject* const text = PyUnicode_DecodeFSDefaultAndSize(bytes.data(), size);
    if (!text) throw py::error_already_set();
    return py::reinterpret_steal<py::str>(text);
}

void translate_errors() {
    py::register_exception_translator(translate);
}

} // namespace hsdm::python
