#pragma once
// The state of this process's AtomicFiles, for a program that is ended by a signal: it must leave nothing
// half written and say what was finished.

#include <cstddef>
#include <mutex>
#include <string>
#include <vector>

namespace hsdm {

struct FilesWritten {
    static constexpr std::size_t most_names = 16; ///< a limit, because a program may write files without end
    std::vector<std::string> complete; ///< the first of them, by the names they were given, in order
    std::size_t complete_count = 0;
    std::vector<std::string> in_part; ///< streams that were begun, not ended: what they took is gone
};

/// Removes every temporary of this process, for good: from now on each AtomicFile that is made or committed
/// waits for ever, so what is returned stays true. The caller must end the process at once. It allocates
/// nothing. A file with several hard links, which is being overwritten, is waited for.
const FilesWritten& abandon_files() noexcept;

/// Removes every temporary of this process unless one is being made or put in place. For a handler of
/// crashes: it neither waits nor allocates. The caller must end the process at once.
void remove_temporaries_unless_locked() noexcept;

/// The temporaries of killed runs that were removed (see AtomicFile); each is returned once.
std::vector<std::string> take_removed_leftovers();

/// The registry that AtomicFile keeps. All functions but lock() must be called with the lock held.
class FileRegistry {
public:
    /// Never destroyed: threads may outlive main().
    static FileRegistry& of_process();

    std::unique_lock<std::mutex> lock() { return std::unique_lock(mutex_); }
    void add_temporary(const std::string& path) { temporaries_.push_back(path); }
    void drop_temporary(const std::string& path) noexcept;
    void begin_stream(const std::string& name);
    void end_stream(const std::string& name);
    /// To be called before the file is put in place, since it may throw; take_back_complete() where that
    /// fails. A file that is to be removed in the end, such as a ScratchFile, is none that stands.
    void note_complete(const std::string& name);
    void take_back_complete(const std::string& name) noexcept;
    void note_leftover(std::string path) { leftovers_.push_back(std::move(path)); }

private:
    friend const FilesWritten& abandon_files() noexcept;
    friend void remove_temporaries_unless_locked() noexcept;
    friend std::vector<std::string> take_removed_leftovers();

    bool is_temporary(const std::string& name) const noexcept;

    std::mutex mutex_;
    std::vector<std::string> temporaries_, leftovers_;
    FilesWritten written_;
};

} // namespace hsdm
