#pragma once
// Section 3.4.1's normal sets on an adaptive grid: a connected piece of the surface in a cell that no single
// vertex can stand for, divided into parts that face different ways.

#include "hsdm/simplify/quadric.hh"

#include <span>
#include <utility>
#include <vector>

namespace hsdm {

/// Where a vertex for these planes lies that stays in the box.
Vec3 place_in(const Quadric& planes, const Box& box);

/// Joins adjacent members, those first that the joint planes miss least, while the planes of a part are met
/// within `tolerance` (root mean square) at one point of the box. Returns per member the least member of its
/// part; empty if more than four parts remain: then smaller cells serve the piece better. `adjacent` holds
/// pairs of members. O(members^3), and more than 64 members are refused.
std::vector<Index> divide_by_planes(std::span<const Quadric> members,
                                    std::span<const std::pair<Index, Index>> adjacent, const Box& box,
                                    double tolerance);

} // namespace hsdm
