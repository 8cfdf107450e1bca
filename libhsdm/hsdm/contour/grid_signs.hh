#pragma once
// Section 3.4.2: one side, inside or outside, per grid point, and crossings that agree with it. This is what
// closes the surface. See docs/sheets.md.

#include "hsdm/contour/crossings.hh"

namespace hsdm {

/// Chooses a side for every grid point near the surface and, on every edge, the crossings that lead from the
/// side of its lower end to that of its upper end by turns. The standing ones are taken back, the others
/// brought back and new ones made where that contradicts the fewest. Round a grid face the number of
/// crossings that leave is then that of those that enter, and no face is left open between grid points whose
/// sides are known. O(grid points), parallel.
Crossings label_grid_signs(const GridPoints& grid, const LocalSheets& sheets, const NormalSets& sets,
                           const CrossingCandidates& candidates, double voxel_size);

} // namespace hsdm
