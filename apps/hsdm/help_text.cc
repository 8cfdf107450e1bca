#include "help_text.hh"

#include "option_table.hh"

namespace hsdm::command {
namespace {

constexpr std::size_t page_width = 80;
constexpr std::size_t text_column = 26;

/// `  -o, --output FILE     the mesh; ...`
std::string entry(const std::string& name, const std::string& text) {
    std::string line = "  " + name;
    if (line.size() + 2 > text_column) line += "\n" + std::string(text_column, ' ');
    if (line.size() < text_column) line.resize(text_column, ' ');
    return line + wrapped(text, text_column, page_width) + '\n';
}

std::string heading(const OptionText& option) {
    std::string text;
    for (const std::string& name : option.names) text += (text.empty() ? "" : ", ") + name;
    if (option.value.empty()) return text;
    return text + (text.empty() ? "" : " ") + option.value;
}

std::string entries(const std::string& title, const std::vector<OptionText>& options) {
    std::string text = "\n" + title + ":\n";
    for (const OptionText& option : options) text += entry(heading(option), full_description(option));
    return text;
}

std::string entries(const std::string& title, const std::vector<Meaning>& meanings) {
    std::string text = "\n" + title + ":\n";
    for (const Meaning& one : meanings) text += entry(one.name, one.text);
    return text;
}

/// Each group's where its first one stands.
std::string subcommand_entries(const std::vector<CommandText>& commands) {
    std::string text, group;
    for (const CommandText& command : commands) {
        if (command.group != group) text += "\n" + command.group + ":\n";
        group = command.group;
        text += entry(command.name, command.description);
    }
    return text;
}

std::string help_text(const CommandText& command) {
    std::string text = wrapped(command.path + ": " + command.description, 0, page_width)
                       + "\n\nUsage: " + command.path + ' ' + synopsis(command) + '\n';
    if (!command.arguments.empty()) text += entries("Arguments", command.arguments);
    text += subcommand_entries(command.subcommands);
    for (const OptionGroup& group : command.groups) text += entries(group.title, group.options);
    if (!command.subcommands.empty()) {
        text += entries("Environment", environment_variables());
        text += entries("Exit status", exit_statuses());
    }
    return text + (command.footer.empty() ? "" : "\n" + command.footer + '\n');
}

class HelpFormatter : public CLI::FormatterBase {
public:
    std::string make_help(const CLI::App* app, std::string, CLI::AppFormatMode) const override {
        return help_text(command_text(*app));
    }
};

} // namespace

std::string wrapped(std::string_view text, std::size_t indent, std::size_t width) {
    std::string lines;
    std::size_t column = indent;
    while (!text.empty()) {
        const std::string_view word = text.substr(0, text.find(' '));
        text.remove_prefix(std::min(word.size() + 1, text.size()));
        if (column > indent && column + 1 + word.size() > width) {
            lines += '\n' + std::string(indent, ' ');
            column = indent;
        }
        if (column > indent) lines += ' ';
        column += (column > indent) + word.size();
        lines += word;
    }
    return lines;
}

std::shared_ptr<CLI::FormatterBase> help_formatter() {
    return std::make_shared<HelpFormatter>();
}

} // namespace hsdm::command
