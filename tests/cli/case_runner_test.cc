// Turns of a suite's cases, with a baseline and processes of the test's own in place of the command's.
#include "case_runner.hh"

#include <catch2/catch.hpp>

#include <new>

namespace hsdm::command {
namespace {

const Outcome of_baseline;
int processes = 0;

} // namespace

/// The second gets no memory for what it has to tell.
Outcome run_in_process(const Case&, const CaseTask&) {
    if (++processes == 2) throw std::bad_alloc();
    Outcome outcome;
    outcome.report = Json::object();
    return outcome;
}

const Outcome* Baseline::find(const Case&) const {
    return &of_baseline;
}

/// The first is slower than it was, and so runs again, alone.
AgainstBaseline hold_against(const Outcome&, const Outcome&, const Case&, const BaselineBounds&) {
    AgainstBaseline held;
    held.slower = processes == 1;
    return held;
}

std::vector<std::string> misses_of(const Outcome&, const Case&, const BaselineBounds&) {
    return {};
}

} // namespace hsdm::command

using namespace hsdm::command;

TEST_CASE("a case that throws while it runs alone lets the others have their turns", "[cli]") {
    const Baseline baseline;
    CaseRunner runner(CaseTask{}, &baseline, BaselineBounds{});
    const Case one;
    CHECK_THROWS_AS(runner.run(one), std::bad_alloc);
    CHECK(runner.run(one).runs == 1); // where no turn ended, it would wait for ever
    CHECK(processes == 3);
}
