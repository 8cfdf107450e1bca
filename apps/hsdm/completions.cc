#include "completions.hh"

#include "usage.hh"

#include <algorithm>
#include <functional>

namespace hsdm::command {
namespace {

/// What the command takes as words beside its subcommands.
constexpr const char* words_for_options[] = {"help", "version"};

void for_each_option(const CommandText& command, const std::function<void(const OptionText&)>& act) {
    for (const OptionGroup& group : command.groups)
        for (const OptionText& option : group.options) act(option);
}

std::string subcommand_names(const CommandText& command) {
    std::string names;
    for (const CommandText& sub : command.subcommands) names += (names.empty() ? "" : " ") + sub.name;
    return names;
}

std::string all_words(const CommandText& command) {
    std::string names = subcommand_names(command);
    for (const char* word : words_for_options) names += ' ' + std::string(word);
    return names;
}

std::string names_of_options(const CommandText& command) {
    std::string names;
    for_each_option(command, [&names](const OptionText& option) {
        names += (names.empty() ? "" : " ") + joined(option.names, " ");
    });
    return names;
}

/// Text between single quotation marks.
std::string single_quoted(const std::string& text, const std::string& quote) {
    std::string result = "'";
    for (const char letter : text) result += letter == '\'' ? quote : std::string(1, letter);
    return result + '\'';
}

/// bash: what follows an option that takes a value, as a branch of `case SUBCOMMAND OPTION in`.
std::string value_branch(const CommandText& command, const OptionText& option) {
    std::string patterns;
    for (const std::string& name : option.names)
        patterns += (patterns.empty() ? "" : " | ") + ("'" + command.name + ' ' + name + "'");
    std::string action = "return";
    if (option.offer == Offer::files) action = "_hsdm_offer -f; return";
    if (option.offer == Offer::folders) action = "_hsdm_offer -d; return";
    if (option.offer == Offer::words) action = "_hsdm_offer -W '" + joined(option.words, " ") + "'; return";
    return "    " + patterns + ") " + action + " ;;\n";
}

constexpr const char* bash_begin = R"(# Completion of hsdm for bash.

_hsdm_offer() {
    mapfile -t COMPREPLY < <(compgen "$@" -- "$current")
    [[ $1 = -W ]] || compopt -o filenames 2>/dev/null
}

_hsdm() {
    local current=${COMP_WORDS[COMP_CWORD]} option='' subcommand='' word
    # --method=auto is three words here.
    if [[ $current = '=' ]]; then
        current='' option=${COMP_WORDS[COMP_CWORD - 1]}
    elif ((COMP_CWORD > 1)); then
        option=${COMP_WORDS[COMP_CWORD - 1]}
        [[ $option != '=' ]] || option=${COMP_WORDS[COMP_CWORD - 2]}
    fi
    for word in "${COMP_WORDS[@]:1:COMP_CWORD-1}"; do
        if [[ $word != -* ]]; then
            subcommand=$word
            break
        fi
    done
    COMPREPLY=()
)";

std::string spec_text(const std::string& text) {
    std::string result;
    for (const char letter : text) {
        if (letter == '[' || letter == ']' || letter == ':' || letter == '\\') result += '\\';
        result += letter;
    }
    return result;
}

/// zsh: what _arguments is told of a value.
std::string value_spec(const OptionText& option) {
    if (option.value.empty()) return "";
    std::string action = " ";
    if (option.offer == Offer::files) action = "_files";
    if (option.offer == Offer::folders) action = "_files -/";
    if (option.offer == Offer::words) action = '(' + joined(option.words, " ") + ')';
    return ':' + spec_text(option.offer == Offer::words ? "value" : option.value) + ':' + action;
}

std::string zsh_specs(const CommandText& command, const std::string& indent) {
    std::string specs;
    for_each_option(command, [&](const OptionText& option) {
        for (const std::string& name : option.names) {
            std::vector<std::string> without = option.excludes;
            if (!option.repeats) without.insert(without.end(), option.names.begin(), option.names.end());
            const std::string before = option.repeats ? "*" : '(' + joined(without, " ") + ')';
            const std::string equals = option.value.empty() ? "" : name.starts_with("--") ? "=" : "+";
            specs += " \\\n" + indent
                     + single_quoted(before + name + equals + '[' + spec_text(option.description) + ']'
                                         + value_spec(option),
                                     "'\\''");
        }
    });
    for (const OptionText& argument : command.arguments)
        specs += " \\\n" + indent + "'" + (argument.repeats ? "*" : "") + ':' + spec_text(argument.value)
                 + ":_files'";
    return specs;
}

/// fish: one option of a subcommand, or of the command itself where `condition` says so.
std::string fish_option(const OptionText& option, const std::string& condition) {
    std::string line = "complete -c hsdm -n '" + condition + "'";
    for (const std::string& name : option.names)
        line += name.starts_with("--") ? " -l " + name.substr(2) : " -s " + name.substr(1);
    if (!option.value.empty()) line += option.offer == Offer::files ? " -r -F" : " -x";
    if (option.offer == Offer::folders) line += " -a '(__fish_complete_directories)'";
    if (option.offer == Offer::words) line += " -a '" + joined(option.words, " ") + "'";
    return line + " -d " + single_quoted(option.description, "\\'") + '\n';
}

} // namespace

std::string bash_completion(const CommandText& command) {
    std::string script = bash_begin;
    script += "    case \"$subcommand $option\" in\n";
    for (const CommandText& sub : command.subcommands)
        for_each_option(sub, [&](const OptionText& option) {
            if (!option.value.empty()) script += value_branch(sub, option);
        });
    script += "    esac\n    case $subcommand in\n";
    script += "    '') _hsdm_offer -W '" + all_words(command) + ' ' + names_of_options(command) + "' ;;\n";
    script += "    help) _hsdm_offer -W '" + subcommand_names(command) + "' ;;\n";
    for (const CommandText& sub : command.subcommands)
        script += "    " + sub.name + ")\n        if [[ $current = -* ]]; then\n            _hsdm_offer -W '"
                  + names_of_options(sub) + "'\n"
                  + (sub.arguments.empty() ? "" : "        else\n            _hsdm_offer -f\n")
                  + "        fi\n        ;;\n";
    return script + "    esac\n}\n\ncomplete -F _hsdm hsdm\n";
}

std::string zsh_completion(const CommandText& command) {
    std::string script = "#compdef hsdm\n# Completion of hsdm for zsh.\n\n_hsdm() {\n"
                         "    local curcontext=$curcontext state line\n    local -a subcommands\n"
                         "    subcommands=(\n";
    for (const CommandText& sub : command.subcommands)
        script += "        " + single_quoted(sub.name + ':' + spec_text(sub.description), "'\\''") + '\n';
    script += "        'help:what a subcommand does and takes'\n        'version:the version'\n    )\n";
    script += "    _arguments -C" + zsh_specs(command, "        ")
              + " \\\n        '1:subcommand:->subcommand' \\\n        '*::argument:->arguments'\n"
                "    case $state in\n"
                "    subcommand) _describe subcommand subcommands ;;\n"
                "    arguments)\n        case $line[1] in\n"
                "        help) _describe subcommand subcommands ;;\n";
    for (const CommandText& sub : command.subcommands)
        script += "        " + sub.name + ")\n            _arguments" + zsh_specs(sub, "                ")
                  + "\n            ;;\n";
    return script + "        esac\n        ;;\n    esac\n}\n\n_hsdm \"$@\"\n";
}

std::string fish_completion(const CommandText& command) {
    const std::string none = "not __fish_seen_subcommand_from " + all_words(command);
    std::string script = "# Completion of hsdm for fish.\n\ncomplete -c hsdm -n '" + none + "' -f\n";
    for (const CommandText& sub : command.subcommands)
        script += "complete -c hsdm -n '" + none + "' -a " + sub.name + " -d "
                  + single_quoted(sub.description, "\\'") + '\n';
    script += "complete -c hsdm -n '" + none
              + "' -a help -d 'what a subcommand does and takes'\n"
                "complete -c hsdm -n '"
              + none
              + "' -a version -d 'the version'\n"
                "complete -c hsdm -n '__fish_seen_subcommand_from help' -f -a '"
              + subcommand_names(command) + "'\n";
    for_each_option(command, [&](const OptionText& option) { script += fish_option(option, none); });
    for (const CommandText& sub : command.subcommands) {
        const std::string given = "__fish_seen_subcommand_from " + sub.name;
        if (sub.arguments.empty()) script += "complete -c hsdm -n '" + given + "' -f\n";
        for_each_option(sub, [&](const OptionText& option) { script += fish_option(option, given); });
    }
    return script;
}

} // namespace hsdm::command
