#include "hsdm/stages/stages.hh"

#include "hsdm/errors.hh"
#include "hsdm/io/source_bytes.hh"

#include <algorithm>
#include <filesystem>
#include <memory>

namespace hsdm {
namespace {

const Stage* find_built_in(const std::string& name) {
    const std::vector<Stage>& all = built_in_stages();
    const auto found =
        std::find_if(all.begin(), all.end(), [&](const Stage& stage) { return stage.name == name; });
    return found == all.end() ? nullptr : &*found;
}

Stage stage_of_module(const std::string& name, const std::vector<std::string>& folders) {
    const auto plugin = std::make_shared<const Plugin>(load_plugin(name, folders));
    return {plugin->name(), plugin->description(), plugin->options(), plugin->path(),
            [plugin](PolyMesh& mesh, const StageArguments& given, const StageContext&) {
                return plugin->process(mesh, given);
            }};
}

/// Whether a stage has an option of that key which is a file.
bool is_file(const Stage& stage, const std::string& key) {
    return std::ranges::any_of(
        stage.options, [&](const StageOption& option) { return option.key == key && option.kind == "file"; });
}

} // namespace

Stage find_stage(const std::string& name, const std::vector<std::string>& folders) {
    if (const Stage* const stage = find_built_in(name)) return *stage;
    try {
        return stage_of_module(name, folders);
    } catch (const Error& error) {
        if (!module_path(name, folders).empty()) throw;
        std::string names;
        for (const Stage& stage : built_in_stages()) names += (names.empty() ? "" : ", ") + stage.name;
        throw Error(std::string(error.what()) + "; stages built in are " + names);
    }
}

std::vector<std::string> StageCall::files() const {
    std::vector<std::string> names;
    for (const auto& [key, value] : arguments)
        if (is_file(stage, key)) names.push_back(value);
    return names;
}

bool StageCall::takes_scan() const {
    return !stage.instead_of_scan.empty() && std::ranges::none_of(arguments, [&](const auto& one) {
        return one.first == stage.instead_of_scan;
    });
}

StageCall parse_stage_call(const std::string& text, const std::vector<std::string>& folders,
                           const std::string& base) {
    PluginRequest request = parse_plugin_request(text);
    StageCall call{find_stage(request.name, folders), std::move(request.arguments), text};
    check_stage_arguments(call.stage.name, call.stage.options, call.arguments);
    for (auto& [key, value] : call.arguments)
        if (!base.empty() && is_file(call.stage, key)) value = (std::filesystem::path(base) / value).string();
    if (call.stage.check) call.stage.check(call.arguments);
    for (const std::string& file : call.files()) io::check_readable(file);
    return call;
}

} // namespace hsdm
