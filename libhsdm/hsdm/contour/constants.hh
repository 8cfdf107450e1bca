#pragma once
// Tuning values of the extended method (section 3.4), in the order of docs/sheets.md. Lengths are in voxels.
// What half and double of each do: docs/constants.md.

#include "hsdm/contour/facet_constants.hh"
#include "hsdm/core/tuned.hh"

#include <cstddef>

// normal_sets.hh
namespace hsdm::sets {

/// radians: points of a set lie within this angle of its mean normal.
/// Why: 35 degrees, the default angle above which an edge is sharp, so that the faces beside a sharp edge are
/// two sets.
HSDM_TUNED double cluster_angle = 0.61;

} // namespace hsdm::sets

// outlier_sets.hh
namespace hsdm::stray_sets {

/// sets: that are smoothly related from voxel to voxel; more are a surface.
/// Why: by trial; a patch of two by two voxels.
HSDM_TUNED std::size_t most_sets = 4;

} // namespace hsdm::stray_sets

// set_relation.hh, and who else asks whether two normals belong to one sheet
namespace hsdm::relations {

/// radians: normals closer than this belong to one sheet.
/// Why: 40 degrees, as angles.one_sheet, to the second digit.
HSDM_TUNED double smooth_angle = 0.70;

/// voxels: how far two sets of one sheet may lie apart along their mean normal.
/// Why: by trial; docs/sheets.md promises to tell sheets apart from there on.
HSDM_TUNED double smooth_gap = 0.3;

/// voxels: how far from the points of both sets the planes of a crease may meet.
/// Why: a set that ends at a crease in the next voxel lies up to half a voxel from it where points are few.
HSDM_TUNED double crease_gap = 0.5;

/// squared sine: planes closer to parallel have no line in common.
/// Why: 6 degrees; beyond angles.one_sheet only opposite sheets are that parallel, the two sides of a plate.
inline constexpr double least_sine_squared = 0.01;

} // namespace hsdm::relations

// blunt_creases.hh
namespace hsdm::blunt_creases {

/// cosine: between the normals of two faces; of a smaller angle they are one.
/// Why: 12 degrees: edges of 15 are found though noise tilts their faces.
HSDM_TUNED double bluntest_cosine = 0.978;

/// share: of the angle between the two faces, root mean square of normals within each.
/// Why: on a round surface cut in halves it is 0.29, on two halves of noise 0.38.
HSDM_TUNED double most_scatter = 0.25;

/// share: of what lies on the other face's side.
/// Why: by trial; where normals alone make two groups it is a half.
HSDM_TUNED double most_astray = 0.2;

} // namespace hsdm::blunt_creases

// patches.hh
namespace hsdm::patches {

/// voxels: between the two sheets of a wall or gap.
/// Why: beyond that the sets beside it are no neighbours.
inline constexpr double widest = 1.5;

/// points: of a set that are looked at, evenly taken.
/// Why: four by four in a voxel.
inline constexpr unsigned most_samples = 16;

/// spacings: from the crease that a sheet may go on beyond, to the points of it that tell so.
/// Why: a sheet that goes on has its next points there; those of the ground behind a wall are farther.
inline constexpr double goes_on_within = 1.5;

/// spacings: points nearer to the crease tell nothing.
/// Why: by trial; fits of the other sheet are off by less.
inline constexpr double goes_on_from = 0.25;

} // namespace hsdm::patches

// sheet_widths.hh
namespace hsdm::widths {

/// spacings: between the two sheets of a wall or gap that stands on something; nearer ones are doubtful.
/// Why: where a sheet ends is known to a spacing; two that end on each other's ground need one each.
inline constexpr double least = 1;

/// voxels: between the two sheets of a bore or rod, at most.
/// Why: it turns by one radian a voxel across its axis, by none along it; what turns by less than half of
/// that is none.
inline constexpr double of_cylinder = 2;

/// share: of the scatter of a set's normals, that its turn explains, at least.
/// Why: round a cylinder half, as positions scatter along its axis, too; of noise one in the number of
/// points.
inline constexpr double explained = 0.3;

} // namespace hsdm::widths

