#pragma once
// Tuning values of normals, noise and outliers, in the order of docs/normals.md. A reach is the distance of
// the farthest of a point's neighbours. What half and double of each do: docs/constants.md.

#include "hsdm/core/tuned.hh"
#include "hsdm/types.hh"

#include <cstddef>
#include <cstdint>

// neighbors.hh, neighborhood.hh
namespace hsdm::neighborhoods {

/// neighbours: per point.
/// Why: by trial; a ring of six and one round it of ten: a plane levels the noise of a tenth of the spacing,
/// and creases are smeared over 2.3 spacings only.
HSDM_TUNED int neighbors = 16;

/// points: of a leaf, that neighbours are looked for together, and of which patches are made.
/// Why: by trial; patches of about five points come of it.
HSDM_TUNED std::size_t leaf_points = 12;

/// points: in the 27 voxels around per neighbour that is wanted.
/// Why: of 64 points on a sheet the nearest 16 lie within 0.85 voxels, and it is a voxel to the rim of the
/// 27.
HSDM_TUNED std::size_t candidates_per_neighbor = 4;

/// squared cosine: of two normals that agree not at all.
/// Why: 33 degrees, about the angle of a sharp edge.
HSDM_TUNED double least_agreement = 0.7;

} // namespace hsdm::neighborhoods

// outliers.hh: drop_outliers_by_distance
namespace hsdm::distance_outliers {

/// factor: of a point's reach on the median reach of its neighbours.
/// Why: by trial; density that falls to a twentieth from point to point is none of a scan.
HSDM_TUNED double most_stretch = 4;

/// ratio: of a point's reach to the median of the cloud.
/// Why: by trial; a hundredth of the density.
HSDM_TUNED double most_sparseness = 10;

/// factor: as most_stretch; from there on a point is looked at more closely.
/// Why: by trial; below, outliers are not told from a border's points.
HSDM_TUNED double doubtful_stretch = 1.25;

/// factor: as most_sparseness; from there on a point is looked at more closely.
/// Why: by trial.
HSDM_TUNED double doubtful_sparseness = 1.5;

/// reaches: deviation of neighbours from their plane that is a volume's.
/// Why: points spread over a ball deviate by 0.45, over a crease of a right angle by 0.19.
HSDM_TUNED double least_volume = 0.2;

/// reaches: from a plane that is a face.
/// Why: of 16 points in a ball a plane through three of them holds seven within that with odds of one in a
/// hundred.
inline constexpr double face_thickness = 0.02;

/// percent: of the neighbours that lie on a face.
/// Why: at the rim of a wedge half of them, less what chance takes.
inline constexpr std::size_t face_percent = 44;

/// reaches: a point's distance from its neighbours' plane.
/// Why: by trial; a point beyond a crease is less far off.
HSDM_TUNED double least_height = 0.45;

} // namespace hsdm::distance_outliers

// outliers.hh: drop_outliers_by_normals
namespace hsdm::normal_outliers {

/// share: of those points in a sparse voxel; of the points of a typical set in one that is an outlier.
/// Why: one point: a few percent of a clean cloud's are alone in a voxel that they clip. A surface that clips
/// a voxel by an eighth of its area has neighbours with more.
HSDM_TUNED double most_share = 0.125;

/// voxels: how far those may be that are not of a sparse voxel themselves.
/// Why: by trial: a distant surface does not hold an outlier, a dense one beside a sparse one does.
HSDM_TUNED double most_distance = 8;

/// radians: between normals of one plane.
/// Why: 45 degrees: more than two sets of one sheet (angles.one_sheet), as sparse ground bends more
/// from point to point.
HSDM_TUNED double most_angle = 0.79;

} // namespace hsdm::normal_outliers

// noise.hh, and what noise does not explain
namespace hsdm::noise {

/// deviations: or means of what noise does, beyond which it does hardly anything.
/// Why: a point lies farther off once in four hundred.
HSDM_TUNED double deviations = 3;

/// neighbours: nearest ones whose plane tells the noise.
/// Why: six are of one sheet even where that is one side of a thin plate.
HSDM_TUNED std::size_t nearest = 6;

/// share: of the reach, below which the distance from the plane of the nearest is small.
/// Why: about five deviations to the reach; where all is noise it is 0.23.
HSDM_TUNED double small = 0.15;

/// share: the same at the next scale.
/// Why: as above; where all is noise it is 0.30.
HSDM_TUNED double small_of_more = 0.2;

/// points: of a cloud that has a noise.
/// Why: of fewer there is nothing to take a typical value of.
inline constexpr std::size_t fewest = 500;

/// share: of the reach; noisier points have 32 neighbours.
/// Why: measured: 0.1 is noise of half a spacing; from 0.3 spacings on planes of 16 points are too unsteady.
HSDM_TUNED double rough = 0.06;

/// share: the same for 64 neighbours.
/// Why: by trial, twice the noise.
HSDM_TUNED double very_rough = 0.13;

} // namespace hsdm::noise

