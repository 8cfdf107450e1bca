#pragma once
// Section 3.4.1's normal sets on an adaptive grid: divides a connected piece of the surface in a cell that no
// single vertex can stand for into parts that face different ways.

#include "hsdm/simplify/quadric.hh"

#include <span>
#include <utility>
#include <vector>

namespace hsdm {

/// The minimiser of the planes' quadric, clamped to the box.
Vec3 place_in(const Quadric& planes, const Box& box);

/// Joins adjacent members, those with the smallest error of their joint planes first, while a point of the
/// box meets the planes of a part within `tolerance` (root mean square). Returns per member the least member
/// of its part; empty if more than four parts remain: then smaller cells serve the piece better. `adjacent`
/// holds pairs of members. O(members^3); for more than 64 members it returns empty at once.
std::vector<Index> divide_by_planes(std::span<const Quadric> members,
                                    std::span<const std::pair<Index, Index>> adjacent, const Box& box,
                                    double tolerance);

} // namespace hsdm
