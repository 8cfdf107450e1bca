#include "hsdm/pipeline/method.hh"

namespace hsdm {

void note_dropped(const std::string& what, const Occurrences& discarded, const CloudFrame& frame,
                  Report& report) {
    if (discarded.count > 0)
        report.dropped.push_back({what, discarded.count, frame.to_cloud(discarded.first)});
}

} // namespace hsdm
