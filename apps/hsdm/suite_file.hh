#pragma once
// The suites that `hsdm regress` runs: what a file says, and whether a report is as it says. The format is in
// docs/command.md.

#include <nlohmann/json.hpp>

#include <string>
#include <vector>

namespace hsdm::command {

using Json = nlohmann::ordered_json;

/// A reconstruction and what its report must say.
struct Case {
    std::string name, input;
    std::vector<std::string> arguments;
    Json expect; ///< an object: report key, with dots between levels -> what it must be
};

/// The cases of a suite's text; `path`, which messages name, is where their inputs are looked for. Throws
/// Error `FILE:LINE: what, and what to do`, or `FILE: case N: ...`.
std::vector<Case> parse_suite(const std::string& text, const std::string& path);

/// The value that a key with dots leads to, through objects and, by digits, arrays; null if there is none.
const Json* find_key(const Json& report, const std::string& dotted);

/// Empty if the value (null: there is none) is as expected, else the reason. A plain value must be equal; an
/// object holds bounds `min`, `max`, or `value` with `tolerance` (absolute) or `relative`.
std::string miss(const std::string& key, const Json* value, const Json& expected);

} // namespace hsdm::command
