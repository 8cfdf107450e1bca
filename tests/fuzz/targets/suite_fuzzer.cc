// Suite files of `hsdm regress`, and their expectations held against a report and against themselves.

#include "../../../apps/hsdm/suite_file.hh"
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
    for (const command::Case& one : cases) {
        promise(!one.input.empty(), "a case has an input");
        promise(one.expect.is_object() && !one.expect.empty(), "a case expects keys of a report");
        for (const auto& [key, expected] : one.expect.items()) {
            command::miss(key, command::find_key(report(), key), expected);
            if (!expected.is_object())
                promise(command::miss(key, &expected, expected).empty(), "a value is what it is");
        }
    }
    return 0;
}
