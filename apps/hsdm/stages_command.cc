// hsdm stages: what a mesh may go through, and its options.

#include "stages_command.hh"
#include "command.hh"
#include "messages.hh"

#include "hsdm/io/json_text.hh"
#include "hsdm/stages/stages.hh"

#include <iostream>

namespace hsdm::command {
namespace {

void print(const std::string& name, const std::string& description, const std::vector<StageOption>& options) {
    std::cout << printable(name + ": " + description) << '\n';
    for (const StageOption& option : options)
        std::cout << "    "
                  << printable(option.key + '=' + (option.fallback.empty() ? option.kind : option.fallback)
                               + (option.fallback.empty() ? "" : " (" + option.kind + ')') + "  "
                               + option.help)
                  << '\n';
}

void fill(JsonText& json, const std::string& name, const std::string& module, const std::string& description,
          const std::vector<StageOption>& options, const std::string& problem) {
    json.begin_object();
    json.member("name", name);
    if (!module.empty()) json.member("module", module);
    json.member("description", description);
    if (!problem.empty()) json.member("problem", problem);
    json.key("options");
    json.begin_array();
    for (const StageOption& option : options) {
        json.begin_object();
        json.member("key", option.key);
        if (!option.fallback.empty()) json.member("default", option.fallback);
        json.member("kind", option.kind);
        json.member("help", option.help);
        json.end();
    }
    json.end();
    json.end();
}

void print_as_json() {
    JsonText json;
    json.begin_array();
    for (const Stage& stage : built_in_stages())
        fill(json, stage.name, "", stage.description, stage.options, "");
    for (const PluginListing& module : list_plugins())
        fill(json, module.name, module.path, module.description, module.options, module.problem);
    json.end();
    std::cout << std::move(json).take();
}

void print_modules() {
    const std::vector<PluginListing> modules = list_plugins();
    for (const PluginListing& module : modules) {
        if (module.problem.empty())
            print(module.name, module.description + " (" + module.path + ")", module.options);
        else
            std::cout << printable(module.path) << ": cannot be used: " << printable(module.problem) << '\n';
    }
    if (!modules.empty()) return;
    std::string places;
    for (const std::string& folder : plugin_folders()) places += (places.empty() ? "" : ", ") + folder;
    std::cout << "no module found in " << printable(places) << "; set HSDM_PLUGIN_PATH to their folder\n";
}

} // namespace

int list_stages(bool as_json) {
    if (as_json) {
        print_as_json();
        return done;
    }
    for (const Stage& stage : built_in_stages()) print(stage.name, stage.description, stage.options);
    print_modules();
    return done;
}

void add_stages(CLI::App& app, Run& run) {
    CLI::App* const sub =
        app.add_subcommand("stages", "what --stage may name, built in and loaded, with options");
    const auto as_json = std::make_shared<bool>(false);
    sub->add_flag("--json", *as_json, "the same as JSON")->group("Output");
    sub->footer("Examples:\n"
                "  hsdm reconstruct scan.ply -o part.stl --stage decimate:ratio=0.125 --stage classify\n"
                "  hsdm process part.off -o quads.obj --stage quads");
    sub->callback([&run, as_json] { run = [as_json] { return list_stages(*as_json); }; });
}

} // namespace hsdm::command