// local_sheets.hh, grid_signs.hh
namespace hsdm::sheets {

/// Voxels, how far off its planes a sheet may pass: two sets of one sheet that lie smooth_gap apart each miss
/// their mean by half of it.
inline double surface_error() {
    return relations::smooth_gap / 2;
}

/// voxels: how far off a sheet's plane in one voxel its surface and its points may lie.
/// Why: by trial; a tenth is what a uniform grid keeps in the mean on curved ground, less than
/// surface_error() and three times placement.clear_corner.
HSDM_TUNED double plane_error = 0.1;

/// voxels: from a place to the centroid of a set, or the tip of a wedge, that is still beside it.
/// Why: a voxel's corner is 0.87 from its middle; the centroid of a full voxel beside an edge is 0.7 off,
/// that of a clipped one more.
HSDM_TUNED double beside = 1.0;

/// cosine: of the normals of two sets that may become one sheet since they are one elsewhere.
/// Why: 70 degrees: less than the right angle between a plate's side and its rim, through which its two sides
/// would join.
HSDM_TUNED double least_closure_cosine = 0.35;

/// voxels: a set's say on a grid point falls off with its distance from it, to 1 / e at this distance.
/// Why: by trial; centroids of the eight voxels around lie 0.3 to 1.2 from a grid point, the near ones should
/// decide.
HSDM_TUNED double nearness = 0.5;

} // namespace hsdm::sheets

// crossings.hh
namespace hsdm::crossing {

/// share: of the points expected in a voxel; of fewer, the sheet ends in it.
/// Why: by trial; the density of a scan may differ by two or three from voxel to voxel.
HSDM_TUNED double fair_share = 0.25;

/// points: a voxel beside a crossed edge that holds none of the sheet is a sliver that the sampling missed
/// while fewer are expected in it.
/// Why: with six expected by chance none is there once in four hundred (exp(-6)).
HSDM_TUNED double sliver_points = 6;

} // namespace hsdm::crossing

// grid_signs.hh. Costs are in crossings taken back that the data carry.
namespace hsdm::signs {

/// crossings: cost of taking back one that the data do not carry.
/// Why: by trial; four of them must weigh less than one that is carried.
HSDM_TUNED double cost_of_weak = 0.2;

/// crossings: cost of bringing back one beyond a crease or beyond the data.
/// Why: by trial; cheaper than taking back what is carried, dearer than what is not.
HSDM_TUNED double cost_of_return = 0.6;

/// crossings: cost of a side against all sheets around a grid point; of a crossing where no sheet has any and
/// the grid ends beside the edge, so that a side stays open; twice that is the cost of one where the grid
/// does not end, or where the data go round the whole solid.
/// Why: by trial; less than a crossing that the data carry, which decides if nothing else does, and for two
/// less than both crossings of a thin part. Dearer, surfaces get closed at the ends of slots.
HSDM_TUNED double cost_of_belief = 0.8;

/// grid points: so far around contradictions sides are in doubt.
/// Why: with six instead of two the same sides come out, on scans with noise as well.
inline constexpr int rings = 2;

/// voxels: an invented crossing stays this far from the ends of its edge.
/// Why: by trial; off the grid points by enough that facets there keep an area.
HSDM_TUNED double end_gap = 0.01;

} // namespace hsdm::signs

// crossing_pairs.hh, trim_crossings.hh
namespace hsdm::pairing {

/// cosine: of the normals of two crossings that face opposite ways, as the two sides of a thin part.
/// Why: 107 degrees: creases at a right angle are not opposite, noise of 15 degrees included.
HSDM_TUNED double opposed_cosine = -0.3;

/// cost: of pairing two crossings across a crease, beside the angle and the distance from each other's
/// planes.
/// Why: by trial; one sheet is to be preferred at any angle of less than 90 degrees, whose cost is 1.
HSDM_TUNED double cost_of_crease = 1;

/// cost: of pairing two that face one way, with a wall or gap between them.
/// Why: twice that of a rim, across which two strangers face opposite ways a voxel apart.
inline constexpr double cost_of_parted = 10;

/// cost: of a crossing without a partner.
/// Why: more than all pairs of a face.
inline constexpr double cost_of_open = 100;

/// sides: a shorter boundary loop is a defect to close and no border.
/// Why: the end of a pipe of two voxels has 16 sides.
HSDM_TUNED int longest_defect = 16;

/// sides: the same of the hole in the data around the loop.
/// Why: its outline is more ragged; with a slot beside a pipe's end 26 sides were found.
HSDM_TUNED int longest_outline = 20;

} // namespace hsdm::pairing

