#include "hsdm/io/output_target.hh"

#include "hsdm/core/number_of.hh"
#include "hsdm/errors.hh"

#include <filesystem>
#include <optional>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

namespace hsdm {
namespace {

namespace fs = std::filesystem;

constexpr int most_links = 40; // as the kernel

fs::path folder_of(const fs::path& path) {
    return path.has_parent_path() ? path.parent_path() : fs::path(".");
}

/// N for a path /proc/PID/fd/N of this process. It looks like a link to what is open there, but names the
/// descriptor itself: a pipe has no other name, and a file must be written on from where it stands.
std::optional<int> own_descriptor(const fs::path& path) {
    std::error_code ignored;
    const std::string folder = fs::canonical(folder_of(path), ignored).string();
    if (folder != "/proc/" + std::to_string(::getpid()) + "/fd") return std::nullopt;
    return number_of<int>(path.filename().string());
}

void check_folder(const std::string& path, const fs::path& folder) {
    std::error_code error;
    const fs::file_status status = fs::status(folder, error);
    if (status.type() == fs::file_type::none)
        throw Error(path, "the folder cannot be looked at: " + error.message() + "; check its permissions");
    if (!fs::is_directory(status)) throw Error(path, "the folder does not exist; make it first");
    if (::faccessat(AT_FDCWD, folder.c_str(), W_OK | X_OK, AT_EACCESS) != 0)
        throw Error(path, "the folder cannot be written; check its permissions");
}

} // namespace

OutputTarget find_target(const std::string& path) {
    if (path.empty()) throw Error("(no name)", "cannot write without a file name; name the output file");
    OutputTarget target;
    if (path == "-") return {OutputTarget::Kind::descriptor, "-", STDOUT_FILENO};
    fs::path name(path);
    for (int links = 0;; ++links) {
        if (const auto descriptor = own_descriptor(name))
            return {OutputTarget::Kind::descriptor, name.string(), *descriptor};
        std::error_code error;
        if (!fs::is_symlink(fs::symlink_status(name, error))) break;
        const fs::path next = fs::read_symlink(name, error);
        if (error || links == most_links)
            throw Error(path, "the symbolic link cannot be followed; name the file itself");
        name = next.is_absolute() ? next : folder_of(name) / next;
    }
    struct stat status {};
    const bool exists = ::stat(name.c_str(), &status) == 0;
    const bool stream = exists && !S_ISREG(status.st_mode) && !S_ISDIR(status.st_mode);
    return {stream ? OutputTarget::Kind::stream : OutputTarget::Kind::file, name.string(), -1};
}

void check_replaceable(const std::string& path, const OutputTarget& target) {
    std::error_code ignored;
    if (fs::is_directory(target.path, ignored)) throw Error(path, "is a folder; name a file in it");
    if (fs::exists(target.path, ignored) && ::faccessat(AT_FDCWD, target.path.c_str(), W_OK, AT_EACCESS) != 0)
        throw Error(path, "is write-protected; choose another name, or allow writing with chmod u+w");
}

void check_writable(const std::string& path) {
    const OutputTarget target = find_target(path);
    if (target.kind == OutputTarget::Kind::descriptor) {
        const int mode = ::fcntl(target.descriptor, F_GETFL);
        if (mode < 0 || (mode & O_ACCMODE) == O_RDONLY)
            throw Error(spoken_name(path), "is not open for writing; check the redirection");
    } else if (target.kind == OutputTarget::Kind::stream) {
        if (::faccessat(AT_FDCWD, target.path.c_str(), W_OK, AT_EACCESS) != 0)
            throw Error(path, "cannot be written; check its permissions");
    } else {
        check_replaceable(path, target);
        check_folder(path, folder_of(target.path));
    }
}

std::string spoken_name(const std::string& path) {
    return path == "-" ? "standard output" : path;
}

} // namespace hsdm
