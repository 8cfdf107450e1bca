#include "usage.hh"

#include "messages.hh"

#include "hsdm/io/write_mesh.hh"

#include <algorithm>
#include <cmath>
#include <iostream>

namespace hsdm::command {
namespace {

using Words = std::vector<std::string>;

/// But those that are hidden.
Words subcommands(const CLI::App& app) {
    Words names;
    for (const CLI::App* sub : app.get_subcommands({}))
        if (!sub->get_group().empty()) names.push_back(sub->get_name());
    return names;
}

/// The words with `help` and `version` turned into options.
Words without_words_for_options(Words words) {
    if (words.empty()) return words;
    if (words[0] == "version") words[0] = "--version";
    if (words[0] != "help") return words;
    if (words.size() == 1) return {"--help"};
    return {words[1], "--help"};
}

void check_subcommand(const CLI::App& app, const Words& words) {
    Words known = subcommands(app);
    if (words.empty()) throw UsageError("a subcommand is needed: " + joined(known));
    const auto is_named = [&words](const CLI::App* sub) { return sub->get_name() == words[0]; };
    if (words[0].starts_with('-') || !app.get_subcommands(is_named).empty()) return;
    const std::string all = joined(known);
    known.insert(known.end(), {"help", "version"});
    const std::string near = suggestion(words[0], known);
    throw UsageError(words[0] + ": there is no such subcommand"
                     + (near.empty() ? "; there are " + all : near));
}

/// The option that a word names, without what `=` gives it; empty if it is none.
std::string option_of(const std::string& word) {
    if (!word.starts_with('-') || word == "-" || word == "--") return "";
    return word.substr(0, word.find('='));
}

std::string fault_of_words_left(const CLI::App& sub, const Words& left) {
    Words known;
    for (const CLI::Option* option : sub.get_options())
        for (const std::string& name : option->get_lnames()) known.push_back("--" + name);
    for (const std::string& word : left)
        if (const std::string option = option_of(word); !option.empty())
            return option + ": " + sub.get_name() + " has no such option" + suggestion(option, known);
    return left.front() + ": one argument too many for " + sub.get_name();
}

std::string fault_of_option(const CLI::ParseError& error) {
    std::string text = error.what();
    const std::string name = text.substr(0, text.find_first_of(": "));
    if (dynamic_cast<const CLI::ArgumentMismatch*>(&error))
        return name + (text.ends_with("missing") ? ": its value is missing" : ": can be given only once");
    if (dynamic_cast<const CLI::ExcludesError*>(&error))
        return name + " and " + text.substr(text.rfind(' ') + 1) + " cannot be given together";
    // The checks say `NAME: VALUE: what is wanted`.
    const std::size_t colon = text.find(": ");
    if (dynamic_cast<const CLI::ValidationError*>(&error) && colon != std::string::npos) text.erase(colon, 1);
    return text;
}

} // namespace

std::string joined(const std::vector<std::string>& words, const std::string& between) {
    std::string text;
    for (const std::string& word : words) text += (text.empty() ? "" : between) + word;
    return text;
}

std::vector<std::string> mesh_format_names() {
    std::vector<std::string> names;
    for (const MeshFormatInfo& info : mesh_formats()) names.emplace_back(info.name);
    return names;
}

std::string fault_of(const CLI::App& app, const CLI::ParseError& error) {
    const auto given = app.get_subcommands();
    const CLI::App& sub = given.empty() ? app : *given.front();
    // A word that is not known is the likely reason why another is missing.
    Words left = app.remaining(true);
    const bool extras = dynamic_cast<const CLI::ExtrasError*>(&error) != nullptr;
    if (!extras) std::erase_if(left, [](const std::string& word) { return option_of(word).empty(); });
    return left.empty() ? fault_of_option(error) : fault_of_words_left(sub, left);
}

std::optional<int> parse_command_line(CLI::App& app, int argc, char** argv) {
    Words words = without_words_for_options(Words(argv + std::min(argc, 1), argv + argc));
    check_subcommand(app, words);
    std::reverse(words.begin(), words.end()); // as the parser takes them
    try {
        app.parse(std::move(words));
        return std::nullopt;
    } catch (const CLI::Success& help_or_version) {
        app.exit(help_or_version, std::cout, std::cerr);
        return done;
    } catch (const CLI::ParseError& error) {
        throw UsageError(fault_of(app, error));
    }
}

CLI::Validator whole_number(int least, int most, const std::string& wanted) {
    return CLI::Validator(
        [=](std::string& text) {
            const auto value = number_of<int>(text);
            return value && *value >= least && *value <= most ? std::string() : text + ": must be " + wanted;
        },
        "");
}

CLI::Validator number_between(double least, double most, const std::string& wanted) {
    return CLI::Validator(
        [=](std::string& text) {
            const auto value = number_of<double>(text);
            const bool right = value && std::isfinite(*value) && *value > least && *value < most;
            return right ? std::string() : text + ": must " + wanted;
        },
        "");
}

CLI::Validator one_of(std::vector<std::string> names) {
    return CLI::Validator(
        [names = std::move(names)](std::string& text) {
            if (std::find(names.begin(), names.end(), text) != names.end()) return std::string();
            return text + ": must be one of " + joined(names) + suggestion(text, names);
        },
        "");
}

} // namespace hsdm::command
