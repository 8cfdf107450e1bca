#include "man_page.hh"

#include "hsdm/version.hh"

#include <algorithm>
#include <cctype>
#include <sstream>

namespace hsdm::command {
namespace {

/// Text that roff takes for nothing else: a hyphen is the character that a shell takes, too.
std::string literal(const std::string& text) {
    std::string result;
    for (const char letter : text) {
        const bool starts_line = result.empty() || result.back() == '\n';
        if (starts_line && (letter == '.' || letter == '\'')) result += "\\&";
        if (letter == '\\') {
            result += "\\e";
        } else if (letter == '-') {
            result += "\\-";
        } else if (letter == '\'') {
            result += "\\(aq";
        } else if (letter == '`') {
            result += "\\(ga";
        } else if (letter == '^') {
            result += "\\(ha";
        } else if (letter == '~') {
            result += "\\(ti";
        } else {
            result += letter;
        }
    }
    return result;
}

std::string bold(const std::string& text) {
    return "\\fB" + literal(text) + "\\fR";
}

std::string italic(const std::string& text) {
    return "\\fI" + literal(text) + "\\fR";
}

/// Of section headings and titles, in which a quotation mark would end the argument.
std::string in_quotes(const std::string& text) {
    std::string plain = text;
    std::erase(plain, '"');
    return '"' + literal(plain) + '"';
}

std::string upper(std::string text) {
    for (char& letter : text) letter = static_cast<char>(std::toupper(static_cast<unsigned char>(letter)));
    return text;
}

std::string tagged(const std::string& tag, const std::string& text) {
    return ".TP\n" + tag + '\n' + literal(text) + '\n';
}

/// Choices are words to type, all else stands for something.
std::string value_of(const OptionText& option) {
    return option.value.find('|') != std::string::npos ? literal(option.value) : italic(option.value);
}

std::string option_entry(const OptionText& option) {
    std::string tag;
    for (const std::string& name : option.names) tag += (tag.empty() ? "" : ", ") + bold(name);
    if (!option.value.empty()) tag += (tag.empty() ? "" : " ") + value_of(option);
    return tagged(tag, full_description(option)
                           + (option.repeats && !option.names.empty() ? "; can be given several times" : ""));
}

/// Lines of a footer: those below `Examples:`, which are indented, and all others.
struct Footer {
    std::string notes, examples;
};

Footer split(const std::string& footer) {
    Footer parts;
    std::istringstream lines(footer);
    bool in_examples = false;
    for (std::string line; std::getline(lines, line);) {
        if (line == "Examples:") {
            in_examples = true;
            continue;
        }
        in_examples = in_examples && line.starts_with(' ');
        (in_examples ? parts.examples : parts.notes) += line + '\n';
    }
    return parts;
}

/// As it is, line by line.
std::string verbatim(const std::string& title, const std::string& lines) {
    return lines.empty() ? "" : ".SH " + title + "\n.nf\n" + literal(lines) + ".fi\n";
}

std::string meanings(const std::string& title, const std::vector<Meaning>& all) {
    std::string text = ".SH " + in_quotes(title) + '\n';
    for (const Meaning& one : all) text += tagged(bold(one.name), one.text);
    return text;
}

std::string subcommand_section(const CommandText& command) {
    std::string text = ".SH SUBCOMMANDS\n", group;
    for (const CommandText& sub : command.subcommands) {
        if (sub.group != group) text += ".SS " + in_quotes(sub.group) + '\n';
        group = sub.group;
        text += tagged(bold(sub.name), sub.description + "; see " + page_name(sub) + "(1)");
    }
    return text;
}

std::string see_also(const CommandText& command) {
    std::string pages;
    for (const CommandText& sub : command.subcommands)
        pages += (pages.empty() ? "" : ",\n") + bold(page_name(sub)) + "(1)";
    return ".SH SEE ALSO\n" + (pages.empty() ? bold("hsdm") + "(1)" : pages) + '\n';
}

} // namespace

std::string page_name(const CommandText& command) {
    std::string name = command.path;
    std::replace(name.begin(), name.end(), ' ', '-');
    return name;
}

std::string man_page(const CommandText& command) {
    const std::string name = page_name(command);
    std::string page = ".TH " + in_quotes(upper(name)) + " 1 \"\" "
                       + in_quotes("hsdm " + std::string(version)) + " \"User Commands\"\n.nh\n.ad l\n";
    page += ".SH NAME\n" + literal(name) + " \\- " + literal(command.description) + '\n';
    page += ".SH SYNOPSIS\n" + bold(command.path) + ' ' + literal(synopsis(command)) + '\n';
    const Footer footer = split(command.footer);
    page += verbatim("DESCRIPTION", footer.notes);
    if (!command.subcommands.empty()) page += subcommand_section(command);
    if (!command.arguments.empty()) page += ".SH ARGUMENTS\n";
    for (const OptionText& argument : command.arguments) page += option_entry(argument);
    page += ".SH OPTIONS\n";
    for (const OptionGroup& group : command.groups) {
        page += ".SS " + in_quotes(group.title) + '\n';
        for (const OptionText& option : group.options) page += option_entry(option);
    }
    page += meanings("ENVIRONMENT", environment_variables());
    page += meanings("EXIT STATUS", exit_statuses());
    return page + verbatim("EXAMPLES", footer.examples) + see_also(command);
}

} // namespace hsdm::command
