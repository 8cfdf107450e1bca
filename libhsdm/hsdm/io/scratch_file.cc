#include "hsdm/io/scratch_file.hh"

#include "hsdm/core/system.hh"
#include "hsdm/errors.hh"
#include "hsdm/io/file_registry.hh"

#include <cerrno>
#include <cstring>
#include <filesystem>

namespace hsdm {

std::string temporary_folder() {
    std::error_code none;
    const std::filesystem::path folder = std::filesystem::temp_directory_path(none);
    return none ? "/tmp" : folder.string();
}

ScratchFile::ScratchFile(const std::string& extension) {
    path_ = (std::filesystem::path(temporary_folder()) / "hsdm-XXXXXX").string() + extension;
    FileRegistry& registry = FileRegistry::of_process();
    const auto lock = registry.lock(); // a signal finds the file registered, or not made
    const int descriptor = os::create_with_new_name(path_, extension.size());
    if (descriptor < 0)
        throw Error(path_, std::string("a temporary file cannot be made: ") + std::strerror(errno)
                               + "; TMPDIR names another folder for it");
    os::close(descriptor);
    try {
        registry.add_temporary(path_);
    } catch (...) {
        os::remove(path_);
        throw;
    }
}

ScratchFile::~ScratchFile() {
    FileRegistry& registry = FileRegistry::of_process();
    const auto lock = registry.lock();
    os::remove(path_);
    registry.drop_temporary(path_);
}

} // namespace hsdm
