#pragma once
// Tuning values that several folders share. docs/constants.md has what half and double
// of each do.

#include "hsdm/core/tuned.hh"

#include <cstddef>

// Of all places that ask whether two directions are one surface's, along each other, or opposite: one answer
// each. What asks for another angle has it in its own folder, with its reason.
namespace hsdm::angles {

/// cosine: normals closer than this belong to one sheet; a facet that turns by more goes round an edge.
/// Why: 40 degrees, beyond the 35 that a set may spread to (sets.cluster_angle): sets beside each other on
/// round ground of a voxel and a half's radius are one sheet. Flatter creases lie within a sheet.
HSDM_TUNED double one_sheet = 0.77;

/// sine: of half the angle between normals of one sheet: how far a chord may rise out of a plane, or a round
/// wall's facet slope to its axis.
/// Why: 20 degrees, the half of a bend of 40.
HSDM_TUNED double half_of_sheet = 0.35;

/// cosine: normals closer than this lie on one smooth piece of a surface; a fold is none, a crease is.
/// Why: 26 degrees, under the 35 of a sharp edge; facets of a round part of two voxels' radius differ by
/// that.
HSDM_TUNED double smooth = 0.9;

/// cosine: a direction closer than this to another goes along it rather than across.
/// Why: 45 degrees, halfway. A wall less steep on a surface is a part of it or the side of a blade, a point's
/// normal more askew to a tube says nothing of it; with the sign turned, 135 degrees, a sheet faces back.
HSDM_TUNED double halfway = 0.7;

/// cosine: normals closer than this face one way, whatever noise did to them.
/// Why: 60 degrees, a third of the half-turn that wrong ones are off.
HSDM_TUNED double facing = 0.5;

/// cosine: with less, two normals face opposite ways.
/// Why: 120 degrees: the sides of a groove of 60 degrees part what lies beside it.
HSDM_TUNED double opposed = -0.5;

} // namespace hsdm::angles

// How often what settles by itself is repeated; how often what may go on, below (enough_rounds).
namespace hsdm::repeats {

/// rounds: of what one round does nearly all of.
/// Why: by trial; the second one takes in what the first one changed around.
HSDM_TUNED int twice = 2;

/// rounds: of what comes nearer in every one.
/// Why: by trial; after three little changes.
HSDM_TUNED int few = 3;

} // namespace hsdm::repeats

namespace hsdm {

/// points: of which a plane can be told: of a set, a sheet or a face that says where it lies.
/// Why: as many as a plane has; the rim of a wall has few, and outliers agree with two by chance.
inline constexpr unsigned points_of_plane = 3;

/// points: or pairs of sets, at least, that say one thing.
/// Why: a single one may be a stray, or wrong.
inline constexpr unsigned two_agree = 2;

/// points: nearest to a facet on one side of a part, that are asked whether they face its way; shortest ways
/// between two sets, that are asked whether something parts them.
/// Why: eight points lie within one and a half spacings; one of them may stand at a crease. So many ways end
/// at more than two points of either set.
inline constexpr std::size_t nearest_asked = 8;

/// rounds: of whatever is repeated until it is settled.
/// Why: bounds the work; what is left after so many is rare, and told or mended elsewhere.
inline constexpr int enough_rounds = 16;

} // namespace hsdm
