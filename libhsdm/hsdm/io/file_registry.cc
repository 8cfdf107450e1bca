#include "hsdm/io/file_registry.hh"

#include "hsdm/core/system.hh"

#include <algorithm>
#include <cstddef>
#include <new>
#include <utility>

namespace hsdm {

FileRegistry& FileRegistry::of_process() {
    // Made without allocation, because the first use may be when memory has run out; never destroyed.
    alignas(FileRegistry) static std::byte place[sizeof(FileRegistry)];
    static FileRegistry* const registry = new (place) FileRegistry;
    return *registry;
}

void FileRegistry::drop_temporary(const std::string& path) noexcept {
    const auto found = std::find(temporaries_.begin(), temporaries_.end(), path);
    if (found != temporaries_.end()) temporaries_.erase(found);
}

void FileRegistry::begin_stream(const std::string& name) {
    written_.in_part.push_back(name);
}

void FileRegistry::end_stream(const std::string& name) {
    note_complete(name);
    const auto found = std::find(written_.in_part.begin(), written_.in_part.end(), name);
    if (found != written_.in_part.end()) written_.in_part.erase(found);
}

bool FileRegistry::is_temporary(const std::string& name) const noexcept {
    return std::find(temporaries_.begin(), temporaries_.end(), name) != temporaries_.end();
}

void FileRegistry::note_complete(const std::string& name) {
    if (is_temporary(name)) return;
    if (written_.complete_count < FilesWritten::most_names) written_.complete.push_back(name);
    ++written_.complete_count;
}

void FileRegistry::take_back_complete(const std::string& name) noexcept {
    if (is_temporary(name)) return;
    if (written_.complete.size() == written_.complete_count) written_.complete.pop_back();
    --written_.complete_count;
}

const FilesWritten& abandon_files() noexcept {
    FileRegistry& registry = FileRegistry::of_process();
    registry.mutex_.lock(); // and never unlocked
    for (const std::string& path : registry.temporaries_) os::remove(path);
    return registry.written_;
}

void remove_temporaries_unless_locked() noexcept {
    FileRegistry& registry = FileRegistry::of_process();
    if (!registry.mutex_.try_lock()) return;
    for (const std::string& path : registry.temporaries_) os::remove(path);
}

std::vector<std::string> take_removed_leftovers() {
    FileRegistry& registry = FileRegistry::of_process();
    const auto lock = registry.lock();
    return std::exchange(registry.leftovers_, {});
}

} // namespace hsdm
