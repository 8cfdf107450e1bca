#include "hsdm/stages/stages.hh"

#include "hsdm/errors.hh"

#include <algorithm>
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
            [plugin](PolyMesh& mesh, const StageArguments& given) { return plugin->process(mesh, given); }};
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

StageCall parse_stage_call(const std::string& text, const std::vector<std::string>& folders) {
    PluginRequest request = parse_plugin_request(text);
    StageCall call{find_stage(request.name, folders), std::move(request.arguments), text};
    check_stage_arguments(call.stage.name, call.stage.options, call.arguments);
    return call;
}

} // namespace hsdm
