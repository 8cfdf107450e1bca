#pragma once
// What reading did to a cloud, told by the report of its reconstruction.

#include "hsdm/report.hh"

namespace hsdm {

struct PointFile;

/// Points that the file marks as withheld go to the front of Report::dropped, those without coordinates into
/// Input::dropped_nonfinite, and what columns were taken for into `options`, as "columns". To be called once
/// for each report, by whoever reconstructs from the file's arrays; reconstruct() of a PointFile does so
/// itself.
void note_reading(const PointFile& file, Report& report);

} // namespace hsdm
