#include "hsdm/modules/plugin_loader.hh"

#include "hsdm/core/system.hh"
#include "hsdm/errors.hh"
#include "hsdm/io/source_bytes.hh"
#include "hsdm/mesh/check_links.hh"
#include "hsdm/modules/trusted_path.hh"
#include "hsdm/plugin.hh"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <filesystem>
#include <set>
#include <string_view>
#include <tuple>

namespace hsdm {
namespace {

namespace fs = std::filesystem;

constexpr const char* extension = ".so";

void check_interface(const std::string& path, std::uint32_t abi) {
    if (abi != plugin_abi)
        throw Error(path, "is built for module interface " + std::to_string(abi) + ", this is "
                              + std::to_string(plugin_abi) + "; build it against this hsdm");
}

/// The parts of a build's text, which commas part, that another build's does not have.
std::string other_parts(std::string_view build, std::string_view other) {
    const std::string there = ", " + std::string(other) + ", ";
    std::string parts;
    while (!build.empty()) {
        const std::string part(build.substr(0, build.find(", ")));
        build.remove_prefix(std::min(part.size() + 2, build.size()));
        if (there.find(", " + part + ", ") == std::string::npos) parts += (parts.empty() ? "" : ", ") + part;
    }
    return parts;
}

/// Checks all that can be checked without running any code of the module: loading it would run its
/// constructors.
PluginRecord inspect(const std::string& path) {
    std::error_code error;
    if (!fs::exists(path, error)) throw Error(path, "no such file; check the name of the module");
    // Reading a pipe would wait for whoever writes it.
    if (!fs::is_regular_file(path, error)) throw Error(path, "is no regular file; give a shared library");
    if (const std::string reason = distrust(path); !reason.empty())
        throw Error(path, "is not loaded: " + reason);
    const auto record = read_plugin_record(io::SourceBytes::open(path));
    if (!record)
        throw Error(path, "is not an hsdm module: no shared library with what HSDM_PLUGIN writes into it; "
                          "see hsdm/plugin.hh, and build it against this hsdm");
    check_interface(path, record->abi);
    if (record->build != HSDM_PLUGIN_BUILD)
        throw Error(path, "is built with " + other_parts(record->build, HSDM_PLUGIN_BUILD)
                              + ", this hsdm with " + other_parts(HSDM_PLUGIN_BUILD, record->build)
                              + "; build it the same way");
    return *record;
}

std::vector<StageOption> declared_options(const std::string& path, const PluginRecord& record) {
    try {
        return parse_stage_options(record.options);
    } catch (const Error& error) {
        throw Error(path, std::string(error.what()) + "; see hsdm/plugin.hh");
    } catch (const OptionError& error) {
        throw Error(path, std::string(error.what()) + " in what it declares; see hsdm/plugin.hh");
    }
}

const PluginInfo* load(const std::string& path) {
    // A path without '/' would be searched for in the system's library folders.
    void* library = os::load_library(fs::absolute(path).string());
    if (library == nullptr) throw Error(path, "cannot be loaded: " + os::library_error());
    using Entry = const PluginInfo* (*)();
    const auto entry = reinterpret_cast<Entry>(os::symbol_of(library, "hsdm_plugin"));
    if (entry == nullptr)
        throw Error(path, "is not an hsdm module: it does not export hsdm_plugin; see hsdm/plugin.hh");
    const PluginInfo* info = entry();
    if (info == nullptr) throw Error(path, "is not an hsdm module: hsdm_plugin returns nothing");
    check_interface(path, info->abi);
    if (info->process == nullptr) throw Error(path, "is not an hsdm module: its function is missing");
    return info;
}

std::vector<fs::path> shared_libraries(const std::string& folder) {
    std::vector<fs::path> files;
    std::error_code error;
    for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error))
        if (std::error_code none; it->path().extension() == extension && it->is_regular_file(none))
            files.push_back(it->path());
    std::sort(files.begin(), files.end());
    return files;
}

/// The next mark that no backslash stands before; the end if there is none.
std::size_t find_mark(std::string_view text, std::size_t from, char mark) {
    for (; from < text.size() && text[from] != mark; ++from)
        if (text[from] == '\\' && from + 1 < text.size()) ++from;
    return std::min(from, text.size());
}

/// A backslash before a mark or another one goes; before anything else it stays.
std::string unescaped(std::string_view text, char mark) {
    std::string result;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const bool escape =
            text[i] == '\\' && i + 1 < text.size() && (text[i + 1] == mark || text[i + 1] == '\\');
        result += text[escape ? ++i : i];
    }
    return result;
}

