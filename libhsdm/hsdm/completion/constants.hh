#pragma once
// What decides how a surface is completed, in the order of docs/completion.md.

#include <cstddef>

namespace hsdm::completing {

/// lattice cells along the longest side of the mesh on the coarsest level, at most: a hole that is wide
/// against the mesh is seen whole there, and finer levels are looked at only where it passes.
inline constexpr int coarsest_cells = 32;

/// of the mesh's longest side: the room around it, whose end is outside. Half as far changes what bulges from
/// a border by a twentieth of the border's width.
inline constexpr double margin = 0.25;

/// lattice cells: so far around the zero level of the coarser level, and around boundary edges, a level is
/// solved. One coarse cell, by which it may move.
inline constexpr int band = 2;

/// of the values' size: where conjugate gradients stop. A hundredth of a cell.
inline constexpr double tolerance = 1e-3;

/// steps: of conjugate gradients at most; bounds the work. As many as the widest band has cells would do.
inline constexpr int most_steps = 2000;

/// of the patch's size: where the same stops for a membrane. A hundredth of a cell in a thousand.
inline constexpr double membrane_tolerance = 1e-6;

/// lattice cells: so far beyond its border the mesh takes part in a patch, to hold it. Two rings of
/// vertices give it position and slope.
inline constexpr int rim = 2;

/// sine of 58 degrees: a membrane that leaves the mesh at a greater angle meets it in a crease, else it goes
/// on smoothly. Across a round part a membrane leaves at half the angle that the surface turns by, and at
/// more where the hole is round, too; across the end of a straight one at 90 degrees, less what noise tilts.
/// By trial: with 53 degrees caps of balls are flatter, with 60 to 64 noisy ends of straight walls bulge.
inline constexpr double crease_sine = 0.85;

/// edges of the patch: so far from the border that angle is measured.
/// Why: a border of points is ragged by a cell or two, in whose notches the patch goes on along the mesh.
inline constexpr int crease_reach = 5;

/// rounds: of levelling the mesh's normals at the border.
/// Why: by trial; none lets caps follow noise, three do less. The rim is two rings of vertices wide.
inline constexpr int slope_rounds = 6;

/// keeps patches that nothing holds where they are; small against the least stiffness of a patch a thousand
/// cells wide.
inline constexpr double hold = 1e-12;

/// vertices: of patches that bend as plates do, all together; more stay membranes. Factors of a plate's
/// matrix take some 2 KB a vertex: 100 MB.
inline constexpr std::size_t most_bending = 50000;

/// points along each side of a cell of a patch: nine to a voxel, as three spacings to a voxel have.
inline constexpr int samples = 3;

/// voxels: so far the grid is moved, along all axes, for what completes everything.
/// Why: half a voxel is farthest from where it was; in the same voxels the contradictions that ended the
/// facets come up again: of nine real scans three came out sound, and seven with the grid moved.
inline constexpr double shift = 0.5;

} // namespace hsdm::completing

// free_space.hh
namespace hsdm::seeing {

/// points: in the bins of directions that half of a scanner's points lie in, at least.
/// Why: nine bins around a place then hold 36, of which some hit what stands in front of it, if that is not
/// thinner than a spacing.
inline constexpr std::size_t points_per_bin = 4;

/// voxels: what is less in front of a point is not known to be free.
/// Why: noise and what scans are apart are less than a voxel where a surface is made of them at all; twice
/// that.
inline constexpr double margin = 2;

} // namespace hsdm::seeing

// slits.hh
namespace hsdm::slits {

/// ratio: of the sides of a rectangle that a loop is as slender as, or whose longer sides face as much one
/// way and back, to be a slit, at least. Why: the ends of narrow pipes are borders, and few pipes are that
/// flat.
inline constexpr double least_ratio = 6;

/// edges: longer loops are no slits.
/// Why: what closes them is found in the square of their length; bounds it to a second.
inline constexpr std::size_t most_edges = 4096;

} // namespace hsdm::slits

// bores.hh
namespace hsdm::bores {

/// share: of a bore's radius, that its axis may miss the centre of the other end by, and the radii differ.
/// Why: two ends placed by chance on faces a few radii wide miss each other's quarter in 99 of 100.
inline constexpr double most_miss = 0.25;

} // namespace hsdm::bores

// continued_walls.hh, continued_space.hh
namespace hsdm::continuing {

/// voxels: so far around a side of the border its surrounding is looked at, up to creases.
/// Why: what shows of a bore's wall is often no deeper; less than two rings of facets tell no bend.
inline constexpr double reach = 4;

/// voxels squared: of a surrounding with less area nothing is told.
/// Why: a strip two voxels wide, as long as the reach, less what the border's notches take.
inline constexpr double least_area = 4;

/// radians a voxel: a wall that bends by less is straight. Why: 48 voxels on it is off by a fifth of its
/// length; what ends farther away than that is confirmed from there, or does not count.
inline constexpr double most_bend = 0.01;

/// cosine of 8 degrees: directions that differ by less are one. Why: that much the normals of few facets err;
/// faces of a part differ by more.
inline constexpr double one_direction = 0.99;

/// voxels: of the border that lies on a plane, at least, for its normal to count.
/// Why: one side is ragged; the edge of a bore three voxels wide is as long.
inline constexpr double least_length = 3;

/// sine of 30 degrees: planes that meet at less tell no axis.
/// Why: noise of a normal turns what they have in common by twice as much.
inline constexpr double least_sine = 0.5;

/// sine of 12 degrees: a side of a wall that leads less along an axis does not go on along it.
/// Why: half of what a ragged border's sides turn by; at a right angle to the border it is one.
inline constexpr double least_lead = 0.2;

/// sine of 17 degrees: the slope of a wall to its axis, at most.
/// Why: over two ends' reach it is off by a third of that; drafts are less.
inline constexpr double wall = 0.3;

/// sine of 9 degrees: what leans more to an axis does not tell where it leads.
/// Why: half of `wall`; rounded edges, which lean so, turned axes by up to 12 degrees.
inline constexpr double straight_wall = 0.15;

/// share: how much the normals of walls spread round their axis, at least (`WallsRound::spread`).
/// Why: two parallel faces have any axis along them, and none; it is 0.2 of a slot four times as long as
/// wide.
inline constexpr double least_spread = 0.1;

/// share: of a loop's length that lies on walls of an axis, at least.
/// Why: one wall of a square bore is a quarter of its edge; two or more tell a bore.
inline constexpr double least_walls = 0.3;

/// axes of a mesh, at most: bounds the work. Why: drilled parts have three to eight, meshes of noise
/// hundreds.
inline constexpr std::size_t most_axes = 16;

/// cells along the mesh, at most: bounds the work of a cut to 140,000 grid points.
inline constexpr double most_cells = 48;

/// share: of its area that a surface along walls costs.
/// Why: a square bore goes on for as much as ten times its width in place of two lids.
inline constexpr double wall_cost = 0.05;

/// share: of its area that a surface along walls costs which nothing confirms from the far end.
/// Why: walls from both ends drift apart by more than a cell in places; one in six of a bore's may and it
/// still costs less than two lids do. By trial; with 1 a third more of made parts stay closed.
inline constexpr double guess_cost = 0.3;

/// cells: of the grid, that space is deep straight in from its lids, at least, in the mean, to be opened.
/// Why: the least surface of a grid stands a cell off here or there; what is no deeper than its two sides is
/// a face that stands elsewhere, not a bore.
inline constexpr double least_depth = 2;

} // namespace hsdm::continuing
