#include "hsdm/features/feature_options.hh"

#include "hsdm/core/check_option.hh"

#include <numbers>

namespace hsdm {
namespace {

void check_angle(const char* name, double angle) {
    check_option(angle > 0 && angle < std::numbers::pi, name, angle, "lie in (0, pi), in radians");
}

void check_rounds(const char* name, int rounds) {
    check_option(rounds >= 0, name, rounds, "not be negative");
}

} // namespace

void validate(const FeatureOptions& options) {
    check_angle("crease_angle", options.crease_angle);
    check_angle("corner_angle", options.corner_angle);
    check_rounds("confirmation_rounds", options.confirmation_rounds);
}

void validate(const NormalSmoothingOptions& options) {
    check_angle("similarity_angle", options.similarity_angle);
    check_angle("settled_angle", options.settled_angle);
    check_rounds("rounds", options.rounds);
}

} // namespace hsdm
