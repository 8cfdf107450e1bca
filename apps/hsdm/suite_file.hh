#pragma once
// The suites that `hsdm regress` runs: what a file says, and whether a report is as it says. The format is in
// docs/command.md.

#include <nlohmann/json.hpp>

#include <optional>
#include <string>
#include <vector>

namespace hsdm::command {

using Json = nlohmann::ordered_json;

/// How a case must fail.
struct Failure {
    std::string message; ///< a regular expression (ECMAScript) that must be found in the message
    int status = 1;      ///< that `hsdm reconstruct` would end with
};

/// A reconstruction and what its report must say.
struct Case {
    std::string name, input;
    std::string folder; ///< that its files are named from: the suite's, or its `root`
    std::vector<std::string> arguments;
    std::string reference; ///< path of the true surface, a mesh or a cloud of it; empty: none
    std::string output;    ///< format that the mesh is written in and read again: off, stl, ...; empty: none
    Json expect;           ///< an object: report key, with dots between levels -> what it must be
    std::size_t index = 0; ///< in the suite, from 0
    std::string pattern; ///< the input as the suite has it: a file from the folder, or a pattern for several
    bool named = false;  ///< by the suite, not by its input
    std::size_t number_of_name = 0;                 ///< among cases of the same name, from 0
    std::optional<Failure> fails;                   ///< it must; nothing is expected of a report then
    std::optional<double> most_slower, most_memory; ///< times the baseline's; nothing: the suite's
};

/// What is done about keys that suites do not have; `left` is for suites that other programs read, too.
enum class OtherKeys { refused, left };

/// The cases of a suite's text, at least one, each with an expectation or a failure; `path`, which messages
/// name, is where their inputs are looked for. Throws Error `FILE:LINE: what, and what to do`, or `FILE: case
/// N: ...`, also for an expectation that no report can be held against: a key that none has, a bound that is
/// none. With OtherKeys::left only what a case reads and runs is checked. Inputs that are patterns stay so.
std::vector<Case> parse_suite(const std::string& text, const std::string& path,
                              OtherKeys others = OtherKeys::refused);

/// The value that a key with dots leads to, through objects and, by digits, arrays; null if there is none.
const Json* find_key(const Json& report, const std::string& dotted);

/// Empty if the value (null: there is none) is as expected, else the reason. A plain value must be equal; an
/// object holds bounds, as parse_suite() has checked: `min`, `max`, or `value` with `tolerance` (absolute) or
/// `relative`.
std::string miss(const std::string& key, const Json* value, const Json& expected);

} // namespace hsdm::command
