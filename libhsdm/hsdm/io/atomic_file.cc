#include "hsdm/io/atomic_file.hh"

#include "hsdm/errors.hh"
#include "hsdm/io/file_registry.hh"
#include "hsdm/io/temporary_file.hh"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <utility>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

namespace hsdm {
namespace {

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
    case EFBIG:
        return "; raise the limit (ulimit -f)";
    case EPIPE:
        return "; is the reader still there?";
    default:
        return "";
    }
}

/// False with errno on failure.
bool write_all(int descriptor, std::string_view bytes) {
    while (!bytes.empty()) {
        const ssize_t written =
            ::write(descriptor, bytes.data(), std::min(bytes.size(), std::size_t{1} << 30));
        if (written < 0 && errno == EINTR) continue;
        if (written < 0) return false;
        bytes.remove_prefix(static_cast<std::size_t>(written));
    }
    return true;
}

/// Copies all of one file over the content of another, from its first byte; false with errno on failure.
bool overwrite(int from, int to, off_t size) {
    std::array<char, 1 << 16> buffer;
    for (off_t done = 0; done < size;) {
        const ssize_t count = ::pread(from, buffer.data(), buffer.size(), done);
        if (count < 0 && errno == EINTR) continue;
        if (count == 0) errno = EIO; // another process truncated it meanwhile
        if (count <= 0 || !write_all(to, {buffer.data(), static_cast<std::size_t>(count)})) return false;
        done += count;
    }
    return ::ftruncate(to, size) == 0 && ::fsync(to) == 0;
}

} // namespace

void AtomicFile::fail(const std::string& what) const {
    const int error = errno;
    throw Error(spoken_name(path_), what + ": " + std::strerror(error) + advice(error));
}

AtomicFile::AtomicFile(const std::string& path) : path_(path), target_(find_target(path)) {
    try {
        if (target_.kind == OutputTarget::Kind::file) {
            open_temporary();
        } else {
            open_directly();
        }
    } catch (...) { // a constructor that throws gets no destructor call
        if (descriptor_ >= 0) ::close(descriptor_);
        forget_temporary(true);
        throw;
    }
}

void AtomicFile::open_temporary() {
    check_replaceable(path_, target_);
    FileRegistry& registry = FileRegistry::of_process();
    for (std::string& left : remove_leftovers(target_.path)) {
        const auto lock = registry.lock();
        registry.note_leftover(std::move(left));
    }
    struct stat old {};
    const bool exists = ::stat(target_.path.c_str(), &old) == 0;
    TemporaryFile made = make_temporary(target_.path, exists ? 0600 : 0666);
    if (made.path.empty()) fail("cannot write");
    temporary_ = std::move(made.path);
    descriptor_ = made.descriptor;
    if (exists) take_over_mode(old);
}

void AtomicFile::open_directly() {
    descriptor_ = target_.kind == OutputTarget::Kind::descriptor
                      ? ::fcntl(target_.descriptor, F_DUPFD_CLOEXEC, 3)
                      : ::open(target_.path.c_str(), O_WRONLY | O_NOCTTY | O_CLOEXEC);
    if (descriptor_ < 0) fail("cannot open for writing");
    FileRegistry& registry = FileRegistry::of_process();
    const auto lock = registry.lock();
    registry.begin_stream(spoken_name(path_));
}

/// Sets owner and mode of the file to be replaced before the first byte is readable. Only some users may give
/// files away, and not every file system has modes; then the temporary stays this user's alone, or with the
/// modes it has.
void AtomicFile::take_over_mode(const struct stat& old) const {
    struct stat made {};
    if (::fstat(descriptor_, &made) == 0 && (old.st_uid != made.st_uid || old.st_gid != made.st_gid)) {
        int given = ::fchown(descriptor_, old.st_uid, old.st_gid);
        if (given != 0) given = ::fchown(descriptor_, static_cast<uid_t>(-1), old.st_gid);
    }
    [[maybe_unused]] const int changed = ::fchmod(descriptor_, old.st_mode & 07777);
}

AtomicFile::~AtomicFile() {
    forget_temporary(true);
    if (descriptor_ >= 0) ::close(descriptor_);
}

void AtomicFile::forget_temporary(bool unlink) noexcept {
    if (temporary_.empty()) return;
    FileRegistry& registry = FileRegistry::of_process();
    const auto lock = registry.lock();
    if (unlink) ::unlink(temporary_.c_str());
    registry.drop_temporary(temporary_);
    temporary_.clear();
}

void AtomicFile::write(std::string_view bytes) {
    if (!write_all(descriptor_, bytes)) fail("cannot write");
}

void AtomicFile::commit() {
    FileRegistry& registry = FileRegistry::of_process();
    if (temporary_.empty()) {
        const auto lock = registry.lock();
        registry.end_stream(spoken_name(path_));
        return;
    }
    if (::fsync(descriptor_) != 0) fail("cannot write");
    struct stat old {};
    const bool has_links =
        ::stat(target_.path.c_str(), &old) == 0 && S_ISREG(old.st_mode) && old.st_nlink > 1;
    // held so that abandon_files() does not remove the temporary from here on
    const auto lock = registry.lock();
    registry.note_complete(path_);
    // The descriptor stays open meanwhile: its lock keeps other processes from removing the temporary.
    if (has_links) {
        copy_into_target();
    } else if (::rename(temporary_.c_str(), target_.path.c_str()) != 0) {
        registry.take_back_complete(path_);
        fail("cannot put the new file in place");
    }
    registry.drop_temporary(temporary_);
    temporary_.clear();
}

void AtomicFile::copy_into_target() {
    struct stat made {};
    const int to = ::open(target_.path.c_str(), O_WRONLY | O_NOFOLLOW | O_CLOEXEC);
    if (to < 0 || ::fstat(descriptor_, &made) != 0
        || (made.st_size > 0 && ::fallocate(to, FALLOC_FL_KEEP_SIZE, 0, made.st_size) != 0
            && errno != EOPNOTSUPP)) {
        const int error = errno;
        if (to >= 0) ::close(to);
        FileRegistry::of_process().take_back_complete(path_);
        errno = error;
        fail("cannot write into the file, which has other names (hard links) too");
    }
    const bool copied = overwrite(descriptor_, to, made.st_size);
    const int error = errno;
    ::close(to);
    if (copied) {
        ::unlink(temporary_.c_str());
        return;
    }
    FileRegistry::of_process().take_back_complete(path_);
    FileRegistry::of_process().drop_temporary(temporary_);
    const std::string kept = std::exchange(temporary_, {});
    errno = error;
    fail("has other names (hard links) and was overwritten in part only; its new content is in " + kept);
}

} // namespace hsdm
