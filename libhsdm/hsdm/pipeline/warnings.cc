#include "hsdm/pipeline/warnings.hh"

#include <algorithm>

namespace hsdm {

void warn(const char* what, const Occurrences& doubts, const CloudFrame& frame, Report& report) {
    if (doubts.count > 0)
        report.warnings.push_back({what, frame.to_cloud(doubts.first), static_cast<double>(doubts.count)});
}

void warn_anew(const char* what, const Occurrences& doubts, const CloudFrame& frame, Report& report) {
    std::erase_if(report.warnings, [&](const Report::Warning& said) { return said.what == what; });
    warn(what, doubts, frame, report);
}

} // namespace hsdm
