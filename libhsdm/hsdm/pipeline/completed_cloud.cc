#include "hsdm/pipeline/completed_cloud.hh"

#include "hsdm/core/chunks.hh"

#include <algorithm>
#include <cmath>

namespace hsdm {
namespace {

/// Both clouds one after the other, in the octree's units and its cloud's coordinates.
PointCloud joined_cloud(const Octree& octree, const CompletedPoints& points) {
    PointCloud cloud;
    cloud.positions = copy_of_large(octree.positions);
    append_large(cloud.positions, points.positions);
    cloud.normals = copy_of_large(octree.normals);
    append_large(cloud.normals, points.normals);
    for_each_index(cloud.positions.size(), chunks::light,
                   [&](Index i) { cloud.positions[i] += octree.origin; });
    return cloud;
}

/// How many levels give voxels of this size in a cube that holds a box.
int depth_for(const Box& box, double voxel_size) {
    int depth = 1;
    while (depth < morton_levels && std::ldexp(voxel_size, depth) < box.extent()) ++depth;
    return depth;
}

} // namespace

std::vector<std::uint8_t> CompletedCloud::completed_voxels() const {
    std::vector<std::uint8_t> completed = large_vector<std::uint8_t>(level.size());
    for_each_index(level.size(), chunks::usual, [&](Index v) {
        completed[v] = std::all_of(octree.source.begin() + level.first_point[v],
                                   octree.source.begin() + level.first_point[v + 1],
                                   [](Index source) { return source == no_index; });
    });
    return completed;
}

CompletedCloud complete_cloud(const Octree& octree, const OctreeLevel& level, const CompletedPoints& points) {
    PointCloud cloud = joined_cloud(octree, points);
    Box box;
    for (const Vec3& p : cloud.positions) box.add(p);
    const int depth = std::max(level.depth, depth_for(box, level.voxel_size));
    CompletedCloud completed;
    OctreeOptions options;
    options.merge_duplicates = false;
    options.cube_extent = std::max(std::ldexp(level.voxel_size, depth), box.extent());
    completed.octree = build_octree_taking_normals(cloud, options);
    completed.octree.duplicates = octree.duplicates;
    for_each_index(completed.octree.size(), chunks::light, [&](Index i) {
        Index& source = completed.octree.source[i];
        source = source < octree.size() ? octree.source[source] : no_index;
    });
    completed.level = extract_level(completed.octree, depth);
    return completed;
}

} // namespace hsdm
