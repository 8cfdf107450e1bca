#pragma once
// Tuning values of the stages that work on finished facets. What half and double of each do:
// docs/constants.md.

#include "hsdm/core/constants.hh"
#include "hsdm/core/tuned.hh"

#include <cstddef>

// surrounding.hh: bar_lines.hh, witnesses.hh
namespace hsdm::surrounding {

/// radians: between neighbouring directions of what lies all round an axis.
/// Why: 150 degrees; what leaves half a turn free lies on one side, and normals may err by 30.
inline constexpr double widest_gap = 2.6;

/// voxels: to either side along the axis, and out from it.
/// Why: walls and gaps that decide wrongly are under a voxel wide.
inline constexpr double reach_along = 1;

} // namespace hsdm::surrounding

// handles.hh, witnesses.hh
namespace hsdm::handles {

/// voxels: from a facet's middle to the plane of a set that speaks for it.
/// Why: a vertex lies on its sets' planes, a facet's middle not farther off than it is bent.
inline constexpr double agreeing_gap = 0.5;

/// share: of the facets beside a ring, that no points speak for.
/// Why: a web has four sides, above, below and at its ends, and below at least there are no points.
inline constexpr double least_contradicted = 0.25;

/// points: nearest to a facet, that are asked whether they speak for it.
/// Why: nearest_asked for each of the four sides of a bar; with those of two sides bars of two spacings are
/// cut.
inline constexpr std::size_t witnesses = 4 * nearest_asked;

/// points: that should lie on a stretch of a bore or rod and do not, so that it is none.
/// Why: chance leaves so much free once in 400 times, where two sheets share the voxels once in 20; next to
/// points that stand across it, seldom enough.
inline constexpr double least_missing = 6;

/// voxels: out from a ring, seen along its axis, within which points are of the bore or rod that it goes
/// round.
/// Why: by trial; facets lie nearer to their points, but for those beside a rim or corner that was not found.
inline constexpr double beside_ring = 0.25;

/// voxels: off the plane of a point, the middle of a facet that it speaks for.
/// Why: facets of a part lie that near to their points, but for those beside a rim or corner that was not
/// found; the sides of a bridge or tunnel lie aside of what faces their way. Half of it does as well, and
/// twice as much tells no more than the way points face.
inline constexpr double speaking_gap = 0.1;

/// spacings: round a place on a sheet, within which a point of the sheet lies.
/// Why: chance leaves a disc of that radius free once in a thousand times.
inline constexpr double beside_place = 1.5;

/// edges: from a vertex to the farthest of a ring through it.
/// Why: a web that one voxel decides has rings of four to six edges; half as many more for those of several.
inline constexpr int reach = 4;

/// facets: of a part that a ring cuts off, fewest.
/// Why: those of a cube of six voxels; what is smaller may be a knob or a spike of the part that it is on.
inline constexpr std::size_t fewest_of_part = 216;

} // namespace hsdm::handles

// rims.hh
namespace hsdm::rims {

/// share: of what lies more than a spacing beyond the points, that is drawn in.
/// Why: nearly all; what is left keeps neighbours in order, where all of it would lay them on one line.
inline constexpr double drawn_share = 0.9;

} // namespace hsdm::rims

// spikes.hh
namespace hsdm::spikes {

/// voxels: from a vertex to the nearest point; farther ones stand out from the surface.
/// Why: half of a voxel's diagonal: a vertex whose voxel the sampling missed has points beside it.
inline constexpr double farthest = 0.87;

/// rounds: half of the way to the mean of the neighbours in each.
/// Why: bounds the work; where there are points to come near to, ten are enough.
inline constexpr int rounds = 30;

} // namespace hsdm::spikes

// which holes dual_contour.hh closes
namespace hsdm::holes {

/// edges: longer loops stay open.
/// Why: by trial; longer than a defect (pairing.longest_defect) with room for the loops of several that met.
inline constexpr int most_edges = 24;

/// voxels: wider loops stay open, where voxels are wide against the spacing.
/// Why: as wide as a loop of 24 edges can be round.
HSDM_TUNED double widest = 6;

/// points: that should lie in the free disc about the middle of a closed hole that is more than a gap.
/// Why: chance leaves none once in 10^8 times, and seldomer, as the density of the voxels around is taken and
/// borders cut some of these.
inline constexpr double least_missing = 20;

} // namespace hsdm::holes

// sheet_features.hh
namespace hsdm::edge_hints {

/// per voxel: of distance from a set's centroid, in what is minimised beside angle and height to find a
/// facet's set.
/// Why: a twentieth tells sets of one sheet apart and sways nothing else.
HSDM_TUNED double arm_weight = 0.05;

/// share: of the crease angle; flatter edges are not looked at.
/// Why: facets of a crease fold less than its sheets where vertices are off by a fraction of a voxel; by
/// trial.
HSDM_TUNED double least_fold = 0.7;

/// sine: normals farther out of the fold's plane belong to other sheets.
/// Why: 30 degrees; by trial on the clouds of docs/features.md.
HSDM_TUNED double off_fold_sine = 0.5;

/// share: of the fold's angle; normals this close to one sheet's are that sheet's.
/// Why: the middle half is left for what lies between.
HSDM_TUNED double end_band = 0.25;

/// share: of the points round a crease, that may lie between its sheets.
/// Why: a bend of one direction to the other has half of them there; a tenth are noise.
HSDM_TUNED double most_between = 0.1;

/// voxels: from the edge; a second look where a small radius would show.
/// Why: by trial on the clouds of docs/features.md; less than a voxel's diagonal, more than half its edge.
HSDM_TUNED double nearby = 0.75;

/// voxels: how far positions are compared with normals.
/// Why: by trial on the clouds of docs/features.md; some ten points of a usual cloud.
HSDM_TUNED double chord = 0.5;

/// share: of the points between in the whole cloud that chords contradict; of more, normals are smeared.
/// Why: by trial on the clouds of docs/features.md: clean normals have next to none, smeared ones most.
HSDM_TUNED double most_tilted = 0.4;

/// points: round an edge, whose chords are looked at, and those that these lead to; both evenly taken.
/// Why: at eight a voxel an edge has some fifty; the chords of one point say less where they are few.
inline constexpr std::size_t most_compared = 256, most_chords = 2048;

} // namespace hsdm::edge_hints
