#include "hsdm/io/output_target.hh"

#include "hsdm/core/number_of.hh"
#include "hsdm/core/system.hh"
#include "hsdm/errors.hh"

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <optional>

namespace hsdm {
namespace {

namespace fs = std::filesystem;

constexpr int most_links = 40; // as the kernel

std::string last_error() {
    return std::strerror(errno);
}

fs::path folder_of(const fs::path& path) {
    return path.has_parent_path() ? path.parent_path() : fs::path(".");
}

/// N for a path that stands for descriptor N of this process. It looks like a link to what is open there, but
/// names the descriptor itself: a pipe has no other name, and a file must be written on from where it stands.
std::optional<int> own_descriptor(const fs::path& path) {
    std::error_code ignored;
    const std::string folder = fs::canonical(folder_of(path), ignored).string();
    if (!os::is_folder_of_descriptors(folder)) return std::nullopt;
    return number_of<int>(path.filename().string());
}

void check_folder(const std::string& path, const fs::path& folder) {
    std::error_code error;
    const fs::file_status status = fs::status(folder, error);
    if (status.type() == fs::file_type::none)
        throw Error(path, "the folder cannot be looked at: " + error.message() + "; check its permissions");
    if (!fs::is_directory(status)) throw Error(path, "the folder does not exist; make it first");
    if (!os::may_write_into(folder.string()))
        throw Error(path, "the folder cannot be written: " + last_error() + "; check its permissions");
}

} // namespace

OutputTarget find_target(const std::string& path) {
    if (path.empty()) throw Error("(no name)", "cannot write without a file name; name the output file");
    OutputTarget target;
    if (path == "-") return {OutputTarget::Kind::descriptor, "-", os::standard_output};
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
    using Kind = os::FileStatus::Kind;
    os::FileStatus status;
    const bool exists = os::status_of(name.string(), status);
    const bool stream = exists && status.kind != Kind::regular && status.kind != Kind::folder;
    return {stream ? OutputTarget::Kind::stream : OutputTarget::Kind::file, name.string(), -1};
}

void check_replaceable(const std::string& path, const OutputTarget& target) {
    std::error_code ignored;
    if (fs::is_directory(target.path, ignored)) throw Error(path, "is a folder; name a file in it");
    if (fs::exists(target.path, ignored) && !os::may_write(target.path))
        throw Error(path, "is write-protected (" + last_error()
                              + "); choose another name, or allow writing with chmod u+w");
}

void check_writable(const std::string& path) {
    const OutputTarget target = find_target(path);
    if (target.kind == OutputTarget::Kind::descriptor) {
        if (!os::is_open_for_writing(target.descriptor))
            throw Error(spoken_name(path), "is not open for writing; check the redirection");
    } else if (target.kind == OutputTarget::Kind::stream) {
        if (!os::may_write(target.path))
            throw Error(path, "cannot be written: " + last_error() + "; check its permissions");
    } else {
        check_replaceable(path, target);
        check_folder(path, folder_of(target.path));
    }
}

std::string spoken_name(const std::string& path) {
    return path == "-" ? "standard output" : path;
}

} // namespace hsdm