// dual_vertices.hh
namespace hsdm::cuts {

/// voxels: a narrower face between two sides is none; one vertex serves both its creases.
/// Why: by trial; as small as the noise of a crossing.
inline constexpr double least_width = 0.05;

} // namespace hsdm::cuts

// place_vertices.hh
namespace hsdm::placement {

/// voxels: vertices stay this far from their voxel's faces.
/// Why: by trial; facets across a face of voxels keep an area, and a vertex is off its planes by no more than
/// noise.
HSDM_TUNED double margin = 0.002;

/// share: eigenvalues below this share of the largest are cut.
/// Why: two planes 6 degrees apart have a ratio of 0.003 (the squared tangent of half the angle): less is no
/// crease.
HSDM_TUNED double least_singular = 0.003;

/// share: of the largest eigenvalue; pull to the mean in directions left open, in the box.
/// Why: below least_singular, so that it outweighs no plane.
HSDM_TUNED double hold = 0.002;

/// voxels: half the least distance between two sides cut apart.
/// Why: by trial; facets between them keep an area.
HSDM_TUNED double side_gap = 0.02;

/// voxels: how far outside its voxel a vertex may lie where no other can be in its way; planes that meet
/// farther outside say nothing, and the sheet alone decides. Half as far where nothing guards it but the
/// facets around.
/// Why: half the next voxel; farther off that one's other half would have a vertex of its own.
HSDM_TUNED double farthest_out = 0.5;

/// voxels: root mean square of what a corner's planes may miss it by.
/// Why: by trial; three planes always meet, four and more only at a corner.
HSDM_TUNED double clear_corner = 0.03;

/// voxels: root mean square of what a crease's planes may miss a vertex by that moves there later.
/// Why: by trial; stricter than a corner's, as such creases are many and moving is worth little where they
/// are vague.
HSDM_TUNED double clear_crease = 0.01;

/// crossings: weight of one point of the voxel's own sets in least squares.
/// Why: by trial; a crossing is a mean over some points.
HSDM_TUNED double point_weight = 0.5;

/// points: a set of more has no more weight.
/// Why: by trial; three crossings' worth, as many as pass by a vertex on one sheet.
HSDM_TUNED double most_points = 6;

} // namespace hsdm::placement

// relax_vertices.hh
namespace hsdm::relaxation {

/// share: of the way to the mean of the neighbours in a round.
/// Why: by trial; the whole way makes neighbours change places on a grid.
HSDM_TUNED double step = 0.7;

/// share: by which a voxel's points may get farther off before its vertices go back.
/// Why: by trial; a tenth is within the chance of eight points.
HSDM_TUNED double farther = 0.1;

/// squared voxels: added to squared distances in weights of neighbours' heights.
/// Why: a tenth of a voxel squared, so that the weight at a neighbour stays finite.
HSDM_TUNED double nearness = 0.01;

/// factor: on the variance that squared rises must exceed.
/// Why: where they are equal noise explains the rise; twice moves less than noise would in the mean.
HSDM_TUNED double doubt = 2;

} // namespace hsdm::relaxation

// reach.hh
namespace hsdm::reach {

/// factor: on the mean distance of the points around, that those that stand out are farther than.
/// Why: three deviations of noise.
inline constexpr double means = 4;

} // namespace hsdm::reach

// move_to_creases.hh, shared_corners.hh, and the diagonals of dual_contour.hh
namespace hsdm::creases {

/// sine: of the corners of triangles at such a vertex.
/// Why: 1 degree: thinner ones have no normal to judge by.
HSDM_TUNED double least_sine = 0.02;

} // namespace hsdm::creases

// untangle.hh
namespace hsdm::untangling {

/// rounds: of moving vertices of facets that intersect.
/// Why: by trial; six steps of a half leave a fiftieth of the way.
inline constexpr int rounds = 6;

/// share: of the way to the mean of its neighbours that a vertex moves in a round.
/// Why: by trial; the whole way shrinks what is sharp.
HSDM_TUNED double step = 0.5;

/// rings: of facets round one that meets another, that may make place for others, and facets, most.
/// Why: within two of them a fold that one voxel makes ends; more are a piece of the surface, not a mishap.
inline constexpr int refilled_rings = 2;
inline constexpr std::size_t most_refilled = 64;

/// Pairs of facets: of more intersecting ones nothing is tried to be mended.
/// Why: each try looks at all facets near them again; so many are no local mishap.
inline constexpr std::size_t most_pairs = 100;

} // namespace hsdm::untangling
