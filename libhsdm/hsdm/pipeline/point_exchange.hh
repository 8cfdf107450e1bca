#pragma once
// Points on their way from the ranks that have them to those that need them.

#include "hsdm/core/ranks.hh"
#include "hsdm/io/scratch_points.hh"

namespace hsdm {

/// Sends points to other ranks, some at a time. All ranks must have one at the same time, and finish() it,
/// whether they send points or not.
class PointExchange {
public:
    using Receive = std::function<void(const PointRow&, const char* beside)>;

    /// `most_points`: so many wait here at most. `beside`: bytes that go with each. receive(row, beside) is
    /// called for each that comes, in no order that means anything.
    PointExchange(Ranks& ranks, std::size_t most_points, std::size_t beside, Receive receive);

    /// Waits for all ranks now and then.
    void add(int to, const PointRow& row, const char* beside);
    /// Returns once all ranks have sent and received all.
    void finish();

private:
    /// One exchange; is there another?
    bool round(bool has_more);

    Ranks& ranks_;
    std::size_t most_points_, beside_, waiting_ = 0;
    Receive receive_;
    std::vector<Ranks::Bytes> out_;
};

} // namespace hsdm
