#pragma once
// Tuning values of what is done to any mesh. What half and double of each do: docs/constants.md.

#include "hsdm/core/tuned.hh"

#include <cstddef>

// split_polygon.hh, which fill_holes.hh uses
namespace hsdm::quad_splitting {

/// radians: greatest bend of an edge inside or on a polygon, or between a hole's facets and those around.
/// Why: 149 degrees: pi is a facet folded back onto its neighbour; sharper tips than 31 degrees are better
/// left open.
inline constexpr double most_bend = 2.6;

/// weight: of a bend of a right angle against the square of its edge.
/// Why: by trial; flat ways round are taken if they are less than twice as long.
inline constexpr double bend_cost = 4;

/// radians: two triangles that bend more stay two.
/// Why: 60 degrees: a quad that bends more is drawn and cut differently by everybody.
HSDM_TUNED double quad_bend = 1.05;

/// sine: of the sharpest or bluntest corner of a quad.
/// Why: 12 degrees: worse ones are better two triangles.
HSDM_TUNED double least_corner = 0.2;

/// sine: of a corner that rounding may turn over.
/// Why: floats, which STL has, move a corner by a 10^5th of its sides at depth 8, as small a share of a model
/// as a voxel is.
inline constexpr double straight = 1e-4;

/// edges: of a polygon that is split exactly, larger ones lose their best ears first.
/// Why: bounds the work, which grows with the cube.
inline constexpr std::size_t exact_edges = 128;

} // namespace hsdm::quad_splitting

// collapse_edges.hh
namespace hsdm::edge_collapses {

/// share: twice a facet's area over its longest side squared; with less it has lost its area. A side over the
/// longest one likewise: with less its ends are one place.
/// Why: by trial; a hundredth of a square, the normal of less is rounding.
HSDM_TUNED double least_area = 0.01;

/// corners: of two facets that are united.
/// Why: two quads with an edge in common have six.
HSDM_TUNED std::size_t most_corners = 6;

} // namespace hsdm::edge_collapses

// small_components.hh: drop_splinters
namespace hsdm::splinters {

/// facets: of a closed splinter.
/// Why: ten quads round two grid points, cut in two; more are a part.
HSDM_TUNED std::size_t most_facets = 20;

/// facets: of one with a border.
/// Why: by trial; more are a piece of the surface.
HSDM_TUNED std::size_t most_open = 32;

/// facets: of a flat splinter, a closed one that encloses next to nothing.
/// Why: a disc of five voxels, both its sides; what is larger is a plate.
inline constexpr std::size_t most_flat = 64;

/// voxels: mean thickness of a flat splinter at most.
/// Why: a spacing, at three to a voxel: where noise parts one surface into two that face apart, they stay
/// that near.
inline constexpr double flat = 0.33;

/// spacings: mean thickness at most of what is layers of something else, where scans do not register.
/// Why: nearer sides are not told apart (docs/normals.md promises it from there on).
inline constexpr double layers_in_spacings = 2;

/// ratio: of the largest component's facets to a splinter's.
/// Why: by trial; beside a small part a small one is no splinter.
inline constexpr double least_ratio = 32;

} // namespace hsdm::splinters
