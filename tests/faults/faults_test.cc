#include "faults/scenarios.hh"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cstring>

using namespace hsdm::faults;

namespace {

/// How a kind of call fails.
struct Failure {
    Kind kind;
    int error;
    bool lasting = false;
};

/// EINTR and `partial` are no failures: the call has to be repeated or continued.
const std::vector<Failure> file_failures = {
    {Kind::open, EACCES},   {Kind::open, EMFILE, true},   {Kind::read, EIO},
    {Kind::read, EINTR},    {Kind::read, partial},        {Kind::read, partial, true},
    {Kind::write, ENOSPC},  {Kind::write, EIO, true},     {Kind::write, EINTR},
    {Kind::write, partial}, {Kind::write, partial, true}, {Kind::sync, EIO},
    {Kind::close, EIO},     {Kind::rename, EACCES},       {Kind::rename, EIO, true},
    {Kind::link, EPERM},    {Kind::folder, ENOSPC},       {Kind::remove, EACCES},
    {Kind::status, EACCES}, {Kind::status, EIO, true},    {Kind::mode, EPERM},
    {Kind::lock, ENOLCK},   {Kind::tell, EIO, true},      {Kind::thread, EAGAIN},
};

const std::vector<Failure> memory_failures = {
    {Kind::memory, ENOMEM}, {Kind::memory, ENOMEM, true}, {Kind::map, ENOMEM}, {Kind::map, ENOMEM, true}};

constexpr std::uint64_t all = UINT64_MAX;

std::string name_of(const Failure& failure) {
    return std::string(kind_names[static_cast<std::size_t>(failure.kind)]) + " "
           + (failure.error == partial ? "half" : std::strerror(failure.error))
           + (failure.lasting ? " and on" : "");
}

/// Lets calls fail one by one: all of a kind, or as many as asked for, spread evenly.
void try_failure(Bench& bench, const Failure& failure, std::uint64_t most) {
    const bool skips_start = failure.kind == Kind::memory && !bench.scenario().from_start;
    const std::uint64_t before = skips_start ? bench.starting_calls() : 0;
    const std::uint64_t calls = bench.calls(failure.kind) - before, points = std::min(calls, most);
    for (std::uint64_t i = 0; i < points; ++i) {
        const std::string broken = bench.broken_promise(
            {failure.kind, before + 1 + (2 * i + 1) * calls / (2 * points), failure.error, failure.lasting});
        CHECK(broken == "");
    }
}

void try_failures(const std::vector<Scenario>& scenarios, const std::vector<Failure>& failures,
                  std::uint64_t most) {
    for (const Scenario& scenario : scenarios) DYNAMIC_SECTION(scenario.name) {
            Bench bench(scenario);
            for (const Failure& failure : failures) {
                const std::size_t runs = bench.runs(), done = bench.runs_done_in_spite();
                try_failure(bench, failure, most);
                if (most == all && bench.runs() > runs)
                    WARN(name_of(failure) << ", " << bench.runs() - runs << " faults, "
                                          << bench.runs_done_in_spite() - done << " done in spite of it");
            }
        }
}

} // namespace

TEST_CASE("reconstruct keeps its promises when a call about files fails", "[faults]") {
    try_failures(reconstructions(), file_failures, 2);
}

TEST_CASE("reconstruct keeps its promises when memory ends", "[faults]") {
    try_failures(reconstructions(), memory_failures, 6);
}

TEST_CASE("readers say which file failed and why", "[faults]") {
    try_failures(readings(), file_failures, 1);
}

TEST_CASE("readers say so when memory ends", "[faults]") {
    try_failures(readings(), memory_failures, 2);
}

TEST_CASE("other commands keep their promises when a call about files fails", "[faults]") {
    try_failures(other_commands(), file_failures, 2);
}

TEST_CASE("other commands keep their promises when memory ends", "[faults]") {
    try_failures(other_commands(), memory_failures, 6);
}

TEST_CASE("no call about files can fail without a word", "[faults][slow]") {
    for (const auto& scenarios : {reconstructions(), readings(), other_commands()})
        try_failures(scenarios, file_failures, all);
}

TEST_CASE("no allocation can fail without a word", "[faults][slow]") {
    for (const auto& scenarios : {reconstructions(), readings(), other_commands()})
        try_failures(scenarios, memory_failures, all);
}
