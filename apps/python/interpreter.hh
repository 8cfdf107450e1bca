#pragma once
// What Python has to say while the library works without the interpreter's lock: signals, the caller's
// progress, and the exceptions that either raises.

#include "hsdm/core/interruption.hh"
#include "hsdm/errors.hh"

#include <pybind11/pybind11.h>

#include <optional>
#include <string>

namespace hsdm::python {

namespace py = pybind11;

/// Asks Python now and then whether the work goes on; to be made and destroyed with the lock held.
class Watch {
public:
    /// `progress` is None or a callable of a phase and a share. Throws RuntimeError if this thread is in such
    /// a callable already: a reconstruction must not start another one.
    explicit Watch(py::object progress = py::none());

    /// Whether there is anybody to ask: a callable, or signals, which Python gives to its main thread alone.
    bool is_needed() const { return listens_; }
    /// Takes the lock. False if a signal's handler or the callable raised, which run() passes on then, or the
    /// callable returned something false that is not None.
    bool goes_on(const char* phase, double done);

    /// Calls `work` without the lock. An exception that goes_on() met takes the place of Cancelled.
    template <class Work>
    auto run(const Work& work) {
        try {
            const py::gil_scoped_release released;
            return work();
        } catch (const Cancelled&) {
            if (failure_) throw *failure_;
            throw;
        }
    }

private:
    py::object progress_;
    bool listens_ = false;
    std::optional<py::error_already_set> failure_;
};

/// Calls `work` without the lock; what it does in parallel a signal ends.
template <class Work>
auto run_interruptibly(const Work& work) {
    Watch watch;
    return watch.run([&] {
        const Interruption asking([&] { return !watch.is_needed() || watch.goes_on("", 0); });
        return work();
    });
}

/// Text that may hold the bytes of names of files, which need not be UTF-8: these become what os.fsdecode()
/// makes of them, and os.fsencode() undoes.
py::str text_of(const std::string& bytes);

/// An Error of a file that is read or written.
class FileError : public Error {
public:
    FileError(const std::string& message, std::string path) : Error(message), path_(std::move(path)) {}
    const std::string& path() const { return path_; } ///< as it was given

private:
    std::string path_;
};

/// Calls `work`; its Errors are of that file.
template <class Work>
auto on_file(const std::string& path, const Work& work) {
    try {
        return work();
    } catch (const Error& error) {
        throw FileError(error.what(), path);
    }
}

/// From now on the library's exceptions become those of hsdm/_errors.py.
void translate_errors();

} // namespace hsdm::python
