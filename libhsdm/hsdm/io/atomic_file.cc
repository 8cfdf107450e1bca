#include "hsdm/io/atomic_file.hh"

#include "hsdm/errors.hh"

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstring>
#include <filesystem>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

namespace hsdm {
namespace {

constexpr std::size_t longest_name = 200; // the temporary's suffix must fit into the 255 bytes of a name

/// A name beside the target that no other process or thread uses.
std::string temporary_name(const std::filesystem::path& target) {
    static std::atomic<unsigned> counter{0}; // distinguishes threads; no result depends on it
    std::string name = target.filename().string();
    if (name.size() > longest_name) name.resize(longest_name);
    name = '.' + name + '.' + std::to_string(::getpid()) + '-' + std::to_string(counter++) + ".tmp";
    return (target.parent_path() / name).string();
}

std::string advice(int error) {
    switch (error) {
    case ENOENT:
        return "; create the folder first";
    case EACCES:
    case EPERM:
    case EROFS:
        return "; choose a folder you may write to";
    case ENOSPC:
    case EDQUOT:
        return "; free some space and run again";
    default:
        return "";
    }
}

} // namespace

void AtomicFile::fail(const std::string& what) const {
    const int error = errno;
    throw Error(path_ == "-" ? "standard output" : path_, what + ": " + std::strerror(error) + advice(error));
}

AtomicFile::AtomicFile(const std::string& path) : path_(path), target_(path) {
    if (path.empty()) throw Error("(no name)", "cannot write without a file name; name the output file");
    if (path == "-") {
        descriptor_ = STDOUT_FILENO;
        return;
    }
    std::error_code ignored;
    if (std::filesystem::is_symlink(path, ignored)) {
        const auto followed = std::filesystem::weakly_canonical(path, ignored);
        if (!ignored) target_ = followed.string();
    }
    struct stat status {};
    const bool exists = ::stat(target_.c_str(), &status) == 0;
    if (exists && S_ISDIR(status.st_mode))
        throw Error(path_, "cannot write: is a folder; name a file inside it");
    if (exists && !S_ISREG(status.st_mode)) {
        descriptor_ = ::open(target_.c_str(), O_WRONLY | O_CLOEXEC);
        if (descriptor_ < 0) fail("cannot open for writing");
        return;
    }
    do {
        temporary_ = temporary_name(target_);
        descriptor_ = ::open(temporary_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    } while (descriptor_ < 0 && errno == EEXIST);
    if (descriptor_ < 0) {
        temporary_.clear();
        fail("cannot write");
    }
}

AtomicFile::~AtomicFile() {
    if (descriptor_ >= 0 && descriptor_ != STDOUT_FILENO) ::close(descriptor_);
    if (!temporary_.empty()) ::unlink(temporary_.c_str());
}

void AtomicFile::write(std::string_view bytes) {
    while (!bytes.empty()) {
        const ssize_t written =
            ::write(descriptor_, bytes.data(), std::min(bytes.size(), std::size_t{1} << 30));
        if (written < 0 && errno == EINTR) continue;
        if (written < 0) fail("cannot write");
        bytes.remove_prefix(static_cast<std::size_t>(written));
    }
}

void AtomicFile::commit() {
    if (temporary_.empty()) return;
    if (::fsync(descriptor_) != 0) fail("cannot write");
    const int closed = ::close(descriptor_);
    descriptor_ = -1;
    if (closed != 0) fail("cannot write");
    if (::rename(temporary_.c_str(), target_.c_str()) != 0) fail("cannot put the new file in place");
    temporary_.clear();
}

} // namespace hsdm
