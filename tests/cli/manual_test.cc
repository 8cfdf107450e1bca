#include "cli/run.hh"

#include <catch2/catch.hpp>

#include <cstdlib>
#include <filesystem>
#include <regex>
#include <set>

using namespace hsdm::test;
using Catch::Matchers::Contains;

namespace fs = std::filesystem;

namespace {

const char* const subcommands[] = {"reconstruct", "info", "compare", "process", "stages", "regress"};

bool has_program(const char* name) {
    if (std::system(("command -v " + std::string(name) + " >/dev/null").c_str()) == 0) return true;
    WARN(name << " is not installed; what needs it is left out");
    return false;
}

/// The pages and scripts that the command writes, in the folder.
void write_manual(const Folder& folder) {
    const CommandResult result = run(folder, "manual .");
    INFO(result.err);
    REQUIRE(result.status == 0);
}

/// What a shell's command line prints, both ways, with the folder as its own.
std::string said(const Folder& folder, const std::string& line) {
    return run(folder, "--version >/dev/null; " + line + " 2>&1").out;
}

/// The long options that --help of a subcommand begins a line with; of the command itself for "".
std::set<std::string> options_of(const Folder& folder, const std::string& subcommand) {
    const std::string help = run(folder, subcommand + " --help").out;
    const std::regex line("\n  ((?:-[a-zA-Z], )?(?:--[a-z-]+(?:, )?)+)"), name("--[a-z-]+");
    std::set<std::string> options;
    for (std::sregex_iterator it(help.begin(), help.end(), line), end; it != end; ++it) {
        const std::string names = (*it)[1];
        for (std::sregex_iterator n(names.begin(), names.end(), name); n != end; ++n)
            options.insert(n->str());
    }
    return options;
}

/// What bash offers where the cursor is at the end of these words, of which the last is begun.
std::string offered_by_bash(const Folder& folder, const std::string& words) {
    return said(folder, "bash -c 'source bash/hsdm; COMP_WORDS=(" + words
                            + "); COMP_CWORD=$((${#COMP_WORDS[@]} - 1)); _hsdm; "
                              "printf \"%s \" \"${COMPREPLY[@]}\"'");
}

} // namespace

TEST_CASE("every option of --help has its place in the page and in the completions", "[cli]") {
    const Folder folder;
    write_manual(folder);
    const std::string bash = read_file(folder / "bash/hsdm"), zsh = read_file(folder / "zsh/_hsdm"),
                      fish = read_file(folder / "fish/hsdm.fish");
    for (const std::string subcommand : subcommands) {
        const std::string page = read_file(folder / ("man/hsdm-" + subcommand + ".1"));
        const std::set<std::string> options = options_of(folder, subcommand);
        CHECK(options.count("--help") == 1);
        CHECK(options.size() >= (subcommand == "reconstruct" ? 30 : 2));
        for (const std::string& option : options) {
            INFO(subcommand << ' ' << option);
            CHECK_THAT(page, Contains("\\fB" + std::regex_replace(option, std::regex("-"), "\\-") + "\\fR"));
            CHECK_THAT(bash, Contains(option));
            CHECK_THAT(zsh, Contains(option));
            CHECK_THAT(fish, Contains("from " + subcommand + "'") && Contains(" -l " + option.substr(2)));
        }
        CHECK_THAT(read_file(folder / "man/hsdm.1"), Contains("\\fB" + subcommand + "\\fR"));
    }
    for (const std::string variable : {"HSDM_PLUGIN_PATH", "TMPDIR"}) {
        CHECK_THAT(read_file(folder / "man/hsdm-process.1"), Contains(variable));
        CHECK_THAT(run(folder, "--help").out, Contains(variable));
    }
}

TEST_CASE("what an option is worth where it is not given is said", "[cli]") {
    const Folder folder;
    const std::regex silent("(FILE|DIR)"), said_so("default");
    for (const std::string subcommand : subcommands) {
        const std::string help = run(folder, subcommand + " --help").out;
        int seen = 0;
        // An option that takes a value, and its text up to the next entry, within its group.
        const std::regex group("\n([A-Z][^\n]*):\n((?:  [^\n]*\n)+)"),
            entry("  (?:-[a-zA-Z], )?--[a-z-]+(?:, --[a-z-]+)* ([A-Za-z:,|]+)(?:\n|  )(?:[^\n]*\n(?:    "
                  "[^\n]*\n)*)");
        for (std::sregex_iterator g(help.begin(), help.end(), group), end; g != end; ++g) {
            const std::string title = (*g)[1], options = (*g)[2];
            for (std::sregex_iterator e(options.begin(), options.end(), entry); e != end; ++e) {
                ++seen;
                INFO(subcommand << ": " << e->str());
                CHECK((std::regex_match((*e)[1].str(), silent) || std::regex_search(e->str(), said_so)
                       || std::regex_search(title, said_so)
                       || e->str().find("not available yet") != std::string::npos));
            }
        }
        CHECK(seen >= (subcommand == "reconstruct" ? 20 : subcommand == "regress" ? 3 : 0));
    }
}

