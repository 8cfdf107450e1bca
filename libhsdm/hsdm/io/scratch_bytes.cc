#include "hsdm/io/scratch_bytes.hh"

#include "hsdm/core/system.hh"
#include "hsdm/errors.hh"
#include "hsdm/io/file_registry.hh"
#include "hsdm/io/scratch_file.hh"

#include <atomic>
#include <cerrno>
#include <cstring>
#include <filesystem>

namespace hsdm {
namespace {

std::string failure() {
    return std::strerror(errno);
}

std::atomic<std::size_t> all_written{0}, held_now{0}, most_held{0};

void note_held(std::size_t bytes) {
    const std::size_t now = held_now.fetch_add(bytes) + bytes;
    for (std::size_t most = most_held; now > most && !most_held.compare_exchange_weak(most, now);) {
    }
}

std::string in_megabytes(std::size_t bytes) {
    return std::to_string((bytes + 999999) / 1000000) + " MB";
}

} // namespace

ScratchUse scratch_use() {
    return {all_written, most_held};
}

ScratchBytes::ScratchBytes(const ScratchPlace& place)
    : folder_(place.folder.empty() ? temporary_folder() : place.folder) {
    if (!place.name.empty()) {
        open((std::filesystem::path(folder_) / place.name).string(), place.is_there);
        return;
    }
    std::string name = (std::filesystem::path(folder_) / "hsdm-XXXXXX").string();
    // Whoever ends the process by a signal waits for the lock, and there is no name before or after.
    const auto lock = FileRegistry::of_process().lock();
    file_ = os::create_with_new_name(name, 0);
    if (file_ < 0)
        throw Error(folder_,
                    "no file for scratch can be made: " + failure() + "; --scratch names another folder");
    os::remove(name);
}

/// What a process that ended may have written beyond what is there is cut off.
void ScratchBytes::open(const std::string& path, std::size_t is_there) {
    if (is_there == 0) os::remove(path);
    file_ = is_there > 0 ? os::open_to_append(path) : os::create(path, 0600);
    if (file_ < 0) throw Error(path, "cannot be opened: " + failure() + "; --scratch names another folder");
    os::FileStatus status;
    if (os::status_of(file_, status) && status.size >= is_there && os::resize(file_, is_there)) {
        size_ = is_there;
        note_held(size_);
        return;
    }
    os::close(file_);
    throw Error(path, "has become shorter, or cannot be gone on with; remove the folder and begin again");
}

ScratchBytes::~ScratchBytes() {
    held_now -= size_;
    os::close(file_);
}

void ScratchBytes::check_room(const char* what, std::size_t needed) const {
    std::error_code failed;
    const std::filesystem::space_info space = std::filesystem::space(folder_, failed);
    if (!failed && space.available < needed)
        throw Error(folder_, std::string(what) + " take " + in_megabytes(needed)
                                 + " of scratch and there are " + in_megabytes(space.available)
                                 + "; --scratch names another folder");
}

bool ScratchBytes::has_room(std::size_t needed) const {
    std::error_code failed;
    const std::filesystem::space_info space = std::filesystem::space(folder_, failed);
    return !failed && space.available >= needed;
}

std::size_t ScratchBytes::append(const char* what, const void* bytes, std::size_t count) {
    if (!os::write_all(file_, {static_cast<const char*>(bytes), count}))
        throw Error(folder_, std::string(what) + " cannot be written to scratch after " + in_megabytes(size_)
                                 + ": " + failure() + "; --scratch names another folder");
    size_ += count;
    all_written += count;
    note_held(count);
    return size_ - count;
}

void ScratchBytes::flush_to_disk() const {
    if (!os::flush_to_disk(file_))
        throw Error(folder_, "scratch cannot be written: " + failure() + "; --scratch names another folder");
}

void ScratchBytes::read(std::size_t offset, void* bytes, std::size_t count) const {
    const std::ptrdiff_t some = os::read_all_at(file_, static_cast<char*>(bytes), count, offset);
    if (some < 0) throw Error(folder_, "scratch cannot be read: " + failure());
    if (static_cast<std::size_t>(some) < count)
        throw Error(folder_, "scratch cannot be read: the file has become shorter");
}

} // namespace hsdm
