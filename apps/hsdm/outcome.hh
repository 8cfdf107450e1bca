#pragma once
// What came of the cases of a suite, for programs to read.

#include <nlohmann/json.hpp>

#include <string>
#include <vector>

namespace hsdm::command {

/// Of one case.
struct Outcome {
    std::string name;
    nlohmann::ordered_json report;   ///< null if there is none, because the case failed
    std::vector<std::string> misses; ///< why it is not within tolerance; empty if it is
    double seconds = 0;              ///< wall-clock time
    bool interrupted = false;        ///< by a signal
};

/// A list of objects `name`, `ok`, `misses`, `seconds`, `report`; one that was interrupted has `interrupted`.
std::string to_json(const std::vector<Outcome>& outcomes);

/// JUnit's XML: a case out of tolerance is a failure, one without a report an error. What XML cannot hold is
/// written out as by printable().
std::string to_junit(const std::string& suite, const std::vector<Outcome>& outcomes);

} // namespace hsdm::command
