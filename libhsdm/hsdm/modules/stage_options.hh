#pragma once
// What options a stage has, as its line of declarations says, and whether values given for them fit.

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace hsdm {

/// One option of a stage.
struct StageOption {
    std::string key;
    std::string fallback; ///< the value it has if it is not given; empty: none
    /// What values may be: `number` (finite), `length` (a number above 0), `share` (a number from 0 to 1),
    /// `count` (a whole number, 0 or more), `angle` (degrees above 0 and below 180), `file` (one that is
    /// read, not standard input), `text`, or the words themselves with `|` between them.
    std::string kind;
    std::string help; ///< one line
};

/// The `key=value` that a stage is called with, in the order given.
using StageArguments = std::vector<std::pair<std::string, std::string>>;

/// The options that a line declares: `key=fallback (kind): help`, with `; ` between them; empty for none.
/// Throws Error that says what is wrong with the line.
std::vector<StageOption> parse_stage_options(std::string_view line);

/// Throws OptionError `KEY VALUE: must be ...` for a value that is not of a kind.
void check_stage_value(const std::string& key, std::string_view kind, std::string_view value);

/// Throws OptionError `STAGE: KEY ...` for a key that is not among the options or is given twice, and for a
/// value that is not of its option's kind.
void check_stage_arguments(const std::string& stage, const std::vector<StageOption>& options,
                           const StageArguments& given);

} // namespace hsdm
