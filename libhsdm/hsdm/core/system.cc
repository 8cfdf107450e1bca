#include "hsdm/core/system.hh"

#include "hsdm/core/system_process.hh"

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <memory>
#include <system_error>
#include <thread>
#include <utility>

#include <dirent.h>
#include <dlfcn.h>
#include <fcntl.h>
#include <poll.h>
#include <pthread.h>
#include <spawn.h>
#include <sys/file.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>
#include <sys/wait.h>
#include <unistd.h>
#ifdef __GLIBC__
#include <malloc.h>
#endif

extern char** environ; // NOLINT: POSIX has it in no header

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
    status.modified = std::int64_t{found.st_mtim.tv_sec} * 1000000000 + found.st_mtim.tv_nsec;
    status.owner = found.st_uid;
    status.group = found.st_gid;
    status.mode = found.st_mode & 07777;
    return true;
}

bool may(const std::string& path, int what) {
    return ::faccessat(AT_FDCWD, path.c_str(), what, AT_EACCESS) == 0;
}

/// This program's file: by its name, which tools that run it see through; by the link itself if it was
/// replaced.
std::string this_program() {
    const std::string link = "/proc/self/exe";
    std::error_code error;
    const std::filesystem::path file = std::filesystem::read_symlink(link, error);
    return !error && std::filesystem::exists(file, error) ? file.string() : link;
}

/// What posix_spawn() is asked for, freed in the end. The first error is kept.
class Spawn {
public:
    Spawn() {
        error_ = ::posix_spawn_file_actions_init(&actions_);
        has_actions_ = error_ == 0;
        note(::posix_spawnattr_init(&attributes_));
        has_attributes_ = error_ == 0;
    }
    ~Spawn() {
        if (has_actions_) ::posix_spawn_file_actions_destroy(&actions_);
        if (has_attributes_) ::posix_spawnattr_destroy(&attributes_);
    }
    Spawn(const Spawn&) = delete;
    Spawn& operator=(const Spawn&) = delete;

    /// A process group of its own, and no signal blocked.
    void apart() {
        if (error_ != 0) return;
        sigset_t none;
        sigemptyset(&none);
        note(::posix_spawnattr_setsigmask(&attributes_, &none));
        note(::posix_spawnattr_setpgroup(&attributes_, 0));
        note(::posix_spawnattr_setflags(&attributes_, POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETPGROUP));
    }
    /// A descriptor copied onto itself is one that the new program keeps.
    void copy(int from, int to) {
        if (error_ == 0) note(::posix_spawn_file_actions_adddup2(&actions_, from, to));
    }
    /// The new process, or -1 with errno.
    pid_t start(const std::string& file, char* const* arguments) {
        pid_t child = -1;
        if (error_ == 0)
            note(::posix_spawn(&child, file.c_str(), &actions_, &attributes_, arguments, environ));
        errno = error_;
        return error_ == 0 ? child : -1;
    }

private:
    void note(int error) {
        if (error_ == 0) error_ = error;
    }

    posix_spawn_file_actions_t actions_;
    posix_spawnattr_t attributes_;
    int error_ = 0;
    bool has_actions_ = false, has_attributes_ = false;
};

bool is_ignored(int signal) {
    struct sigaction action {};
    return ::sigaction(signal, nullptr, &action) == 0 && action.sa_handler == SIG_IGN;
}

struct Crash {
    int signal;
    const char* name;
};
constexpr std::array<Crash, 5> crashes{{{SIGSEGV, "segmentation fault"},
                                        {SIGBUS, "bus error"},
                                        {SIGFPE, "arithmetic exception"},
                                        {SIGILL, "illegal instruction"},
                                        {SIGABRT, "abort"}}};

// A handler of signals finds all it needs here.
bool (*tell_crash)(const char*) = nullptr;
std::array<struct sigaction, crashes.size()> actions_before;
stack_t stack_before;
alignas(16) std::array<char, 1 << 16> stack_of_handlers;

