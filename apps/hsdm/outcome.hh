#pragma once
// What came of the cases of a suite, for programs to read.

#include <nlohmann/json.hpp>

#include <optional>
#include <string>
#include <vector>

namespace hsdm::command {

/// A case held against the same one of an earlier run.
struct AgainstBaseline {
    double seconds = 0;                ///< of the baseline
    std::size_t peak_memory_bytes = 0; ///< of the baseline
    double machine = 1;                ///< how much slower the machine is than the baseline's was, at least 1
    bool was_ok = false;
    bool same_mesh = false;            ///< to the bit; false too where one of them has no mesh
    std::string not_judged;            ///< why times and memory were not; empty if they were
    bool slower = false, more = false; ///< than the bounds let it be
};

/// Of one case.
struct Outcome {
    std::string name;
    nlohmann::ordered_json report;   ///< null if there is none, because the case failed
    std::vector<std::string> misses; ///< why it is not as it must be; empty if it is
    double seconds = 0;              ///< wall-clock time, the least of the runs
    bool interrupted = false;        ///< by a signal
    std::string input;
    std::vector<std::string> arguments;
    std::size_t peak_memory_bytes = 0; ///< of the case's process, the least of the runs
    double machine_seconds = 0;        ///< of a fixed piece of work around the case; 0: not measured
    int runs = 1;                      ///< more where a bound was missed first
    int status = 0;                    ///< that `hsdm reconstruct` would end with
    std::string failure;               ///< the message, if the status is not 0
    std::string printed; ///< what the case's process wrote to its standard streams, the end of it
    std::string picture; ///< of the mesh, a PNG file; empty: none was drawn
    std::optional<AgainstBaseline> baseline;
};

/// True if it is as it must be.
inline bool is_ok(const Outcome& outcome) {
    return outcome.misses.empty();
}

/// Its mesh beside the baseline's, in one word: none, new, same, other.
inline const char* mesh_word(const Outcome& outcome) {
    if (outcome.report.is_null()) return "none";
    if (!outcome.baseline) return "new";
    return outcome.baseline->same_mesh ? "same" : "other";
}

/// A list of objects, docs/command.md has their keys.
std::string to_json(const std::vector<Outcome>& outcomes);

/// One of them, texts as they are, also where they are not UTF-8.
nlohmann::ordered_json json_of(const Outcome& outcome);

/// The outcome that json_of() made an object of; what is not there, or of another type, is as in none.
Outcome outcome_of(const nlohmann::ordered_json& object);

} // namespace hsdm::command
