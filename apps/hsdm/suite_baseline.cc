#include "suite_baseline.hh"

#include "hsdm/errors.hh"
#include "hsdm/io/source_bytes.hh"

#include <algorithm>
#include <cstdio>
#include <string_view>

namespace hsdm::command {
namespace {

/// Allocators and the system round up by more than small clouds take.
constexpr double least_memory = 16e6;

std::string fixed(double number, int digits) {
    char text[64];
    std::snprintf(text, sizeof text, "%.*f", digits, number);
    return text;
}

const Json* digest_of(const Outcome& outcome) {
    return outcome.report.is_null() ? nullptr : find_key(outcome.report, "mesh.digest");
}

bool same_mesh(const Outcome& a, const Outcome& b) {
    const Json *const first = digest_of(a), *const second = digest_of(b);
    return first && second && *first == *second;
}

const Json* threads_of(const Outcome& outcome) {
    return find_key(outcome.report, "threads");
}

/// Why times and memory of the two say nothing about the program.
std::string why_not_judged(const Outcome& before, const Outcome& now) {
    if (now.report.is_null()) return "no mesh now";
    if (before.report.is_null()) return "no mesh in the baseline";
    if (!before.input.empty() && before.arguments != now.arguments) return "other arguments in the baseline";
    const Json *const then = threads_of(before), *const here = threads_of(now);
    if (then && here && *then != *here)
        return "threads: " + then->dump() + " in the baseline, " + here->dump() + " now";
    if (before.seconds <= 0) return "no time in the baseline";
    return "";
}

} // namespace

Baseline Baseline::read(const std::string& path) {
    const io::SourceBytes bytes = io::SourceBytes::open(path);
    const std::string_view text = bytes.view();
    const Json list = Json::parse(text.begin(), text.end(), nullptr, false);
    if (!list.is_array() || list.empty()
        || !std::all_of(list.begin(), list.end(), [](const Json& one) { return one.is_object(); }))
        throw Error(path, "is no baseline: a file that `hsdm regress --json FILE` wrote is");
    Baseline baseline;
    std::map<std::string, std::size_t> numbers;
    for (const Json& one : list) {
        Outcome outcome = outcome_of(one);
        if (outcome.interrupted) continue;
        const std::size_t number = numbers[outcome.name]++;
        baseline.outcomes_.emplace(std::pair(outcome.name, number), std::move(outcome));
    }
    return baseline;
}

const Outcome* Baseline::find(const Case& one) const {
    const auto found = outcomes_.find({one.name, one.number_of_name});
    return found == outcomes_.end() ? nullptr : &found->second;
}

std::vector<std::string> Baseline::names_without(const std::vector<Case>& cases) const {
    std::vector<std::string> names;
    for (const auto& [key, outcome] : outcomes_)
        if (std::none_of(cases.begin(), cases.end(),
                         [&name = key.first, number = key.second](const Case& one) {
                             return one.name == name && one.number_of_name == number;
                         }))
            names.push_back(key.first);
    return names;
}

AgainstBaseline hold_against(const Outcome& before, const Outcome& now, const Case& one,
                             const BaselineBounds& bounds) {
    AgainstBaseline held;
    held.seconds = before.seconds;
    held.peak_memory_bytes = before.peak_memory_bytes;
    held.was_ok = is_ok(before);
    held.same_mesh = same_mesh(before, now);
    if (before.machine_seconds > 0 && now.machine_seconds > 0)
        held.machine = std::max(1.0, now.machine_seconds / before.machine_seconds);
    held.not_judged = why_not_judged(before, now);
    if (!held.not_judged.empty()) return held;
    const double seconds = before.seconds * held.machine;
    if (const auto most = one.most_slower ? one.most_slower : bounds.most_slower)
        held.slower = now.seconds > *most * seconds && now.seconds - seconds > bounds.least_seconds;
    const auto memory = static_cast<double>(before.peak_memory_bytes),
               memory_now = static_cast<double>(now.peak_memory_bytes);
    if (const auto most = one.most_memory ? one.most_memory : bounds.most_memory; most && memory > 0)
        held.more = memory_now > *most * memory && memory_now - memory > least_memory;
    return held;
}

std::vector<std::string> misses_of(const Outcome& now, const Case& one, const BaselineBounds& bounds) {
    std::vector<std::string> misses;
    if (!now.baseline) return misses;
    const AgainstBaseline& before = *now.baseline;
    const std::string runs = now.runs > 1 ? ", in the best of " + std::to_string(now.runs) + " runs" : "";
    const std::string machine =
        before.machine > 1.005 ? " on a machine " + fixed(before.machine, 2) + " times slower" : "";
    if (before.slower)
        misses.push_back("took " + fixed(now.seconds, 3) + " s" + runs + machine + ", the baseline "
                         + fixed(before.seconds, 3) + " s; at most "
                         + fixed(one.most_slower.value_or(bounds.most_slower.value_or(0)), 2)
                         + " times that expected");
    if (before.more)
        misses.push_back(
            "took " + std::to_string(now.peak_memory_bytes / 1000000) + " MB" + runs + ", the baseline "
            + std::to_string(before.peak_memory_bytes / 1000000) + " MB; at most "
            + fixed(one.most_memory.value_or(bounds.most_memory.value_or(0)), 2) + " times that expected");
    return misses;
}

} // namespace hsdm::command
