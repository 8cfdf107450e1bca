#include "option_table.hh"

#include "hsdm/stages/stages.hh"

#include <algorithm>
#include <cctype>

namespace hsdm::command {
namespace {

std::vector<std::string> parts(const std::string& text, char mark) {
    std::vector<std::string> found;
    for (std::size_t begin = 0, end; begin <= text.size(); begin = end + 1) {
        end = std::min(text.find(mark, begin), text.size());
        found.push_back(text.substr(begin, end - begin));
    }
    return found;
}

std::vector<std::string> names_of(const CLI::Option& option) {
    std::vector<std::string> names;
    for (const std::string& name : option.get_snames()) names.push_back("-" + name);
    for (const std::string& name : option.get_lnames()) names.push_back("--" + name);
    return names;
}

/// By the name of its value, which says what it is.
void set_offer(OptionText& text) {
    if (text.value.find('|') != std::string::npos) {
        text.offer = Offer::words;
        text.words = parts(text.value, '|');
    } else if (text.value == "STAGE") {
        text.offer = Offer::words;
        for (const Stage& stage : built_in_stages()) text.words.push_back(stage.name);
    } else if (text.value == "FILE") {
        text.offer = Offer::files;
    } else if (text.value == "DIR") {
        text.offer = Offer::folders;
    }
}

OptionText option_text(const CLI::Option& option) {
    OptionText text;
    text.names = names_of(option);
    if (option.get_items_expected_max() > 0) text.value = option.get_type_name();
    text.description = option.get_description();
    text.fallback = option.get_default_str();
    text.repeats =
        option.get_expected_max() > 1 || option.get_multi_option_policy() == CLI::MultiOptionPolicy::TakeAll;
    for (const CLI::Option* other : option.get_excludes()) text.excludes.push_back(names_of(*other).back());
    // CLI11 keeps them by their addresses.
    std::sort(text.excludes.begin(), text.excludes.end());
    set_offer(text);
    return text;
}

/// Its value is what usage lines show: INPUT..., SUITE.
OptionText argument_text(const CLI::Option& option) {
    OptionText text = option_text(option);
    text.required = option.get_required();
    text.offer = Offer::files;
    if (text.value == "TEXT") {
        text.value = option.get_name(true, false);
        for (char& letter : text.value)
            letter = static_cast<char>(std::toupper(static_cast<unsigned char>(letter)));
    }
    return text;
}

bool asks_for_help(const CLI::App& app, const CLI::Option* option) {
    return option == app.get_help_ptr() || option == app.get_version_ptr();
}

std::vector<OptionGroup> groups_of(const CLI::App& app) {
    std::vector<OptionGroup> groups;
    OptionGroup help{"Help", {}};
    for (const std::string& title : app.get_groups()) {
        OptionGroup group{title, {}};
        for (const CLI::Option* option : app.get_options()) {
            if (option->get_group() != title || title.empty() || option->get_positional()) continue;
            (asks_for_help(app, option) ? help : group).options.push_back(option_text(*option));
        }
        if (!group.options.empty()) groups.push_back(std::move(group));
    }
    if (!help.options.empty()) groups.push_back(std::move(help));
    return groups;
}

} // namespace

CommandText command_text(const CLI::App& app) {
    CommandText text;
    text.name = app.get_name();
    text.path = app.get_parent() ? app.get_parent()->get_name() + ' ' + text.name : text.name;
    text.group = app.get_group();
    text.description = app.get_description();
    text.footer = app.get_footer();
    for (const CLI::Option* option : app.get_options())
        if (option->get_positional()) text.arguments.push_back(argument_text(*option));
    text.groups = groups_of(app);
    for (const CLI::App* sub : app.get_subcommands({}))
        if (!sub->get_group().empty()) text.subcommands.push_back(command_text(*sub));
    return text;
}

std::string synopsis(const CommandText& command) {
    if (!command.subcommands.empty()) return "SUBCOMMAND [OPTION...] [ARGUMENT...]";
    std::string text = "[OPTION...]";
    for (const OptionText& argument : command.arguments)
        text += argument.required ? ' ' + argument.value : " [" + argument.value + ']';
    return text;
}

std::string full_description(const OptionText& option) {
    std::string more = option.fallback.empty() ? "" : "default: " + option.fallback;
    for (const std::string& other : option.excludes)
        more += (&other != &option.excludes.front() ? ", "
                 : more.empty()                     ? "not with "
                                                    : "; not with ")
                + other;
    return option.description + (more.empty() ? "" : " (" + more + ')');
}

const std::vector<Meaning>& environment_variables() {
    static const std::vector<Meaning> variables{
        {"HSDM_PLUGIN_PATH", "folders that modules are looked for in before that of the installation, with "
                             "colons between them; not read where the command has rights of another user"},
        {"TMPDIR", "the folder for the file that a case of regress with an `output` is written to and read "
                   "back from, and for the points of --memory without --scratch; default: /tmp"}};
    return variables;
}

const std::vector<Meaning>& exit_statuses() {
    static const std::vector<Meaning> statuses{
        {"0", "all done"},
        {"1", "an input could not be read, reconstructed or written, a case of a suite is out of tolerance, "
              "or there was a warning and --strict was given"},
        {"2", "wrong usage"},
        {"128 + N", "ended by signal N; 130 is Ctrl-C"}};
    return statuses;
}

} // namespace hsdm::command
