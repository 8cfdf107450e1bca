#pragma once
// Given normals that scatter while the positions they belong to do not.

#include "hsdm/octree/octree.hh"

namespace hsdm {

/// Median angle in radians between the axes of normals of successive points in octree order, from a sample; 0
/// if there are none. What curvature makes of it is a few degrees.
double scatter_of_normals(const Octree& octree);

/// Whether normals scatter so much that steady_normals is worth a look.
bool are_scattered(const Octree& octree);

/// Gives normals the axes that the positions tell (estimate_normals), each with the side it had, where these
/// scatter at most half as much: then only the given ones are noisy. A normal far from what positions tell
/// stays, as on thin parts below the sampling. Returns how many got another axis; 0 if nothing changed. O(n),
/// parallel; the same bits for every number of threads.
std::size_t steady_normals(Octree& octree);

} // namespace hsdm