TEST_CASE("help fits a terminal of 80 columns, but for choices and footers", "[cli]") {
    const Folder folder;
    for (const std::string subcommand : subcommands) {
        std::istringstream lines(run(folder, subcommand + " --help").out);
        for (std::string line; std::getline(lines, line) && !line.starts_with("Examples:");)
            if (line.starts_with(std::string(20, ' '))) CHECK(line.size() <= 80);
    }
}

TEST_CASE("manual pages are right for man", "[cli]") {
    if (!has_program("man")) return;
    const Folder folder;
    write_manual(folder);
    for (const auto& page : fs::directory_iterator(folder / "man")) {
        INFO(page.path());
        CHECK(said(folder, "LC_ALL=C.UTF-8 MANROFFSEQ= man --warnings -E UTF-8 -l -Tutf8 -Z '"
                               + page.path().string() + "' >/dev/null")
              == "");
        const std::string shown =
            said(folder, "LC_ALL=C.UTF-8 MANWIDTH=100 man -l '" + page.path().string() + "'");
        for (const char* section : {"NAME", "SYNOPSIS", "OPTIONS", "ENVIRONMENT", "EXIT STATUS", "SEE ALSO"})
            CHECK_THAT(shown, Contains(section));
    }
}

TEST_CASE("bash completes subcommands, options, their values and files", "[cli]") {
    if (!has_program("bash")) return;
    const Folder folder;
    write_manual(folder);
    folder.write("scan one.ply", "");
    CHECK(said(folder, "bash -n bash/hsdm") == "");
    CHECK(offered_by_bash(folder, "hsdm re") == "reconstruct regress ");
    CHECK(offered_by_bash(folder, "hsdm help com") == "compare ");
    CHECK(offered_by_bash(folder, "hsdm reconstruct --met") == "--method ");
    CHECK(offered_by_bash(folder, "hsdm reconstruct --method \"\"") == "auto basic extended ");
    CHECK(offered_by_bash(folder, "hsdm reconstruct --method = ex") == "extended ");
    CHECK(offered_by_bash(folder, "hsdm reconstruct a.ply --holes =") == "auto keep close complete ");
    CHECK(offered_by_bash(folder, "hsdm process part.off --stage deci") == "decimate ");
    CHECK(offered_by_bash(folder, "hsdm info --js") == "--json ");
    CHECK(offered_by_bash(folder, "hsdm info sc") == "scan one.ply ");
    CHECK(offered_by_bash(folder, "hsdm reconstruct -o sc") == "scan one.ply ");
    CHECK(offered_by_bash(folder, "hsdm reconstruct --out-dir zs") == "zsh ");
    CHECK(offered_by_bash(folder, "hsdm reconstruct --depth \"\"") == " ");
    CHECK(said(folder, "bash -c 'source bash/hsdm; complete -p hsdm'") == "complete -F _hsdm hsdm\n");
}

TEST_CASE("zsh and fish take their completions, and fish completes", "[cli]") {
    const Folder folder;
    write_manual(folder);
    if (has_program("zsh")) CHECK(said(folder, "zsh -n zsh/_hsdm") == "");
    if (!has_program("fish")) return;
    const auto offered = [&folder](const std::string& words) {
        return said(folder,
                    "HOME=$PWD fish --no-config -c 'source fish/hsdm.fish; complete -C \"" + words + "\"'");
    };
    CHECK(said(folder, "HOME=$PWD fish --no-config -n fish/hsdm.fish") == "");
    CHECK_THAT(offered("hsdm reconstruct --meth"), Contains("--method"));
    CHECK_THAT(offered("hsdm reconstruct --method ex"), Contains("extended"));
    CHECK_THAT(offered("hsdm comp"), Contains("compare\t"));
    CHECK_THAT(offered("hsdm process --stage deci"), Contains("decimate"));
    CHECK_THAT(offered("hsdm info --"), Contains("--json") && !Contains("--method"));
}

TEST_CASE("the manual is for installations: help does not name it", "[cli]") {
    const Folder folder;
    CHECK_THAT(run(folder, "--help").out, !Contains("manual"));
    CHECK_THAT(run(folder, "frobnicate").err, !Contains("manual"));
    folder.write("taken", "");
    const CommandResult refused = run(folder, "manual taken");
    CHECK(refused.status == 1);
    CHECK_THAT(refused.err, Contains("hsdm: taken/man: cannot be made"));
}
