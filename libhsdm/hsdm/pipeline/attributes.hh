#pragma once
// Colours and further scalars of the points, carried to the vertices.

#include "hsdm/octree/octree.hh"
#include "hsdm/polygon_mesh.hh"

namespace hsdm {

/// The points that were merged with one of the cloud, by its index there.
std::span<const Octree::Duplicate> duplicates_of(const Octree& octree, Index point);

/// A value per vertex v, the average over the points of voxel[v]: red, green, blue and alpha as uint8, every
/// scalar of the cloud under its own name, but for those that begin with `hsdm_` or have another's name; of
/// labels the majority's (the least of those in a tie). Beside them `hsdm_level`, the octree level. O(n) per
/// attribute, parallel.
std::vector<VertexProperty> average_attributes(const PointView& cloud, const Octree& octree,
                                               const OctreeLevel& level, std::span<const Index> voxel);

/// The same properties for vertices that each stand for many: vertex v's values go into vertex `into[v]` of
/// `count`. Whole numbers of colour channels (uint8) are rounded means, int32 are labels and decided by
/// majority, all others means over the finite values. `no_index` goes nowhere; every vertex has one that goes
/// into it. O(n) per property.
std::vector<VertexProperty> merge_attributes(std::span<const VertexProperty> properties,
                                             std::span<const Index> into, std::size_t count);

/// Gives vertices that have no point (`known` is 0) the colours and scalars of those around: the mean, of
/// labels the majority, vertex by vertex away from the known ones. O(corners). Properties of our own
/// (`hsdm_...`) stay.
void spread_attributes(PolygonMesh& mesh, std::vector<std::uint8_t> known);

} // namespace hsdm
