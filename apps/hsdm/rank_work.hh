#pragma once
// What each of several processes had to do.

#include "hsdm/report.hh"

#include <string>

namespace hsdm::command {

/// A line on how even the work of ranks was and what they sent; `each`: and one for every rank.
std::string work_words(const std::vector<Report::Rank>& ranks, bool each);

} // namespace hsdm::command
