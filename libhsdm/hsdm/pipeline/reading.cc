#include "hsdm/pipeline/reading.hh"

#include "hsdm/io/read_points.hh"

namespace hsdm {

void note_reading(const PointFile& file, Report& report) {
    report.input.dropped_nonfinite += file.nonfinite;
    if (!file.columns.empty()) report.options["columns"] = file.columns;
    if (file.withheld > 0)
        report.dropped.insert(report.dropped.begin(),
                              {"points that the file marks as withheld", file.withheld, file.first_withheld});
}

} // namespace hsdm
