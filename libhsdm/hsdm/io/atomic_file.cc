#include "hsdm/io/atomic_file.hh"

#include "hsdm/core/system.hh"
#include "hsdm/errors.hh"
#include "hsdm/io/file_registry.hh"
#include "hsdm/io/temporary_file.hh"

#include <array>
#include <cerrno>
#include <cstring>
#include <utility>

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

/// Copies all of one file over the content of another, from its first byte; false with errno on failure.
bool overwrite(int from, int to, std::uint64_t size) {
    std::array<char, 1 << 16> buffer;
    for (std::uint64_t done = 0; done < size;) {
        const std::ptrdiff_t count = os::read_at(from, buffer.data(), buffer.size(), done);
        if (count < 0 && errno == EINTR) continue;
        if (count == 0) errno = EIO; // another process truncated it meanwhile
        if (count <= 0 || !os::write_all(to, {buffer.data(), static_cast<std::size_t>(count)})) return false;
        done += static_cast<std::uint64_t>(count);
    }
    return os::resize(to, size) && os::flush_to_disk(to);
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
        if (descriptor_ >= 0) os::close(descriptor_);
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
    os::FileStatus old;
    const bool exists = os::status_of(target_.path, old);
    TemporaryFile made = make_temporary(target_.path, exists ? 0600 : 0666);
    if (made.path.empty()) fail("cannot write");
    temporary_ = std::move(made.path);
    descriptor_ = made.descriptor;
    if (exists) take_over_mode(old);
}

void AtomicFile::open_directly() {
    descriptor_ = target_.kind == OutputTarget::Kind::descriptor ? os::duplicate(target_.descriptor)
                                                                 : os::open_to_write(target_.path);
    if (descriptor_ < 0) fail("cannot open for writing");
    FileRegistry& registry = FileRegistry::of_process();
    const auto lock = registry.lock();
    registry.begin_stream(spoken_name(path_));
}

/// Sets owner and mode of the file to be replaced before the first byte is readable. Only some users may give
/// files away, and not every file system has modes; then the temporary stays this user's alone, or with the
/// modes it has.
void AtomicFile::take_over_mode(const os::FileStatus& old) const {
    os::FileStatus made;
    if (os::status_of(descriptor_, made) && (old.owner != made.owner || old.group != made.group)
        && !os::set_owner(descriptor_, old.owner, old.group))
        os::set_group(descriptor_, old.group);
    os::set_mode(descriptor_, old.mode);
}

AtomicFile::~AtomicFile() {
    forget_temporary(true);
    if (descriptor_ >= 0) os::close(descriptor_);
}

void AtomicFile::forget_temporary(bool unlink) noexcept {
    if (temporary_.empty()) return;
    FileRegistry& registry = FileRegistry::of_process();
    const auto lock = registry.lock();
    if (unlink) os::remove(temporary_);
    registry.drop_temporary(temporary_);
    temporary_.clear();
}

void AtomicFile::write(std::string_view bytes) {
    if (!os::write_all(descriptor_, bytes)) fail("cannot write");
}

void AtomicFile::write_at(std::uint64_t offset, std::string_view bytes) {
    if (!os::write_all_at(descriptor_, bytes, offset)) fail("cannot write");
}

/// Opened anew, which has a network's file system ask how large the file has become.
void AtomicFile::check_size(std::uint64_t bytes) const {
    const int opened = os::open_to_read(temporary_);
    os::FileStatus status;
    const bool is_known = opened >= 0 && os::status_of(opened, status);
    const int error = errno;
    if (opened >= 0) os::close(opened);
    errno = error;
    if (!is_known) fail("cannot be checked");
    if (status.size != bytes)
        throw Error(spoken_name(path_), "has " + std::to_string(status.size) + " bytes, and not the "
                                            + std::to_string(bytes)
                                            + " that all processes have written; do all see one disk?");
}

void AtomicFile::commit() {
    FileRegistry& registry = FileRegistry::of_process();
    if (temporary_.empty()) {
        const auto lock = registry.lock();
        registry.end_stream(spoken_name(path_));
        return;
    }
    if (!os::flush_to_disk(descriptor_)) fail("cannot write");
    os::FileStatus old;
    const bool has_links =
        os::status_of(target_.path, old) && old.kind == os::FileStatus::Kind::regular && old.names > 1;
    // held so that abandon_files() does not remove the temporary from here on
    const auto lock = registry.lock();
    registry.note_complete(path_);
    // The descriptor stays open meanwhile: its lock keeps other processes from removing the temporary.
    if (has_links) {
        copy_into_target();
    } else if (!os::replace(temporary_, target_.path)) {
        registry.take_back_complete(path_);
        fail("cannot put the new file in place");
    }
    registry.drop_temporary(temporary_);
    temporary_.clear();
}

void AtomicFile::copy_into_target() {
    os::FileStatus made;
    const int to = os::open_entry_to_write(target_.path);
    if (to < 0 || !os::status_of(descriptor_, made) || !os::reserve(to, made.size)) {
        const int error = errno;
        if (to >= 0) os::close(to);
        FileRegistry::of_process().take_back_complete(path_);
        errno = error;
        fail("cannot write into the file, which has other names (hard links) too");
    }
    const bool copied = overwrite(descriptor_, to, made.size);
    const int error = errno;
    os::close(to);
    if (copied) {
        os::remove(temporary_);
        return;
    }
    FileRegistry::of_process().take_back_complete(path_);
    FileRegistry::of_process().drop_temporary(temporary_);
    const std::string kept = std::exchange(temporary_, {});
    errno = error;
    fail("has other names (hard links) and was overwritten in part only; its new content is in " + kept);
}

} // namespace hsdm
