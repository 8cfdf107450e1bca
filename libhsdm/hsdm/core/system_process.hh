#pragma once
// What is asked of the operating system about processes: pipes to others that this one starts, and how this
// one ends before its time. Like system.hh, and in system.cc too: what fails returns false or -1, with the
// reason in errno.

#include <cstdint>
#include <cstdio>
#include <span>
#include <string>
#include <vector>

namespace hsdm::os {

/// Two descriptors: what is written to one is read from the other.
bool open_pipe(int& read_end, int& write_end) noexcept;
/// Waits until one of the descriptors, at most 32, has something to read or will never have; negative ones
/// are none. Bit i stands for descriptors[i]; 0 after so many milliseconds, without end if that is negative.
/// EINTR: again.
std::int64_t ready_to_read(std::span<const int> descriptors, int milliseconds);
/// Whether the descriptor takes bytes at once, or will within so many milliseconds.
bool is_ready_to_write(int descriptor, int milliseconds) noexcept;
/// Programs that this process starts from now on do not get the descriptor.
bool keep_from_others(int descriptor) noexcept;

struct ProcessStart {
    std::vector<std::string> words; ///< of its command line; the first is its name
    std::vector<int> kept;          ///< descriptors that it has by the same numbers
    int printed = 2;                ///< what its standard output and standard error are
};
/// The file of this program again, as a new process, which what a terminal sends does not reach. Its id.
std::int64_t start_this_program(const ProcessStart& start);

struct ProcessEnd {
    int status = 0;          ///< what it returned, or 128 + N by signal N
    std::string signal;      ///< the number and name of that signal; empty if it ended by itself
    bool was_killed = false; ///< without a chance to say so, as systems do that are short of memory
};
/// Waits for a process that this one started, once for each.
ProcessEnd wait_for_end(std::int64_t process);

/// What lists of processes call this one, from its first thread; at most 15 bytes.
void set_process_name(const char* name) noexcept;

/// Ends this process as it stands: nothing is flushed, destroyed or called.
[[noreturn]] void end_at_once(int status) noexcept;

/// Writing to a pipe that nobody reads, or beyond the size that files may have, fails from now on, where it
/// would end this process.
void let_writing_fail() noexcept;

/// To be called once, before any thread is started. From then on whatever asks this process to end (SIGINT,
/// SIGTERM, SIGHUP, SIGQUIT, SIGXCPU) has `end` called with the status for it, 128 + the signal, by a thread
/// of its own; `end` does not return. What was ignored stays so (nohup), but for SIGINT and SIGQUIT, which
/// shells ignore for every job in the background. Without room for a thread all stays as it was.
void on_request_to_end(void (*end)(int status));

/// Has this thread alone use a stream from now on, unless another one has it.
bool try_lock(std::FILE* stream) noexcept;

/// Until unwatch_crashes() a crash (SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT), also one by a stack that is
/// used up, has `tell` called with its name before it ends this process as usual. `tell` may not allocate,
/// lock or wait; it returns false if another thread is already about to end the process, for which this one
/// then waits. The calling thread has a stack of its own for it meanwhile. One at a time.
void watch_crashes(bool (*tell)(const char* crash)) noexcept;
void unwatch_crashes() noexcept;

} // namespace hsdm::os
