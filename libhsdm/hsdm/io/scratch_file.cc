#include "hsdm/io/scratch_file.hh"

#include "hsdm/errors.hh"
#include "hsdm/io/file_registry.hh"

#include <cerrno>
#include <cstring>
#include <filesystem>

#include <stdlib.h>
#include <unistd.h>

namespace hsdm {

ScratchFile::ScratchFile(const std::string& extension) {
    std::error_code none;
    const std::filesystem::path folder = std::filesystem::temp_directory_path(none);
    path_ = ((none ? "/tmp" : folder) / "hsdm-XXXXXX").string() + extension;
    FileRegistry& registry = FileRegistry::of_process();
    const auto lock = registry.lock(); // a signal finds the file registered, or not made
    const int descriptor = ::mkstemps(path_.data(), static_cast<int>(extension.size()));
    if (descriptor < 0)
        throw Error(path_, std::string("a temporary file cannot be made: ") + std::strerror(errno)
                               + "; TMPDIR names another folder for it");
    ::close(descriptor);
    try {
        registry.add_temporary(path_);
    } catch (...) {
        ::unlink(path_.c_str());
        throw;
    }
}

ScratchFile::~ScratchFile() {
    FileRegistry& registry = FileRegistry::of_process();
    const auto lock = registry.lock();
    ::unlink(path_.c_str());
    registry.drop_temporary(path_);
}

} // namespace hsdm
