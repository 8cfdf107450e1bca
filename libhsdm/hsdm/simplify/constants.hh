#pragma once
// Tuning values of adaptive grids, in the order of docs/adaptive.md. What half and double of each do:
// docs/constants.md.

#include "hsdm/core/tuned.hh"
#include "hsdm/types.hh"

#include <cstddef>

// simplify.hh: parts of the error bound, and rounds
namespace hsdm::bounds {

/// share: of the error, that the planes of a leaf or of a vertex may be missed by, root mean square.
/// Why: by trial; the largest distance is two or three times the root mean square.
HSDM_TUNED double planes_share = 0.35;

/// share: of planes_share, for places on the facets that a dropped vertex leaves.
/// Why: by trial, 0.6 of the error; with twice that places that are not looked at go too far.
HSDM_TUNED double drop_share = 1.75;

/// share: of the bound, for vertices of the fine mesh against the result.
/// Why: keeps what lies between points, but spikes of the fine mesh that no point has are no reason to follow
/// them.
HSDM_TUNED double vertex_share = 2;

/// voxels: between places on facets that are measured, in voxels of the fine mesh.
/// Why: with a voxel 1.4 times the error was found between places on sparse clouds.
HSDM_TUNED double place_spacing = 0.5;

/// members: of the leaves below that are joined to parts, facets of a vertex that flips give facets or that
/// may go; what has more stays as it is.
/// Why: bounds the work, which grows with the square; eight children of eight parts each.
inline constexpr std::size_t most_squared = 64;

} // namespace hsdm::bounds

// clusters.hh, divide_by_planes.hh
namespace hsdm::leaf_parts {

/// parts: of one piece of the surface in a leaf.
/// Why: the four edges of a rod; what needs more is left to smaller leaves.
HSDM_TUNED std::size_t most_parts = 4;

} // namespace hsdm::leaf_parts

// facet_field.hh
namespace hsdm::surroundings {

/// sides: from a facet to those whose normals are gathered with its own.
/// Why: by trial; some twenty-five facets, which levels noise and keeps strips of six facets apart.
HSDM_TUNED int most_sides_away = 3;

} // namespace hsdm::surroundings

// planar_patches.hh
namespace hsdm::flat_ground {

/// radians: spread of normals round a facet of flat ground, and of their mean from the plane's normal.
/// Why: 2 degrees: what noise within the error leaves of a plane.
HSDM_TUNED double flat_spread = 0.03;

/// share: of the patch's tolerance, for the core of flat ground.
/// Why: a quarter: the distance from a tangent goes with the square, so that round ground gains 1.7 times the
/// width beyond.
HSDM_TUNED double core_share = 0.25;

/// facets: of the core of flat ground at least.
/// Why: by trial; as many as surroundings have, fewer have no surroundings of their own.
HSDM_TUNED std::size_t least_facets = 30;

/// factor: by which a height may have grown while the facet waited.
/// Why: by trial; less looks at facets again and again, more takes them out of order.
inline constexpr double stale = 1.3;

} // namespace hsdm::flat_ground

// developable_regions.hh
namespace hsdm::developable {

/// share: of the larger spread of normals that the next one may have where a region begins.
/// Why: by trial; round ground that bends both ways has one near 1.
HSDM_TUNED double most_ratio = 0.35;

/// cosines: how far a mean normal's with the axis may be off the region's, while it grows.
/// Why: 5 degrees: the axis is not yet known well.
HSDM_TUNED double most_off = 0.08;

/// cosines: the same when margins are trimmed.
/// Why: 2 degrees: the axis is known by then, noise in gathered normals is below that.
HSDM_TUNED double most_off_trimmed = 0.03;

/// cosines: the same, root mean square over the region.
/// Why: 0.6 degrees: what bends two ways within the error has more.
HSDM_TUNED double most_deviation = 0.01;

/// share: of a cylinder's deviation that a cone's must not exceed.
/// Why: by trial; a cone fits always better, having one parameter more.
HSDM_TUNED double cone_share = 0.3;

/// facets: when the axis is fitted for the first time, and again whenever there are twice as many.
/// Why: as many as surroundings have, roughly: what comes sooner was fitted there.
HSDM_TUNED std::size_t first_refit = 40;

} // namespace hsdm::developable

