#pragma once
// Section 3.4.2: a sign (side, inside or outside) for each grid point, and crossings that agree with the
// signs, which is what closes the surface. See docs/sheets.md.

#include "hsdm/contour/crossings.hh"

namespace hsdm {

/// Chooses a side for every grid point near the surface and, on every edge, crossings that lead from the side
/// of its lower end to that of its upper end by turns. Where the standing ones do not, the cheapest change is
/// made: some are dropped, others restored or invented. So round each grid face as many crossings leave the
/// solid as enter it, and no side is left open but where the grid ends. With
/// `all_round` the data are known to go round the whole solid: a border costs as much as what would close it.
/// O(grid points), parallel.
Crossings label_grid_signs(const GridPoints& grid, std::vector<double> beliefs, const NormalSets& sets,
                           Crossings candidates, double voxel_size, bool all_round = false);

/// What the sheets round a grid point say of its side, without crossings: the sum of its distances to them,
/// weighted by nearness, over the sum of their absolute values; in units of signs::cost_of_belief, 1 if it is
/// outside all, -1 inside all. 0 if a sheet passes nearer than its error.
std::vector<double> beliefs_of_sheets(const LocalSheets& sheets, double voxel_size);

} // namespace hsdm