// smooth_points.hh
namespace hsdm::smoothing {

/// spacings: standard deviation of the noise from which on points are moved.
/// Why: by trial; below, planes of 16 to 64 neighbours are steady and creases stay crisper.
HSDM_TUNED double least_noise = 0.4;

/// deviations: radius of the surroundings, and off the plane, where another sheet begins.
/// Why: by trial; wider ones round creases, narrower ones hold points of one side of the noise. A point of
/// the sheet lies farther off once in 16,000; sides of a plate stay apart at seven.
HSDM_TUNED double least_radius = 4;

/// geometric means: of deviation and spacing, in the radius of the surroundings.
/// Why: a plane's tilt falls with noise * spacing / radius^2: some four degrees at six.
HSDM_TUNED double steady_radius = 6;

/// voxels: to a radius, of the sums over voxels that surroundings are.
/// Why: by trial; one is too coarse for a round weight, three take three times as long.
HSDM_TUNED std::int32_t reach = 2;

/// share: of the noise that was thought; found less, all is done again.
/// Why: by trial; a twentieth makes no difference.
HSDM_TUNED double clearly_less = 0.95;

} // namespace hsdm::smoothing

// estimate_normals.hh
namespace hsdm::estimation {

/// reaches: how far from a plane a point of it may lie, on clean data.
/// Why: by trial; curved ground of 20 spacings' radius is that far off its plane at the reach.
HSDM_TUNED double least_tolerance = 0.05;

/// factor: by which the spread of the flattest neighbour may widen the tolerance.
/// Why: by trial.
HSDM_TUNED double most_widening = 2;

/// share: of the tolerance; neighbours that deviate more from their plane bend.
/// Why: by trial; all that are within the tolerance deviate by 0.4 at most.
HSDM_TUNED double bent_spread = 0.45;

/// factor: how many more neighbours a plane must hold to be taken over.
/// Why: a bent sheet without a crease gives its tilted planes up to 1.2 times more.
HSDM_TUNED double clear_gain = 1.3;

/// cosine: of normals of neighbours that are no sign of a crease.
/// Why: 14 degrees; where planes are smeared over both faces those beside a crease differ by half of its
/// angle.
HSDM_TUNED double differing_cosine = 0.97;

/// points: by their weights, that a plane is fitted to at least.
/// Why: three and a half: the point and two and a half others.
HSDM_TUNED double fewest = 3.5;

/// points: weight of a point's own normal in means over neighbours.
/// Why: by trial; half of one neighbour's: it is no better than theirs near a crease.
HSDM_TUNED double own_weight = 0.5;

/// reaches: neighbours that deviate less from their plane are flat.
/// Why: they tilt it by some 0.2 degrees.
HSDM_TUNED double flat_spread = 0.004;

/// squared slope: variance of a tilt that neighbours do not determine.
/// Why: six degrees, as beside a scan line without others near by.
HSDM_TUNED double most_variance = 0.01;

/// squared slope: of a tilt that is none of a smooth surface.
/// Why: 30 degrees.
HSDM_TUNED double most_square = 0.33;

/// share: of the reach; from this noise on refined normals are averaged over neighbours.
/// Why: about a tenth of the spacing: planes of one neighbourhood are two degrees off.
HSDM_TUNED double rough = 0.02;

} // namespace hsdm::estimation

// patches.hh
namespace hsdm::patches {

/// cosine: of normals of one patch, neighbour to neighbour.
/// Why: 32 degrees; by trial, below a sharp edge's angle.
HSDM_TUNED double least_cosine = 0.85;

/// sine: of the angle that the chord between two points of a patch may rise out of their planes.
/// Why: 17 degrees: half the angle of their normals on an arc.
HSDM_TUNED double steepest = 0.3;

/// share: of the chord, that the tolerance may allow instead.
/// Why: 30 degrees: steeper, the points are not beside each other.
HSDM_TUNED double most_rise = 0.5;

/// reaches: nearer points are compared by how far they lie off each other's planes, not by the angle of their
/// chord.
/// Why: by trial; two sides of a plate oppose each other even where the chord is slanted.
HSDM_TUNED double near_pair = 0.45;

} // namespace hsdm::patches

