#include "hsdm/io/kept_scratch.hh"

#include "hsdm/core/hash.hh"
#include "hsdm/core/number_of.hh"
#include "hsdm/core/ranks.hh"
#include "hsdm/core/system.hh"
#include "hsdm/errors.hh"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <optional>
#include <string_view>
#include <utility>

namespace hsdm {
namespace {

constexpr const char* log_name = "log";
constexpr const char* folder_name = "hsdm-resume-"; // and the number of the process

/// Before the bytes of each record; that of the first one, which tells the job, has no key.
struct Head {
    std::uint64_t key, size, hash;
};

std::string why() {
    return std::strerror(errno);
}

std::uint64_t hash_of(std::uint64_t key, const KeptScratch::Bytes& bytes) {
    OrderedHash hash;
    hash.add(key), hash.add(std::uint64_t{bytes.size()});
    for (std::size_t at = 0; at < bytes.size(); at += sizeof(std::uint64_t)) {
        std::uint64_t word = 0;
        std::memcpy(&word, bytes.data() + at, std::min(sizeof word, bytes.size() - at));
        hash.add(word);
    }
    return hash.value();
}

KeptScratch::Bytes with_head(std::uint64_t key, const KeptScratch::Bytes& bytes) {
    KeptScratch::Bytes all;
    put(Head{key, bytes.size(), hash_of(key, bytes)}, all);
    append_bytes(bytes.data(), bytes.size(), all);
    return all;
}

KeptScratch::Bytes bytes_of_traits(const std::vector<KeptScratch::Trait>& job) {
    KeptScratch::Bytes bytes;
    for (const KeptScratch::Trait& trait : job) put_text(trait.name, bytes), put_text(trait.value, bytes);
    return bytes;
}

std::vector<KeptScratch::Trait> traits_of(const KeptScratch::Bytes& bytes) {
    std::vector<KeptScratch::Trait> job;
    for (ByteReader reader(bytes); !reader.at_end();) {
        std::string name = reader.take_text();
        job.push_back({std::move(name), reader.take_text()});
    }
    return job;
}

/// Returns false if the file ends before. Throws Error where the disk fails: that is no end, and what comes
/// after it must not be cut off.
bool read_at(int log, std::size_t at, void* bytes, std::size_t count) {
    const std::ptrdiff_t some = os::read_all_at(log, static_cast<char*>(bytes), count, at);
    if (some < 0) throw Error("the log cannot be read: " + why() + "; nothing was changed");
    return static_cast<std::size_t>(some) == count;
}

/// The record that begins there, if it is whole.
std::optional<std::pair<Head, KeptScratch::Bytes>> record_at(int log, std::size_t at, std::size_t end) {
    Head head{};
    if (end - at < sizeof head || !read_at(log, at, &head, sizeof head)) return std::nullopt;
    if (head.size > end - at - sizeof head) return std::nullopt;
    KeptScratch::Bytes bytes(head.size);
    if (!read_at(log, at + sizeof head, bytes.data(), bytes.size())) return std::nullopt;
    if (hash_of(head.key, bytes) != head.hash) return std::nullopt;
    return std::pair(head, std::move(bytes));
}

std::string folder_of(const std::string& folder, int process) {
    return (std::filesystem::path(folder) / KeptScratch::name_of(process)).string();
}

} // namespace

std::string KeptScratch::name_of(int process) {
    return folder_name + std::to_string(process);
}

std::vector<int> KeptScratch::processes_in(const std::string& folder) {
    std::vector<int> processes;
    os::for_each_name(folder.empty() ? "." : folder, [&](const std::string_view name) {
        if (!name.starts_with(folder_name)) return;
        const auto process = number_of<int>(std::string(name.substr(std::strlen(folder_name))));
        if (process && *process >= 0) processes.push_back(*process);
    });
    std::ranges::sort(processes);
    return processes;
}

bool KeptScratch::is_there(const std::string& folder, int process) {
    os::FileStatus status;
    return os::status_of_entry(folder_of(folder, process), status);
}

KeptScratch::KeptScratch(const std::string& folder, int process, const std::vector<Trait>& job)
    : folder_(folder_of(folder, process)) {
    while (!open()) {
    } // until there is none that is just removed
    try {
        read_log(job);
    } catch (...) {
        os::close(log_);
        throw;
    }
}

KeptScratch::~KeptScratch() {
    if (log_ >= 0) os::close(log_);
}

/// Returns false if another process has removed the log meanwhile.
bool KeptScratch::open() {
    if (!os::make_folder(folder_) && errno != EEXIST)
        throw Error(folder_, "cannot be made: " + why() + "; --scratch names another folder");
    os::FileStatus status;
    if (!os::status_of_entry(folder_, status) || status.kind != os::FileStatus::Kind::folder
        || status.owner != os::effective_user())
        throw Error(folder_, "is no folder of this user; --scratch names another one for it");
    const std::string path = path_of(log_name);
    log_ = os::open_to_append(path);
    if (log_ < 0 && errno == ENOENT) {
        const int made = os::create(path, 0600);
        if (made < 0 && (errno == ENOENT || errno == EEXIST)) return false;
        if (made >= 0) os::close(made), log_ = os::open_to_append(path);
        if (log_ < 0 && errno == ENOENT) return false;
    }
    if (log_ < 0) throw Error(path, "cannot be opened: " + why() + "; --scratch names another folder");
    os::FileStatus own, named;
    const bool locked = os::try_lock(log_);
    if (locked && os::status_of(log_, own) && os::status_of_entry(path, named) && own.device == named.device
        && own.inode == named.inode)
        return true;
    os::close(std::exchange(log_, -1));
    if (locked) return false;
    throw Error(folder_, "another process works on what is kept here; --scratch names another folder");
}

void KeptScratch::read_log(const std::vector<Trait>& job) {
    os::FileStatus status;
    if (!os::status_of(log_, status)) throw Error(folder_, "cannot be read: " + why());
    const auto record_from = [&](std::size_t at) {
        try {
            return record_at(log_, at, status.size);
        } catch (const Error& error) {
            throw Error(folder_, error.what());
        }
    };
    const auto first = record_from(0);
    if (!first) return begin(job);
    const std::vector<Trait> kept = traits_of(first->second);
    if (kept != job) refuse(kept, job);
    end_ = sizeof(Head) + first->second.size();
    while (const auto next = record_from(end_)) {
        records_.push_back({next->first.key, end_ + sizeof(Head), next->second.size()});
        end_ = records_.back().at + records_.back().size;
    }
    cut(records_.size());
    os::for_each_name(folder_, [&](const char* name) { // numbers that were given out
        const char* const number = std::strrchr(name, '-');
        if (number)
            names_ = std::max(names_, static_cast<std::size_t>(std::strtoull(number + 1, nullptr, 10)));
    });
}

/// There is nothing to go on with.
void KeptScratch::begin(const std::vector<Trait>& job) {
    remove_all_but({});
    if (!os::resize(log_, 0)) throw Error(folder_, "cannot be written: " + why());
    append(with_head(0, bytes_of_traits(job)));
}

void KeptScratch::refuse(const std::vector<Trait>& kept, const std::vector<Trait>& job) const {
    constexpr const char* advice = "; remove the folder to begin anew, or name another with --scratch";
    for (std::size_t i = 0; i < std::min(kept.size(), job.size()); ++i) {
        if (kept[i].name != job[i].name) break; // values of different things
        if (kept[i].value != job[i].value)
            throw Error(folder_, "is kept of a job with another " + kept[i].name + ": " + kept[i].value
                                     + ", and not " + job[i].value + advice);
    }
    throw Error(folder_, std::string("is kept of a job of other files or options") + advice);
}

void KeptScratch::append(const Bytes& bytes) {
    if (!os::write_all(log_, {bytes.data(), bytes.size()}) || !os::flush_to_disk(log_)) {
        const std::string failure = why();
        os::resize(log_, end_); // or what comes next would stand behind half a record
        throw Error(folder_,
                    "cannot be written: " + failure + "; free some space, or name another --scratch");
    }
    end_ += bytes.size();
}

KeptScratch::Bytes KeptScratch::read(const Record& record) const {
    Bytes bytes(record.size);
    if (os::read_all_at(log_, bytes.data(), bytes.size(), record.at)
        != static_cast<std::ptrdiff_t>(bytes.size()))
        throw Error(folder_, "cannot be read; remove the folder to begin anew");
    return bytes;
}

void KeptScratch::keep(std::uint64_t key, const Bytes& bytes) {
    append(with_head(key, bytes));
    records_.push_back({key, end_ - bytes.size(), bytes.size()});
}

void KeptScratch::cut(std::size_t count) {
    if (count < records_.size()) {
        end_ = records_[count].at - sizeof(Head);
        records_.resize(count);
    }
    if (!os::resize(log_, end_)) throw Error(folder_, "cannot be written: " + why());
}

std::string KeptScratch::new_name(const std::string& name) {
    return name + "-" + std::to_string(++names_);
}

bool KeptScratch::has_file(const std::string& name, std::size_t bytes) const {
    os::FileStatus status;
    if (os::status_of_entry(path_of(name), status)) return status.size >= bytes;
    if (errno == ENOENT) return false;
    throw Error(path_of(name), "cannot be looked at: " + why() + "; nothing was changed");
}

void KeptScratch::remove_file(const std::string& name) const {
    os::remove(path_of(name));
}

void KeptScratch::remove_all_but(std::span<const std::string> names) const {
    std::vector<std::string> others;
    os::for_each_name(folder_, [&](const char* name) {
        if (name != std::string_view(log_name) && std::ranges::count(names, name) == 0)
            others.emplace_back(name);
    });
    for (const std::string& name : others) os::remove(path_of(name));
}

void KeptScratch::remove() {
    remove_all_but({});
    os::remove(path_of(log_name));
    os::remove_folder(folder_);
}

} // namespace hsdm
