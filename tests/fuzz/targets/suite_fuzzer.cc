// Suite files of `hsdm regress`, and their expectations held against a report, against themselves, and
// renewed by it.

#include "../../../apps/hsdm/suite_file.hh"
#include "../../../apps/hsdm/suite_update.hh"
#include "fuzz/targets/fuzz.hh"
#include "hsdm/errors.hh"
#include "hsdm/report.hh"

using namespace hsdm;
using hsdm::fuzz::promise;

namespace {

const command::Json& report() {
    static const command::Json json = command::Json::parse(to_json(Report{}));
    return json;
}

/// What changes is as found afterwards, and all else is as before.
void renew(const std::string& text, const std::vector<command::Case>& cases) {
    command::Outcome found;
    found.report = report();
    const std::vector<command::Outcome> outcomes(cases.size(), found);
    const auto changes = command::changes_to(cases, outcomes);
    const auto renewed = command::parse_suite(command::with_changes(text, changes), "suite.json");
    promise(renewed.size() == cases.size(), "cases stay");
    for (std::size_t i = 0; i < cases.size(); ++i) {
        promise(renewed[i].name == cases[i].name && renewed[i].input == cases[i].input, "cases stay");
        promise(renewed[i].expect.size() == cases[i].expect.size(), "expectations stay");
    }
    for (const command::SuiteChange& change : changes)
        promise(command::miss(change.key, &change.after, renewed[change.index].expect[change.key]).empty(),
                "what was renewed holds");
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
    std::vector<command::Case> cases;
    try {
        cases = command::parse_suite({reinterpret_cast<const char*>(bytes), size}, "suite.json");
    } catch (const Error& error) {
        promise(std::string_view(error.what()).starts_with("suite.json:"),
                "a message begins with the file's name");
        return 0;
    }
    promise(!cases.empty(), "a suite has cases");
    renew({reinterpret_cast<const char*>(bytes), size}, cases);
    for (const command::Case& one : cases) {
        promise(!one.input.empty(), "a case has an input");
        promise(one.expect.is_object() && one.expect.empty() == one.fails.has_value(),
                "a case expects keys of a report or a failure");
        for (const auto& [key, expected] : one.expect.items()) {
            command::miss(key, command::find_key(report(), key), expected);
            if (!expected.is_object())
                promise(command::miss(key, &expected, expected).empty(), "a value is what it is");
        }
    }
    return 0;
}
