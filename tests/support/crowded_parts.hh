#pragma once
// Parts of thin walls and narrow gaps, which share voxels.

#include "support/solid.hh"

namespace hsdm::support {

/// About two units across, about the origin; `width` is that of every wall and gap named.
struct CrowdedPart {
    const char* name;
    Solid (*of_width)(double width);
    std::size_t components;
    long euler;
};

/// A base with sixteen teeth and gaps between them that are as wide.
Solid comb(double width);
/// A plate with seven six-sided holes and walls between them.
Solid honeycomb(double width);
/// A base with a row of fins, two widths apart, cut in two by a slot into the base.
Solid heat_sink(double width);
/// Two leaves with knuckles about a pin; nothing touches, gaps everywhere.
Solid hinge(double width);
/// A tin without a lid.
Solid can(double width);
/// A sheet rolled up two and a half times, two widths apart.
Solid roll(double width);

/// All of these.
const std::vector<CrowdedPart>& crowded_parts();

/// Bars between three by three by three places, so far apart; 54 of them, so genus 54 - 27 + 1. Their sides
/// lie in planes that are those of several but for little, as faces that coincide are not resolved.
Solid lattice(double width, double pitch);

} // namespace hsdm::support
