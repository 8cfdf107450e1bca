#include "hsdm/basic/voxel_centroid.hh"

#include "hsdm/core/chunks.hh"
#include "hsdm/core/large_vector.hh"

namespace hsdm {

Vec3 voxel_centroid(const Octree& octree, const OctreeLevel& level, Index voxel) {
    const Index begin = level.first_point[voxel], end = level.first_point[voxel + 1];
    Vec3 sum(0, 0, 0);
    for (Index p = begin; p < end; ++p) sum += octree.positions[p];
    return sum / static_cast<double>(end - begin);
}

std::vector<Vec3> voxel_centroids(const Octree& octree, const OctreeLevel& level) {
    std::vector<Vec3> positions = large_vector<Vec3>(level.size());
    for_each_index(level.size(), chunks::quick,
                   [&](Index v) { positions[v] = voxel_centroid(octree, level, v); });
    return positions;
}

} // namespace hsdm