void on_crash(int signal) {
    const auto found = std::find_if(crashes.begin(), crashes.end(),
                                    [=](const Crash& crash) { return crash.signal == signal; });
    if (!tell_crash(found == crashes.end() ? "signal" : found->name))
        for (;;) ::pause();
    struct sigaction action {};
    action.sa_handler = SIG_DFL;
    ::sigaction(signal, &action, nullptr);
    ::raise(signal); // is delivered when this handler has returned
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

int open_to_append(const std::string& path) noexcept {
    return ::open(path.c_str(), O_RDWR | O_APPEND | O_NOFOLLOW | O_CLOEXEC);
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

bool is_folder_of_descriptors(const std::string& folder) {
    return folder == "/proc/" + std::to_string(::getpid()) + "/fd";
}

std::ptrdiff_t read(int descriptor, char* bytes, std::size_t count) noexcept {
    return ::read(descriptor, bytes, count);
}

std::ptrdiff_t read_at(int descriptor, char* bytes, std::size_t count, std::uint64_t offset) noexcept {
    return ::pread(descriptor, bytes, count, static_cast<off_t>(offset));
}

namespace {

/// read(bytes, count, done) until `count` bytes are there or it gives none.
template <class Read>
std::ptrdiff_t read_in_turns(char* bytes, std::size_t count, const Read& read) noexcept {
    std::size_t done = 0;
    while (done < count) {
        const std::ptrdiff_t n = read(bytes + done, count - done, done);
        if (n < 0 && errno == EINTR) continue;
        if (n < 0) return -1;
        if (n == 0) break;
        done += static_cast<std::size_t>(n);
    }
    return static_cast<std::ptrdiff_t>(done);
}

} // namespace

std::ptrdiff_t read_all(int descriptor, char* bytes, std::size_t count) noexcept {
    return read_in_turns(bytes, count, [&](char* to, std::size_t size, std::size_t) {
        return os::read(descriptor, to, size);
    });
}

std::ptrdiff_t read_all_at(int descriptor, char* bytes, std::size_t count, std::uint64_t offset) noexcept {
    return read_in_turns(bytes, count, [&](char* to, std::size_t size, std::size_t done) {
        return os::read_at(descriptor, to, size, offset + done);
    });
}

std::ptrdiff_t write(int descriptor, const char* bytes, std::size_t count) noexcept {
    return ::write(descriptor, bytes, count);
}

bool write_all(int descriptor, std::string_view bytes) noexcept {
    while (!bytes.empty()) {
        const ssize_t count = ::write(descriptor, bytes.data(), std::min(bytes.size(), std::size_t{1} << 30));
        if (count < 0 && errno == EINTR) continue;
        if (count == 0) errno = EIO; // what takes nothing would be asked for ever
        if (count <= 0) return false;
        bytes.remove_prefix(static_cast<std::size_t>(count));
    }
    return true;
}

bool write_all_at(int descriptor, std::string_view bytes, std::uint64_t offset) noexcept {
    while (!bytes.empty()) {
        const ssize_t count = ::pwrite(descriptor, bytes.data(), std::min(bytes.size(), std::size_t{1} << 30),
                                       static_cast<off_t>(offset));
        if (count < 0 && errno == EINTR) continue;
        if (count == 0) errno = EIO;
        if (count <= 0) return false;
        bytes.remove_prefix(static_cast<std::size_t>(count));
        offset += static_cast<std::uint64_t>(count);
    }
    return true;
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

bool make_folder(const std::string& path) noexcept {
    return ::mkdir(path.c_str(), 0700) == 0;
}

bool remove_folder(const std::string& path) noexcept {
    return ::rmdir(path.c_str()) == 0;
}

bool lock(int descriptor) noexcept {
    return ::flock(descriptor, LOCK_EX) == 0;
}

bool try_lock(int descriptor) noexcept {
    return ::flock(descriptor, LOCK_EX | LOCK_NB) == 0;
}

std::string host_name() {
    char name[256] = {};
    return ::gethostname(name, sizeof name - 1) == 0 ? name : "";
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

void keep_freed_memory() noexcept {
#ifdef __GLIBC__
    constexpr int largest = 1 << 28; // 24 bytes a point of 10 million points
    constexpr int kept = 1 << 30;    // at the end of the heap: little beside such clouds
    ::mallopt(M_MMAP_THRESHOLD, largest);
    ::mallopt(M_TRIM_THRESHOLD, kept);
    ::mallopt(M_ARENA_MAX, 1); // else what chunks' parts held stays with the thread that made them
#endif
}

void give_back_freed_memory() noexcept {
#ifdef __GLIBC__
    // Where another allocator replaces glibc's, the first call sets up glibc's own, which two threads must
    // not do at once: both then count as users of its first heap, and the second of them aborts the process
    // as it ends.
    [[maybe_unused]] static const int first = ::malloc_trim(0);
    ::malloc_trim(0);
#endif
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

bool open_pipe(int& read_end, int& write_end) noexcept {
    int ends[2];
    if (::pipe2(ends, O_CLOEXEC) != 0) return false;
    read_end = ends[0];
    write_end = ends[1];
    return true;
}

std::int64_t ready_to_read(std::span<const int> descriptors, int milliseconds) {
    std::vector<pollfd> ends;
    ends.reserve(descriptors.size());
    for (const int descriptor : descriptors) ends.push_back({descriptor, POLLIN, 0});
    if (::poll(ends.data(), ends.size(), milliseconds) < 0) return -1;
    std::int64_t ready = 0;
    for (std::size_t i = 0; i < ends.size(); ++i)
        if (ends[i].revents != 0) ready |= std::int64_t{1} << i;
    return ready;
}

bool is_ready_to_write(int descriptor, int milliseconds) noexcept {
    pollfd end{descriptor, POLLOUT, 0};
    return ::poll(&end, 1, milliseconds) == 1;
}

bool keep_from_others(int descriptor) noexcept {
    return ::fcntl(descriptor, F_SETFD, FD_CLOEXEC) == 0;
}

std::int64_t start_this_program(const ProcessStart& start) {
    Spawn spawn;
    spawn.apart();
    for (const int descriptor : start.kept) spawn.copy(descriptor, descriptor);
    for (const int stream : {standard_output, standard_error}) spawn.copy(start.printed, stream);
    std::vector<std::string> words = start.words;
    std::vector<char*> arguments;
    arguments.reserve(words.size() + 1);
    for (std::string& word : words) arguments.push_back(word.data());
    arguments.push_back(nullptr);
    return spawn.start(this_program(), arguments.data());
}

ProcessEnd wait_for_end(std::int64_t process) {
    int status = 0;
    while (::waitpid(static_cast<pid_t>(process), &status, 0) < 0 && errno == EINTR) {
    }
    ProcessEnd end;
    if (WIFSIGNALED(status)) {
        const int signal = WTERMSIG(status);
        end.status = 128 + signal;
        end.signal = std::to_string(signal) + " (" + ::strsignal(signal) + ')';
        end.was_killed = signal == SIGKILL;
    } else {
        end.status = WEXITSTATUS(status);
    }
    return end;
}

void set_process_name(const char* name) noexcept {
    ::pthread_setname_np(::pthread_self(), name);
}

void end_at_once(int status) noexcept {
    ::_exit(status); // not std::_Exit, which sanitizers do not see
}

void let_writing_fail() noexcept {
    for (const int signal : {SIGPIPE, SIGXFSZ}) std::signal(signal, SIG_IGN);
}

void on_request_to_end(void (*end)(int status)) {
    sigset_t awaited;
    sigemptyset(&awaited);
    for (const int signal : {SIGINT, SIGQUIT}) sigaddset(&awaited, signal);
    for (const int signal : {SIGTERM, SIGHUP, SIGXCPU})
        if (!is_ignored(signal)) sigaddset(&awaited, signal);
    ::pthread_sigmask(SIG_BLOCK, &awaited, nullptr); // every thread that is started inherits it
    try {
        std::thread([awaited, end] {
            int signal = 0;
            while (sigwait(&awaited, &signal) != 0) {
            }
            end(128 + signal);
        }).detach();
    } catch (const std::system_error&) { // the kernel ends the process as usual
        ::pthread_sigmask(SIG_UNBLOCK, &awaited, nullptr);
    }
}

bool try_lock(std::FILE* stream) noexcept {
    return ::ftrylockfile(stream) == 0;
}

void watch_crashes(bool (*tell)(const char* crash)) noexcept {
    tell_crash = tell;
    stack_t stack{};
    stack.ss_sp = stack_of_handlers.data();
    stack.ss_size = stack_of_handlers.size();
    ::sigaltstack(&stack, &stack_before);
    struct sigaction action {};
    action.sa_handler = on_crash;
    action.sa_flags = SA_ONSTACK;
    sigemptyset(&action.sa_mask);
    for (std::size_t i = 0; i < crashes.size(); ++i)
        ::sigaction(crashes[i].signal, &action, &actions_before[i]);
}

void unwatch_crashes() noexcept {
    for (std::size_t i = 0; i < crashes.size(); ++i)
        ::sigaction(crashes[i].signal, &actions_before[i], nullptr);
    ::sigaltstack(&stack_before, nullptr); // a sanitizer's, or none
}

} // namespace hsdm::os
