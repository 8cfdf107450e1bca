#include "hsdm/features/feature_options.hh"

#include "hsdm/errors.hh"

#include <numbers>
#include <string>

namespace hsdm {
namespace {

void check_angle(const char* name, double angle) {
    if (!(angle > 0 && angle < std::numbers::pi))
        throw OptionError(std::string(name) + " " + std::to_string(angle)
                          + ": must lie in (0, pi), in radians");
}

void check_rounds(const char* name, int rounds) {
    if (rounds < 0)
        throw OptionError(std::string(name) + " " + std::to_string(rounds) + ": must not be negative");
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
