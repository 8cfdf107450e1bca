#include "hsdm/plugin_loader.hh"

#include "hsdm/errors.hh"
#include "hsdm/plugin.hh"

#include <dlfcn.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <filesystem>
#include <set>

namespace hsdm {
namespace {

namespace fs = std::filesystem;

constexpr const char* extension = ".so";

std::string last_dl_error() {
    const char* text = dlerror();
    return text == nullptr ? "unknown reason" : text;
}

const PluginInfo* load(const std::string& path) {
    std::error_code error;
    if (!fs::exists(path, error)) throw Error(path, "no such file; check the name of the module");
    // A path without '/' would make dlopen search the system's library folders.
    void* library = dlopen(fs::absolute(path).c_str(), RTLD_NOW | RTLD_LOCAL | RTLD_NODELETE);
    if (library == nullptr) throw Error(path, "cannot be loaded: " + last_dl_error());
    using Entry = const PluginInfo* (*)();
    const auto entry = reinterpret_cast<Entry>(dlsym(library, "hsdm_plugin"));
    if (entry == nullptr)
        throw Error(path, "is not an hsdm module: it does not export hsdm_plugin; see hsdm/plugin.hh");
    const PluginInfo* info = entry();
    if (info == nullptr) throw Error(path, "is not an hsdm module: hsdm_plugin returns nothing");
    return info;
}

/// The two members every version of PluginInfo starts with decide whether the rest may be read.
void check(const std::string& path, const PluginInfo& info) {
    if (info.abi != plugin_abi)
        throw Error(path, "is built for module interface " + std::to_string(info.abi) + ", this is "
                              + std::to_string(plugin_abi) + "; build it against this hsdm");
    const std::string build = info.build == nullptr ? "nothing it tells" : info.build;
    if (build != plugin_build())
        throw Error(path,
                    "is built with " + build + ", this is " + plugin_build() + "; build it the same way");
    if (info.name == nullptr || info.description == nullptr || info.options == nullptr
        || info.process == nullptr)
        throw Error(path, "is not an hsdm module: name, description, options or function is missing");
}

std::vector<fs::path> shared_libraries(const std::string& folder) {
    std::vector<fs::path> files;
    std::error_code error;
    for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error))
        if (it->path().extension() == extension) files.push_back(it->path());
    std::sort(files.begin(), files.end());
    return files;
}

std::string not_found(const std::string& name, const std::vector<std::string>& folders) {
    std::string message = "no module of this name; ";
    std::string modules, places;
    for (const std::string& folder : folders) {
        places += (places.empty() ? "" : ", ") + folder;
        for (const fs::path& file : shared_libraries(folder))
            modules += (modules.empty() ? "" : ", ") + file.stem().string();
    }
    message += modules.empty() ? "there are none" : "there are " + modules;
    message += places.empty() ? "" : " (looked in " + places + ")";
    return name + ": " + message + "; HSDM_PLUGIN_PATH adds folders";
}

} // namespace

Plugin::Plugin(const std::string& path) : path_(path), info_(load(path)) {
    check(path_, *info_);
}

std::string Plugin::name() const {
    return info_->name;
}
std::string Plugin::description() const {
    return info_->description;
}
std::string Plugin::options() const {
    return info_->options;
}

std::string Plugin::process(PolyMesh& mesh,
                            const std::vector<std::pair<std::string, std::string>>& options) const {
    std::vector<PluginOption> plain;
    plain.reserve(options.size());
    for (const auto& [key, value] : options) plain.push_back({key.c_str(), value.c_str()});
    std::array<char, 1024> message{};
    const int result = info_->process(mesh, plain.data(), plain.size(), message.data(), message.size());
    message.back() = '\0';
    if (result == 2) throw OptionError(name() + ": " + message.data());
    if (result != 0) throw Error(name() + ": " + message.data());
    return message.data();
}

std::vector<std::string> plugin_folders() {
    std::vector<std::string> folders;
    if (const char* given = std::getenv("HSDM_PLUGIN_PATH")) {
        std::string folder;
        for (const char* c = given;; ++c) {
            if (*c != ':' && *c != '\0') {
                folder += *c;
                continue;
            }
            if (!folder.empty()) folders.push_back(folder);
            folder.clear();
            if (*c == '\0') break;
        }
    }
    std::error_code error;
    const fs::path program = fs::read_symlink("/proc/self/exe", error);
    if (error) return folders;
    const fs::path above = program.parent_path().parent_path();
    for (const fs::path& root :
         {above, above.parent_path()}) // installed, or two folders deep in a build tree
        folders.push_back(root / "lib" / "hsdm" / "plugins");
    return folders;
}

Plugin load_plugin(const std::string& name, const std::vector<std::string>& folders) {
    if (name.find('/') != std::string::npos) return Plugin(name);
    for (const std::string& folder : folders) {
        const fs::path path = fs::path(folder) / (name + extension);
        std::error_code error;
        if (fs::exists(path, error)) return Plugin(path);
    }
    throw Error(not_found(name, folders));
}

std::vector<PluginListing> list_plugins(const std::vector<std::string>& folders) {
    std::vector<PluginListing> listings;
    std::set<std::string> seen;
    for (const std::string& folder : folders)
        for (const fs::path& file : shared_libraries(folder)) {
            if (!seen.insert(file.filename()).second) continue;
            PluginListing listing;
            listing.path = file;
            listing.name = file.stem();
            try {
                const Plugin plugin(listing.path);
                listing.description = plugin.description();
                listing.options = plugin.options();
            } catch (const Error& error) {
                listing.problem = error.what();
            }
            listings.push_back(std::move(listing));
        }
    return listings;
}

PluginRequest parse_plugin_request(const std::string& text) {
    const std::size_t colon = text.find(':');
    PluginRequest request;
    request.name = text.substr(0, colon);
    if (request.name.empty()) throw OptionError("module " + text + ": has no name");
    if (colon == std::string::npos) return request;
    std::size_t begin = colon + 1;
    while (begin <= text.size()) {
        const std::size_t end = std::min(text.find(',', begin), text.size());
        const std::string part = text.substr(begin, end - begin);
        const std::size_t equals = part.find('=');
        if (equals == 0 || equals == std::string::npos)
            throw OptionError("module " + text + ": `" + part + "` must read key=value");
        request.options.emplace_back(part.substr(0, equals), part.substr(equals + 1));
        begin = end + 1;
    }
    return request;
}

} // namespace hsdm
