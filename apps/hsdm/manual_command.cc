// hsdm manual: the manual pages and completions of this very command, for its installation. Not shown by
// --help.

#include "command.hh"
#include "completions.hh"
#include "man_page.hh"

#include "hsdm/errors.hh"
#include "hsdm/io/write_mesh.hh"

#include <filesystem>

namespace hsdm::command {
namespace {

namespace fs = std::filesystem;

void write_into(const fs::path& folder, const std::string& name, const std::string& text) {
    std::error_code error;
    fs::create_directories(folder, error);
    if (error) throw Error(folder.string(), "cannot be made: " + error.message() + "; choose another folder");
    write_text((folder / name).string(), text);
}

int write_manual(const CommandText& command, const fs::path& folder) {
    write_into(folder / "man", page_name(command) + ".1", man_page(command));
    for (const CommandText& sub : command.subcommands)
        write_into(folder / "man", page_name(sub) + ".1", man_page(sub));
    write_into(folder / "bash", command.name, bash_completion(command));
    write_into(folder / "zsh", '_' + command.name, zsh_completion(command));
    write_into(folder / "fish", command.name + ".fish", fish_completion(command));
    return done;
}

} // namespace

void add_manual(CLI::App& app, Run& run) {
    CLI::App* const sub = app.add_subcommand("manual", "manual pages and completions, as files");
    const auto folder = std::make_shared<std::string>();
    sub->group("");
    sub->add_option("folder", *folder, "gets man/, bash/, zsh/ and fish/; made if missing")->required();
    sub->callback(
        [&app, &run, folder] { run = [&app, folder] { return write_manual(command_text(app), *folder); }; });
}

} // namespace hsdm::command
