#pragma once
// What each rank does, and for how long.

#include "hsdm/core/ranks.hh"
#include "hsdm/report.hh"

#include <chrono>

namespace hsdm {

/// From its beginning on. The ranks must outlive it.
class WorkOfRanks {
public:
    explicit WorkOfRanks(Ranks& ranks) : ranks_(ranks) {}

    /// By rank; `own`: points and tiles of this one. For all ranks at the same time.
    std::vector<Report::Rank> of_all(Report::Rank own) const;
    /// Adds it to what each did before.
    void add_to(std::vector<Report::Rank>& before) const;

private:
    using Clock = std::chrono::steady_clock;

    Ranks& ranks_;
    Clock::time_point start_ = Clock::now();
    double waited_ = ranks_.seconds_waited();
    std::size_t sent_ = ranks_.bytes_sent();
};

} // namespace hsdm
