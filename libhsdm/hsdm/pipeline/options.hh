#pragma once
// What follows from the caller's options.

#include "hsdm/point_view.hh"
#include "hsdm/reconstruct.hh"

namespace hsdm {

/// As options are written in reports and messages.
std::string text_of(double value);

/// The extended method is the better one, with normals given or estimated.
Method method_for(const ReconstructOptions& options);

/// Does the cloud need normals and has none, or none that the options want used?
bool must_estimate(const PointView& cloud, const ReconstructOptions& options);
/// Is no boundary loop to be left?
inline bool closes_all(Holes holes) {
    return holes == Holes::close || holes == Holes::complete;
}
/// Likewise, and none by cutting facets off?
inline bool must_be_closed(const ReconstructOptions& options) {
    return closes_all(options.holes) && options.trim == 0;
}
/// Was the size of voxels asked for, by these options or, as the report's say, as one of several levels?
bool are_voxels_asked_for(const ReconstructOptions& options, const Report& report);
bool wants_adaptive(const ReconstructOptions& options);
bool wants_confidence(const ReconstructOptions& options);

void note_options(bool estimate, const ReconstructOptions& options, Report& report);
/// What only some parts of the cloud have, by its names.
void note_left_out(const std::vector<std::string>& names, Report& report);

} // namespace hsdm
