#pragma once
// Given normals that scatter while the positions they belong to do not.

#include "hsdm/normals/mend_normals.hh"

namespace hsdm {

/// Whether normals scatter so much that steady_normals is worth a look: the median angle between the axes of
/// points and their successors in octree order, or of a sample of them. What curvature makes of it is a few
/// degrees.
bool are_scattered(const Octree& octree);
/// The same of a sample of a cloud of `size` points.
bool are_scattered(const NormalSample& sample, std::size_t size);

/// Do normals scatter at most half as much as given ones, of such samples? Of clean normals both scatter
/// alike, to a tenth.
bool are_steadier(const NormalSample& told, const NormalSample& given, std::size_t size);
/// Gives a normal the axis that positions tell, and keeps its side, unless that is far from it. Returns
/// whether it did.
bool take_axis(const Vec3& told, Vec3& normal);

/// Gives normals the axes that the positions tell (estimate_normals), each with the side it had, where these
/// scatter at most half as much: then only the given ones are noisy. A normal far from what positions tell
/// stays, as on thin parts below the sampling. Returns how many got another axis; 0 if nothing changed. O(n),
/// parallel; the same bits for every number of threads.
std::size_t steady_normals(Octree& octree);

} // namespace hsdm
