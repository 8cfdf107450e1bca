#pragma once
// What is asked of the operating system beyond the standard library. Another system than POSIX needs another
// system.cc (docs/portability.md); nothing else of the library or the command calls it. Processes and how
// they end: system_process.hh.
//
// What fails returns false, -1 or null, with the reason in errno. Descriptors are not inherited by other
// programs.

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>

namespace hsdm::os {

constexpr int standard_input = 0, standard_output = 1, standard_error = 2;

/// What a path or a descriptor stands for.
struct FileStatus {
    enum class Kind { regular, folder, link, pipe, terminal_or_device, block_device, socket };
    Kind kind = Kind::regular;
    bool is_null_device = false;         ///< which swallows everything
    std::uint64_t device = 0, inode = 0; ///< the same for all names of a file
    std::uint64_t size = 0, names = 0;   ///< bytes; hard links
    std::int64_t modified = 0;           ///< nanoseconds since 1970
    std::uint32_t owner = 0, group = 0;
    std::uint32_t mode = 0; ///< 07777: who may read, write and run it, as chmod(1) takes it
};
bool status_of(const std::string& path, FileStatus& status) noexcept;       ///< links are followed
bool status_of_entry(const std::string& path, FileStatus& status) noexcept; ///< a link's own
bool status_of(int descriptor, FileStatus& status) noexcept;

/// Whether this process may, by its effective user.
bool may_read(const std::string& path) noexcept;
bool may_write(const std::string& path) noexcept;
bool may_write_into(const std::string& folder) noexcept;

/// Each name in a folder but `.` and `..`; none where it cannot be read. (std::filesystem's iterator ends the
/// process if there is no memory for the next name.)
void for_each_name(const std::string& folder, const std::function<void(const char*)>& act);

int open_to_read(const std::string& path) noexcept;
int open_to_write(const std::string& path) noexcept; ///< as it is; waits for a pipe's reader
/// No link, and without waiting for a pipe's reader.
int open_entry_to_write(const std::string& path) noexcept;
/// Reading, and writing at the end. No link.
int open_to_append(const std::string& path) noexcept;
/// Reading and writing; fails if there is something of that name. `mode` as in FileStatus, less the umask.
int create(const std::string& path, std::uint32_t mode) noexcept;
/// The same, this user's alone; XXXXXX before the extension become letters that make the name a new one.
int create_with_new_name(std::string& pattern, std::size_t extension_length) noexcept;
int duplicate(int descriptor) noexcept;
void close(int descriptor) noexcept;
bool is_open_for_writing(int descriptor) noexcept;
/// Whether the names in a folder, which is no link, are the numbers of this process's descriptors.
bool is_folder_of_descriptors(const std::string& folder);

/// At most so many bytes; 0 at the end. EINTR: again.
std::ptrdiff_t read(int descriptor, char* bytes, std::size_t count) noexcept;
std::ptrdiff_t read_at(int descriptor, char* bytes, std::size_t count, std::uint64_t offset) noexcept;
/// All that is asked for, in as many turns as that takes; less only at the end.
std::ptrdiff_t read_all(int descriptor, char* bytes, std::size_t count) noexcept;
std::ptrdiff_t read_all_at(int descriptor, char* bytes, std::size_t count, std::uint64_t offset) noexcept;
std::ptrdiff_t write(int descriptor, const char* bytes, std::size_t count) noexcept;
/// All of the bytes, in as many turns as that takes.
bool write_all(int descriptor, std::string_view bytes) noexcept;
bool write_all_at(int descriptor, std::string_view bytes, std::uint64_t offset) noexcept;
bool flush_to_disk(int descriptor) noexcept;
bool resize(int descriptor, std::uint64_t size) noexcept;
/// Sets space aside, without a change of size. Done where the file system cannot.
bool reserve(int descriptor, std::uint64_t size) noexcept;
bool set_owner(int descriptor, std::uint32_t owner, std::uint32_t group) noexcept;
bool set_group(int descriptor, std::uint32_t group) noexcept;
bool set_mode(int descriptor, std::uint32_t mode) noexcept;

bool replace(const std::string& from, const std::string& to) noexcept; ///< at once, whatever was at `to`
bool remove(const std::string& path) noexcept;                         ///< also in a handler of signals
bool make_folder(const std::string& path) noexcept;                    ///< this user's alone
bool remove_folder(const std::string& path) noexcept;                  ///< an empty one

/// Until the descriptor is closed, also by the process's end; EINTR: again. try_lock does not wait.
bool lock(int descriptor) noexcept;
bool try_lock(int descriptor) noexcept;

std::int64_t process_id() noexcept;
std::string host_name(); ///< of the machine; empty if that cannot be told
std::uint32_t effective_user() noexcept;
bool is_terminal(int descriptor) noexcept;
/// Of the whole process so far, in bytes.
std::size_t peak_memory() noexcept;
/// Null where the process has rights of another user than who started it.
const char* trusted_variable(const char* name) noexcept;
/// Advice to the allocator of the whole process: memory that is freed stays, to be given out again. Pages
/// that went back to the system would be cleared when they come again. Not so for the largest blocks, which
/// could not share what is kept. To be called by programs, before there are threads.
void keep_freed_memory() noexcept;
/// The opposite, once: all pages that hold nothing go back to the system, for work that has to keep a bound.
void give_back_freed_memory() noexcept;
/// Only advice, on whole pages in the block.
void advise_huge_pages(void* memory, std::size_t bytes) noexcept;

/// Stays loaded. Its names serve nobody else.
void* load_library(const std::string& path) noexcept;
void* symbol_of(void* library, const char* name) noexcept;
/// Why one of the two gave null.
std::string library_error();

} // namespace hsdm::os
