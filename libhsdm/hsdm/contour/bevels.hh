#pragma once
// Faces between two creases in one voxel: chamfers of less than a voxel. See docs/sheets.md.

#include "hsdm/contour/crossing_pairs.hh"

namespace hsdm {

/// Does a face of normal `c` lie between two of normals `a` and `b`, along the crease that these would have
/// without it? It makes a crease with either.
bool lies_between(const Vec3& a, const Vec3& c, const Vec3& b);

/// Is a set flat, rather than a part of a round surface that turns from one crossing to another?
bool is_flat_between(const GridPoints& grid, const Crossing& a, const NormalSet& set, const Crossing& b,
                     double voxel_size);

/// Marks the links between two sheets that do not meet in the link's grid face, since the plane of a third,
/// whose points lie near, cuts their crease off there. Returns their number. O(links), parallel.
std::size_t mark_bevels(const GridPoints& grid, const Crossings& crossings, const NormalSets& sets,
                        double voxel_size, Links& links);

} // namespace hsdm
