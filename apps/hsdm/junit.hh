#pragma once
// What came of a suite in the XML that servers of continuous integration read.

#include "outcome.hh"

#include <string>
#include <vector>

namespace hsdm::command {

/// What the file says of the run beside the cases.
struct JunitRun {
    std::string suite;                                           ///< its path
    double seconds = 0;                                          ///< wall-clock time of it all
    std::vector<std::pair<std::string, std::string>> properties; ///< name, value
};

/// JUnit's XML, as Ant's schema and Jenkins's have it: a case out of tolerance is a failure, one that did not
/// come to a report an error; a failure's text holds all misses and what the case printed. What XML cannot
/// hold is written out as by printable().
std::string to_junit(const JunitRun& run, const std::vector<Outcome>& outcomes);

} // namespace hsdm::command
