#include "hsdm/io/temporary_file.hh"

#include "hsdm/core/system.hh"
#include "hsdm/io/file_registry.hh"

#include <atomic>
#include <cerrno>
#include <map>
#include <mutex>
#include <string_view>
#include <utility>

namespace hsdm {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view suffix = ".tmp";

/// The part of a target's name that its temporary's name contains: with the suffix it must fit into the 255
/// bytes of a name.
std::string name_part(const fs::path& target) {
    constexpr std::size_t longest = 200;
    return target.filename().string().substr(0, longest);
}

/// A name beside the target that no other process or thread uses.
std::string temporary_name(const fs::path& target) {
    static std::atomic<unsigned> counter{0}; // distinguishes threads; no result depends on it
    const std::string name = '.' + name_part(target) + '.' + std::to_string(os::process_id()) + '-'
                             + std::to_string(counter++) + std::string(suffix);
    return (target.parent_path() / name).string();
}

/// Takes one or more digits from the end.
bool take_digits(std::string_view& text) {
    const std::size_t last = text.find_last_not_of("0123456789");
    const std::size_t kept = last == std::string_view::npos ? 0 : last + 1;
    const bool any = kept < text.size();
    text.remove_suffix(text.size() - kept);
    return any;
}

bool take(std::string_view& text, std::string_view end) {
    if (!text.ends_with(end)) return false;
    text.remove_suffix(end.size());
    return true;
}

/// NAME of `.NAME.PID-N.tmp`; empty for other names.
std::string_view target_of(std::string_view name) {
    if (!name.starts_with('.')) return {};
    name.remove_prefix(1);
    const bool ours =
        take(name, suffix) && take_digits(name) && take(name, "-") && take_digits(name) && take(name, ".");
    return ours ? name : std::string_view();
}

using Leftovers = std::multimap<std::string, fs::path, std::less<>>;

Leftovers find_in(const fs::path& folder) {
    Leftovers found;
    os::for_each_name(folder.empty() ? "." : folder.string(), [&](const char* name) {
        const std::string_view target = target_of(name);
        if (!target.empty()) found.emplace(target, folder / name);
    });
    return found;
}

/// True if no name stands for this file any more: a process that took it for left behind has removed it.
bool is_removed(int descriptor) {
    os::FileStatus status;
    return os::status_of(descriptor, status) && status.names == 0;
}

bool remove_if_left(const fs::path& path) {
    const std::string name = path.string();
    const int descriptor = os::open_entry_to_write(name);
    if (descriptor < 0) return false;
    os::FileStatus status;
    const bool removed = os::status_of(descriptor, status) && status.kind == os::FileStatus::Kind::regular
                         && os::try_lock(descriptor) && !is_removed(descriptor) && os::remove(name);
    os::close(descriptor);
    return removed;
}

} // namespace

TemporaryFile make_temporary(const fs::path& target, unsigned mode) {
    FileRegistry& registry = FileRegistry::of_process();
    for (;;) {
        TemporaryFile made{temporary_name(target), -1};
        const auto lock = registry.lock();
        registry.add_temporary(made.path); // registered first, so that it will be removed whatever happens
        made.descriptor = os::create(made.path, mode);
        const int error = errno;
        if (made.descriptor >= 0) {
            while (!os::lock(made.descriptor) && errno == EINTR) {
            } // a file system without locks: use it unlocked
            if (!is_removed(made.descriptor)) return made;
            os::close(made.descriptor);
        }
        registry.drop_temporary(made.path);
        if (made.descriptor >= 0 || error == EEXIST) continue;
        errno = error;
        return {};
    }
}

std::vector<std::string> remove_leftovers(const fs::path& target) {
    static std::mutex mutex;
    static std::map<fs::path, Leftovers> folders; // each as it was when this process first wrote there
    const std::lock_guard lock(mutex);
    const auto [folder, is_new] = folders.try_emplace(target.parent_path());
    if (is_new) folder->second = find_in(folder->first);
    std::vector<std::string> removed;
    const auto [begin, end] = folder->second.equal_range(name_part(target));
    for (auto one = begin; one != end; ++one)
        if (remove_if_left(one->second)) removed.push_back(one->second.string());
    folder->second.erase(begin, end);
    return removed;
}

} // namespace hsdm