/// The name that a request begins with, and how far it goes: of a path to the last colon up to which it names
/// a file, else to the first colon.
std::pair<std::string, std::size_t> split_name(const std::string& text) {
    std::error_code error;
    if (text.find('/') != std::string::npos)
        for (std::size_t end = text.size(); end != std::string::npos && end > 0;
             end = text.rfind(':', end - 1))
            if (std::string path = text.substr(0, end); fs::is_regular_file(path, error)) return {path, end};
    const std::size_t end = find_mark(text, 0, ':');
    return {unescaped(text.substr(0, end), ':'), end};
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

Plugin::Plugin(const std::string& path)
    : path_(path), record_(inspect(path)), options_(declared_options(path, record_)), info_(load(path)) {}

std::string Plugin::process(PolyMesh& mesh, const StageArguments& arguments) const {
    check_stage_arguments(name(), options_, arguments);
    const bool had_faces = mesh.faces_sbegin() != mesh.faces_end();
    std::vector<PluginOption> plain;
    plain.reserve(arguments.size());
    for (const auto& [key, value] : arguments) plain.push_back({key.c_str(), value.c_str()});
    std::array<char, 1024> message{};
    const int result = info_->process(mesh, plain.data(), plain.size(), message.data(), message.size());
    message.back() = '\0';
    if (result == 2) throw OptionError(name() + ": " + message.data());
    if (result != 0) throw Error(name() + ": " + message.data());
    if (const std::string fault = fault_of(mesh); !fault.empty())
        throw Error(name() + ": left " + fault + "; the module is at fault, leave it out or mend it");
    if (had_faces && mesh.faces_sbegin() == mesh.faces_end())
        throw Error(name() + ": left a mesh without faces; check its options, or leave it out");
    drop_nonfinite_normals(mesh);
    return message.data();
}

std::vector<std::string> plugin_folders() {
    std::vector<std::string> folders;
    if (const char* given = os::trusted_variable("HSDM_PLUGIN_PATH"))
        for (std::string_view rest = given; !rest.empty();) {
            const std::size_t end = find_mark(rest, 0, ':');
            if (end > 0) folders.push_back(unescaped(rest.substr(0, end), ':'));
            rest.remove_prefix(std::min(end + 1, rest.size()));
        }
    folders.emplace_back(HSDM_PLUGIN_FOLDER);
    return folders;
}

std::string module_path(const std::string& name, const std::vector<std::string>& folders) {
    if (name.find('/') != std::string::npos) return name;
    for (const std::string& folder : folders) {
        const fs::path path = fs::path(folder) / (name + extension);
        std::error_code error;
        if (fs::exists(path, error)) return path.string();
    }
    return "";
}

Plugin load_plugin(const std::string& name, const std::vector<std::string>& folders) {
    const std::string path = module_path(name, folders);
    if (path.empty()) throw Error(not_found(name, folders));
    return Plugin(path);
}

std::vector<PluginListing> list_plugins(const std::vector<std::string>& folders) {
    std::vector<PluginListing> listings;
    std::set<std::string> seen;
    for (const std::string& folder : folders) {
        if (const std::string reason = distrust(folder); !reason.empty()) {
            listings.push_back({folder, "", "", {}, "nothing is loaded from here: " + reason});
            continue;
        }
        for (const fs::path& file : shared_libraries(folder)) {
            if (!seen.insert(file.filename()).second) continue;
            PluginListing listing;
            listing.path = file;
            listing.name = file.stem();
            try {
                const PluginRecord record = inspect(listing.path);
                listing.description = record.description;
                listing.options = declared_options(listing.path, record);
            } catch (const Error& error) {
                listing.problem = error.what();
            }
            listings.push_back(std::move(listing));
        }
    }
    return listings;
}

PluginRequest parse_plugin_request(const std::string& text) {
    PluginRequest request;
    std::size_t colon = 0;
    std::tie(request.name, colon) = split_name(text);
    if (request.name.empty()) throw OptionError("module " + text + ": has no name");
    if (colon == text.size()) return request;
    std::size_t begin = colon + 1;
    while (begin <= text.size()) {
        const std::size_t end = find_mark(text, begin, ',');
        const std::string part = unescaped(text.substr(begin, end - begin), ',');
        const std::size_t equals = part.find('=');
        if (equals == 0 || equals == std::string::npos)
            throw OptionError("module " + text + ": `" + part + "` must read key=value");
        request.arguments.emplace_back(part.substr(0, equals), part.substr(equals + 1));
        begin = end + 1;
    }
    return request;
}

} // namespace hsdm