// strips.hh
namespace hsdm::strips {

/// rounds: of fitting planes and letting them take over facets.
/// Why: both are settled by then.
HSDM_TUNED int rounds = 4;

/// radians: of the histogram of area by direction, by which strips' heights are evened out.
/// Why: by trial; fine against any strip, coarse against the noise of normals.
HSDM_TUNED double bin_width = 0.02;

/// share: of a region's area to one side; with less it goes all round and strips may begin anywhere.
/// Why: by trial; a closed shaft sums up to nothing but its rounding.
HSDM_TUNED double least_lean = 0.05;

/// factor: on the number of strips that the height asks for.
/// Why: a little less than it asks for, since strips of even height are not missed evenly.
HSDM_TUNED double growth = 0.95;

/// factor: on the number of strips where one turned too far, which tells nothing of heights.
/// Why: by trial.
inline constexpr double blind_growth = 3;

/// share: of the patch's tolerance, that a strip's facet may be off its plane.
/// Why: strips are missed by the tolerance at their middle and edges; single facets that noise lifts may be
/// more.
HSDM_TUNED double most_height = 1.5;

/// facets: of a strip at least.
/// Why: by trial; fewer have no direction of their own.
HSDM_TUNED Index least_facets = 8;

} // namespace hsdm::strips

// quadric.hh
namespace hsdm::quadrics {

/// share: of the largest eigenvalue; directions with less are left open. Of planes of facets.
/// Why: squared tangent of 8 degrees: round ground that bends by less within a leaf fixes no place along
/// itself.
HSDM_TUNED double least_angle = 0.02;

/// share: the same of planes that many facets share.
/// Why: squared tangent of 0.6 degrees: these are exact, and strips of a wide shaft meet at a few degrees.
HSDM_TUNED double least_shared_angle = 1e-4;

/// share: of the area with shared planes, that facets' own planes may have and count for nothing.
/// Why: by trial; slivers and crumpled spots beside a patch.
HSDM_TUNED double next_to_nothing = 0.01;

} // namespace hsdm::quadrics

// collapse_by_planes.hh, collapsing_mesh.hh
namespace hsdm::collapses {

/// shape: of triangles, 1 for an equilateral one; no change of the facets makes thinner ones.
/// Why: a fiftieth: long facets on rims and strips are the price of few, thinner ones have no reliable
/// normal.
HSDM_TUNED double least_shape = 0.02;

/// facets: of a vertex that others merge into.
/// Why: bounds the work; fans of more are the middles of discs.
HSDM_TUNED std::size_t most_facets = 24;

/// share: of the tolerance, that a vertex may be off its shared planes and count as where they meet.
/// Why: far below what is seen, far above rounding.
HSDM_TUNED double settled_share = 1e-3;

/// share: of the tolerance: what may be off a plane or a line that is called flat or straight, or may have
/// grown without being looked at again, and by which a neighbour may miss the planes more than the vertex
/// itself and stand for it.
/// Why: 0.035 of the error: what is cut anew there costs no error worth to be told.
HSDM_TUNED double straight_share = 0.1;

} // namespace hsdm::collapses

// remove_flat_vertices.hh
namespace hsdm::flat_vertices {

/// cosine: of normals beside an edge that is flat.
/// Why: 2 degrees, as flat ground.
HSDM_TUNED double flat_cosine = 0.9994;

} // namespace hsdm::flat_vertices

// decimate.hh
namespace hsdm::decimation {

/// share: of the tolerance; what goes wrong below is not merged at all.
/// Why: two halvings: what is wrong still has another cause.
inline constexpr double least_share = 0.2;

/// share: of all leaves; so few need not be merged.
/// Why: by trial; two in a hundred cost no facets worth another round.
inline constexpr double few_leaves = 0.02;

/// rings: of facets around something wrong in which leaves are kept.
/// Why: by trial; what lies farther off is not the cause.
HSDM_TUNED int most_rings = 4;

} // namespace hsdm::decimation

// remesh_by_flips.hh
namespace hsdm::flips {

/// sweeps: of flipping.
/// Why: bounds the work; by trial.
HSDM_TUNED int most_sweeps = 4;

/// factor: that a flip for shape gains at least.
/// Why: by trial; less goes to and fro with noise.
HSDM_TUNED double better_shape = 1.1;

/// share: of a diagonal's distance from the fine surface, that the other one must stay within.
/// Why: at most half as far off, so that nothing flips to and fro.
HSDM_TUNED double nearer_share = 0.5;

/// sine: of a corner that counts as reflex.
/// Why: straight ones do no harm, and a cut costs a facet.
HSDM_TUNED double reflex = -0.01;

/// sine: added to the corner of what was a quad before.
/// Why: by trial; it stays unless another quad is better by 17 degrees.
HSDM_TUNED double was_quad = 0.3;

} // namespace hsdm::flips
