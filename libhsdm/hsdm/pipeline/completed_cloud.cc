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

/// Per voxel, what a test says of the sources of its points.
template <class Test>
std::vector<std::uint8_t> voxels_where(const CompletedCloud& cloud, Test&& test) {
    std::vector<std::uint8_t> passed = large_vector<std::uint8_t>(cloud.level.size());
    const auto source = cloud.octree.source.begin();
    for_each_index(passed.size(), chunks::usual, [&](Index v) {
        passed[v] = test(source + cloud.level.first_point[v], source + cloud.level.first_point[v + 1]);
    });
    return passed;
}

} // namespace

std::vector<std::uint8_t> CompletedCloud::completed_voxels() const {
    return voxels_where(*this, [](auto begin, auto end) {
        return std::all_of(begin, end, [](Index source) { return source == no_index; });
    });
}

std::vector<std::uint8_t> CompletedCloud::measured_voxels() const {
    return voxels_where(*this, [](auto begin, auto end) { return std::any_of(begin, end, is_measured); });
}

CubeOfVoxels cube_around(const Box& box, const Vec3& origin, double voxel_size, int depth, double shift) {
    CubeOfVoxels cube{origin, depth};
    const double h = voxel_size;
    if (shift > 0) cube.origin -= Vec3(shift * h, shift * h, shift * h);
    for (unsigned k = 0; k < 3; ++k) {
        double& least = cube.origin[k];
        if (box.lo[k] < least) least -= h * std::ceil((least - box.lo[k]) / h);
        while (cube.depth < morton_levels && least + std::ldexp(h, cube.depth) < box.hi[k]) ++cube.depth;
    }
    return cube;
}

CompletedCloud complete_cloud(const Octree& octree, const OctreeLevel& level, const CompletedPoints& points,
                              double shift, Index source_of_added) {
    PointCloud cloud = joined_cloud(octree, points);
    Box box;
    for (const Vec3& p : cloud.positions) box.add(p);
    const CubeOfVoxels cube = cube_around(box, octree.origin, level.voxel_size, level.depth, shift);
    CompletedCloud completed;
    OctreeOptions options;
    options.merge_duplicates = false;
    options.origin = cube.origin;
    options.cube_extent = std::ldexp(level.voxel_size, cube.depth);
    completed.octree = build_octree_taking_normals(cloud, options);
    completed.octree.duplicates = octree.duplicates;
    for_each_index(completed.octree.size(), chunks::light, [&](Index i) {
        Index& source = completed.octree.source[i];
        if (source >= octree.size())
            source = source_of_added;
        else if (!octree.source.empty())
            source = octree.source[source];
    });
    completed.level = extract_level(completed.octree, cube.depth);
    release(completed.octree.codes);
    return completed;
}

} // namespace hsdm