// outside.hh
namespace hsdm::views {

/// spacings: edge of the voxels of the empty space at least.
/// Why: by trial; with larger voxels walls and slits are not seen, with smaller ones the space leaks through
/// a sampled surface.
HSDM_TUNED double voxel_spacings = 3.7;

/// level: of these voxels at most.
/// Why: bounds the memory: the space is kept densely, two million voxels.
HSDM_TUNED int deepest = 7;

/// steps: of half a voxel that a patch looks ahead.
/// Why: two and a half voxels: the third place is beyond the neighbouring voxel on any slanted way.
HSDM_TUNED int steps = 5;

/// spacings: how far ahead of a patch a point of another sheet lies.
/// Why: by trial; under two, the least thickness that is promised, above what a patch bends.
HSDM_TUNED double off_plane = 1.6;

} // namespace hsdm::views

// orient_normals.hh, agglomerate.hh
namespace hsdm::turning {

/// pairs: of neighbouring points that a view of the outside counts for.
/// Why: half of those that a point is compared in; measured, one view in ten thousand is wrong, one pair in a
/// hundred.
HSDM_TUNED float view_weight = 4;

/// pairs: of neighbouring points that a point's own scanner counts for, where it is known.
/// Why: four times a view: it is measured, not concluded.
inline constexpr float sensor_weight = 16;

/// share: of the views that must fit the signs that came out, net of the others.
/// Why: three of four agree; of a shell thinner than voxels views are right as often as wrong.
inline constexpr double clear_views = 0.5;

/// share: of the evidence that the signs contradict, from which on sheets are looked at as layers.
/// Why: saves time where the evidence is at one; of layers a third of a percent and more is against any
/// signs.
inline constexpr double least_contradicted = 0.0025;

/// share: of the points whose sides are in question, that must face the sky, net of those turned away.
/// Why: twice what walls that face each other show it at their rims, a hundredth; of two layers of a surface
/// each is outermost somewhere, if only where a shift leaves an edge uncovered, a thirtieth.
inline constexpr double least_seeing = 0.02;

} // namespace hsdm::turning

// vote_on_normals.hh
namespace hsdm::normal_votes {

/// factor: that another normal's support must be of the point's own.
/// Why: by trial; less changes sides with noise.
HSDM_TUNED double clear_gain = 1.2;

/// points: that it must have more, where the own normal has no support.
/// Why: by trial.
HSDM_TUNED double least_support = 0.1;

} // namespace hsdm::normal_votes

// arcs.hh
namespace hsdm::arcs {

/// factor: how many more neighbours arcs must explain than a plane.
/// Why: by trial; nearer to one, rims of thin walls come out round, from 1.2 on mouths of bores close.
HSDM_TUNED double clear_gain = 1.15;

/// rounds: of turning.
/// Why: by trial; each reaches a neighbourhood farther and halves the errors; most points turn in three.
HSDM_TUNED int rounds = 10;

/// cosine: of a turn that neighbours need not follow.
/// Why: 0.8 degrees; by trial, below what they differ by.
HSDM_TUNED double still = 0.9999;

} // namespace hsdm::arcs

// steady_normals.hh
namespace hsdm::scattered_normals {

/// radians: the angle between the axes of most neighbours' given normals, from which on positions are asked.
/// Why: eight degrees; clean clouds stay below five, and normals of less noise than that do no harm.
HSDM_TUNED double least = 0.14;

} // namespace hsdm::scattered_normals

// mend_normals.hh
namespace hsdm::contradictions {

/// sine: of the rise of a chord out of a plane that both points are on.
/// Why: 12 degrees; by trial.
inline constexpr double flattest = 0.2;

/// sine: added to noise.deviations times the mean rise of flat pairs; what rises less is on one plane.
/// Why: half a degree, for clouds without noise.
inline constexpr double added_rise = 0.01;

/// flat pairs: to a steep one, with fewer of which the given axes lie askew to the surface.
/// Why: exact normals have next to no steep pairs, those of scanners and of smoothed coarse meshes one of
/// three; between them both ways of turning do equally well.
inline constexpr std::size_t flat_per_steep = 10;

/// pairs: that contradict each other at least.
/// Why: by trial; outliers cause some.
inline constexpr std::size_t fewest = 10;

/// pairs: opposed ones on one plane, of normals that were estimated, that leave their sides in doubt.
/// Why: a point is in four pairs, so that one stray does not make five.
inline constexpr std::size_t fewest_of_estimated = 5;

/// pairs: flat ones to each that is opposed.
/// Why: 0.05 %; measured clouds with right normals have less than 0.02 %.
inline constexpr std::size_t flat_per_opposed = 2000;

/// percent: of creased pairs that are opposed.
/// Why: by trial; thin parts and outliers cause some.
inline constexpr std::size_t creased_percent = 15;

} // namespace hsdm::contradictions
