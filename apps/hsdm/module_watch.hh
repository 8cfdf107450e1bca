#pragma once
// What is said when a module takes the whole process down with it.

#include <string>

namespace hsdm::command {

/// While one exists, a crash (SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT), also one by a stack that is used up,
/// is told in a line that names the module before it ends the process with its signal as usual; and so is a
/// call of exit(), which ends the process with status 1. Temporary files are removed. One at a time; the
/// thread that makes it has a stack of its own for it meanwhile.
class ModuleWatch {
public:
    /// `where`: the mesh's and the module's name, as messages begin.
    explicit ModuleWatch(const std::string& where);
    ~ModuleWatch();
    ModuleWatch(const ModuleWatch&) = delete;
    ModuleWatch& operator=(const ModuleWatch&) = delete;
};

} // namespace hsdm::command
