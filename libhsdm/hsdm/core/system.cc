#include "hsdm/core/system.hh"

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <memory>

#include <dirent.h>
#include <dlfcn.h>
#include <fcntl.h>
#include <sys/file.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>
#include <unistd.h>

namespace hsdm::os {
namespace {

using Kind = FileStatus::Kind;

Kind kind_of(mode_t mode) {
    switch (mode & S_IFMT) {
    case S_IFDIR:
        return Kind::folder;
    case S_IFLNK:
        return Kind::link;
    case S_IFIFO:
        return Kind::pipe;
    case S_IFCHR:
        return Kind::terminal_or_device;
    case S_IFBLK:
        return Kind::block_device;
    case S_IFSOCK:
        return Kind::socket;
    default:
        return Kind::regular;
    }
}

bool fill(FileStatus& status, int result, const struct stat& found) {
    if (result != 0) return false;
    status.kind = kind_of(found.st_mode);
    status.is_null_device = S_ISCHR(found.st_mode) && found.st_rdev == makedev(1, 3);
    status.device = found.st_dev;
    status.inode = found.st_ino;
    status.size = static_cast<std::uint64_t>(found.st_size);
    status.names = found.st_nlink;
    status.owner = found.st_uid;
    status.group = found.st_gid;
    status.mode = found.st_mode & 07777;
    return true;
}

bool may(const std::string& path, int what) {
    return ::faccessat(AT_FDCWD, path.c_str(), what, AT_EACCESS) == 0;
}

} // namespace

bool status_of(const std::string& path, FileStatus& status) noexcept {
    struct stat found {};
    return fill(status, ::stat(path.c_str(), &found), found);
}

bool status_of_entry(const std::string& path, FileStatus& status) noexcept {
    struct stat found {};
    return fill(status, ::lstat(path.c_str(), &found), found);
}

bool status_of(int descriptor, FileStatus& status) noexcept {
    struct stat found {};
    return fill(status, ::fstat(descriptor, &found), found);
}

bool may_read(const std::string& path) noexcept {
    return may(path, R_OK);
}

bool may_write(const std::string& path) noexcept {
    return may(path, W_OK);
}

bool may_write_into(const std::string& folder) noexcept {
    return may(folder, W_OK | X_OK);
}

void for_each_name(const std::string& folder, const std::function<void(const char*)>& act) {
    const auto close = [](DIR* open) { ::closedir(open); };
    const std::unique_ptr<DIR, decltype(close)> names(::opendir(folder.c_str()), close);
    while (const dirent* const entry = names ? ::readdir(names.get()) : nullptr)
        if (std::strcmp(entry->d_name, ".") != 0 && std::strcmp(entry->d_name, "..") != 0) act(entry->d_name);
}

int open_to_read(const std::string& path) noexcept {
    return ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
}

int open_to_write(const std::string& path) noexcept {
    return ::open(path.c_str(), O_WRONLY | O_NOCTTY | O_CLOEXEC);
}

int open_entry_to_write(const std::string& path) noexcept {
    return ::open(path.c_str(), O_WRONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
}

int create(const std::string& path, std::uint32_t mode) noexcept {
    return ::open(path.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, mode);
}

int create_with_new_name(std::string& pattern, std::size_t extension_length) noexcept {
    return ::mkostemps(pattern.data(), static_cast<int>(extension_length), O_CLOEXEC);
}

int duplicate(int descriptor) noexcept {
    return ::fcntl(descriptor, F_DUPFD_CLOEXEC, 3);
}

void close(int descriptor) noexcept {
    ::close(descriptor);
}

bool is_open_for_writing(int descriptor) noexcept {
    const int mode = ::fcntl(descriptor, F_GETFL);
    return mode >= 0 && (mode & O_ACCMODE) != O_RDONLY;
}

std::ptrdiff_t read(int descriptor, char* bytes, std::size_t count) noexcept {
    return ::read(descriptor, bytes, count);
}

std::ptrdiff_t read_at(int descriptor, char* bytes, std::size_t count, std::uint64_t offset) noexcept {
    return ::pread(descriptor, bytes, count, static_cast<off_t>(offset));
}

std::ptrdiff_t write(int descriptor, const char* bytes, std::size_t count) noexcept {
    return ::write(descriptor, bytes, count);
}

bool flush_to_disk(int descriptor) noexcept {
    return ::fsync(descriptor) == 0;
}

bool resize(int descriptor, std::uint64_t size) noexcept {
    return ::ftruncate(descriptor, static_cast<off_t>(size)) == 0;
}

bool reserve(int descriptor, std::uint64_t size) noexcept {
    return size == 0 || ::fallocate(descriptor, FALLOC_FL_KEEP_SIZE, 0, static_cast<off_t>(size)) == 0
           || errno == EOPNOTSUPP;
}

bool set_owner(int descriptor, std::uint32_t owner, std::uint32_t group) noexcept {
    return ::fchown(descriptor, owner, group) == 0;
}

bool set_group(int descriptor, std::uint32_t group) noexcept {
    return ::fchown(descriptor, static_cast<uid_t>(-1), group) == 0;
}

bool set_mode(int descriptor, std::uint32_t mode) noexcept {
    return ::fchmod(descriptor, mode) == 0;
}

bool replace(const std::string& from, const std::string& to) noexcept {
    return ::rename(from.c_str(), to.c_str()) == 0;
}

bool remove(const std::string& path) noexcept {
    return ::unlink(path.c_str()) == 0;
}

bool lock(int descriptor) noexcept {
    return ::flock(descriptor, LOCK_EX) == 0;
}

bool try_lock(int descriptor) noexcept {
    return ::flock(descriptor, LOCK_EX | LOCK_NB) == 0;
}

std::int64_t process_id() noexcept {
    return ::getpid();
}

std::uint32_t effective_user() noexcept {
    return ::geteuid();
}

bool is_terminal(int descriptor) noexcept {
    return ::isatty(descriptor) == 1;
}

std::size_t peak_memory() noexcept {
    rusage usage = {};
    ::getrusage(RUSAGE_SELF, &usage);
    return static_cast<std::size_t>(usage.ru_maxrss) * 1024; // the kernel counts in KiB
}

const char* trusted_variable(const char* name) noexcept {
    return ::secure_getenv(name);
}

void advise_huge_pages(void* memory, std::size_t bytes) noexcept {
    ::madvise(memory, bytes, MADV_HUGEPAGE);
}

void* load_library(const std::string& path) noexcept {
    return ::dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL | RTLD_NODELETE);
}

void* symbol_of(void* library, const char* name) noexcept {
    return ::dlsym(library, name);
}

std::string library_error() {
    const char* const text = ::dlerror();
    return text == nullptr ? "unknown reason" : text;
}

} // namespace hsdm::os
