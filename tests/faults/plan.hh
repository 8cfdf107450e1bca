#pragma once
// What the test and the library it loads into the command tell each other, in memory that both map.

#include <atomic>
#include <cerrno>
#include <cstddef>
#include <cstdint>

namespace hsdm::faults {

/// Classes of calls; each is counted for itself.
enum class Kind : int {
    memory, ///< malloc, calloc, realloc, aligned allocation
    map,    ///< mmap: what TBB's own allocator takes its memory from
    open,   ///< open, openat, fopen, opendir
    read,
    write,
    sync,  ///< fsync, fdatasync
    close, ///< close, fclose; the descriptor is closed all the same, as Linux does it
    rename,
    link,   ///< link, symlink
    folder, ///< mkdir
    remove, ///< unlink, rmdir
    status, ///< stat, lstat, fstat, access, readlink
    mode,   ///< fchmod, chmod, fchown, ftruncate
    lock,   ///< flock
    tell,   ///< standard error
    thread, ///< pthread_create
    count
};

constexpr std::size_t kinds = static_cast<std::size_t>(Kind::count);
constexpr const char* kind_names[kinds] = {"memory", "map",    "open", "read",   "write",  "sync",
                                           "close",  "rename", "link", "folder", "remove", "status",
                                           "mode",   "lock",   "tell", "thread"};

/// As Plan::error: the call is done for half of the bytes asked for, which is no error.
constexpr int partial = -1;

struct Plan {
    // Set before the command is started.
    Kind kind = Kind::count; ///< count: nothing fails
    std::uint64_t at = 0;    ///< which call of the kind fails, from 1
    int error = EIO;         ///< its errno, or `partial`
    bool lasting = false;    ///< all later calls of the kind fail too
    bool tracing = false;    ///< the calls that led to the fault are printed on standard error
    char folder[256] = {};   ///< calls about files outside are neither counted nor failed

    // Set by the library.
    std::atomic<std::uint64_t> calls[kinds] = {};
    std::atomic<bool> hit = false;
    bool after_open = false;                    ///< a file had been opened before the fault
    std::uint64_t memory_calls_before_open = 0; ///< before any file was
    char path[256] = {}; ///< of the file the failing call was about; "-" for a standard stream
};

static_assert(std::atomic<std::uint64_t>::is_always_lock_free, "it is shared between two processes");

/// The environment variable that names the file with the plan.
constexpr const char* plan_variable = "HSDM_FAULT_PLAN";

} // namespace hsdm::faults
