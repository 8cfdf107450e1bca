#pragma once
// What a long job has done so far, on disk, so that another process can go on where one has ended.

#include "hsdm/io/scratch_bytes.hh"

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace hsdm {

/// A folder with the files of one job and a log of what is done. It stays however the process ends, until
/// remove(). One process at a time. Not for several threads.
class KeptScratch {
public:
    using Bytes = std::vector<char>;
    /// What tells a job from others, e.g. "depth" and "11".
    struct Trait {
        std::string name, value;
        friend bool operator==(const Trait&, const Trait&) = default;
    };
    /// What was done, in order; `key` says what it is of.
    struct Record {
        std::uint64_t key;
        std::size_t at, size; ///< of its bytes in the log
    };

    /// Makes the folder `hsdm-resume-PROCESS` in this one, or takes over what is there; a record that was
    /// not written to its end does not count. Throws Error if another process works there, if it is of a job
    /// with other traits, of which it tells the first one, or if it cannot be made or read.
    KeptScratch(const std::string& folder, int process, const std::vector<Trait>& job);
    ~KeptScratch();
    KeptScratch(const KeptScratch&) = delete;
    KeptScratch& operator=(const KeptScratch&) = delete;

    static std::string name_of(int process); ///< of its folder in this one
    /// The processes that something in this folder was kept for, in order.
    static std::vector<int> processes_in(const std::string& folder);
    /// Is there something that was kept for this process?
    static bool is_there(const std::string& folder, int process);

    const std::string& folder() const { return folder_; }
    const std::vector<Record>& records() const { return records_; }
    Bytes read(const Record& record) const; ///< throws Error if the log cannot be read

    /// Adds a record; returns once the disk has it. Throws Error if it is full.
    void keep(std::uint64_t key, const Bytes& bytes);
    /// Forgets all records but the first ones.
    void cut(std::size_t count);

    /// A file of the folder that there has not been yet: `NAME-NUMBER`.
    std::string new_name(const std::string& name);
    /// So many, or more. Throws Error if that cannot be told.
    bool has_file(const std::string& name, std::size_t bytes) const;
    void remove_file(const std::string& name) const;
    /// Removes all files but the log and these.
    void remove_all_but(std::span<const std::string> names) const;
    /// The job is done: nothing is left.
    void remove();

private:
    std::string path_of(const std::string& name) const { return folder_ + "/" + name; }
    bool open();
    void read_log(const std::vector<Trait>& job);
    [[noreturn]] void refuse(const std::vector<Trait>& kept, const std::vector<Trait>& job) const;
    void append(const Bytes& bytes);
    void begin(const std::vector<Trait>& job);

    std::string folder_;
    int log_ = -1;
    std::size_t end_ = 0; // of the log
    std::vector<Record> records_;
    std::size_t names_ = 0;
};

} // namespace hsdm
