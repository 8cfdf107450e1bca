#include "hsdm/pipeline/cloud_sparse_areas.hh"

#include "hsdm/core/chunks.hh"
#include "hsdm/core/interruption.hh"
#include "hsdm/core/large_vector.hh"
#include "hsdm/pipeline/bent_facets.hh"
#include "hsdm/pipeline/sparse_areas.hh"

namespace hsdm {
namespace {

/// Places all over the facets, to the ranks that have their cells.
ScratchCloud places_on(const ScratchCloud& cloud, const PolygonMesh& facets, double voxel_size) {
    ScratchCloud places = cloud.emptied_aside();
    places.fill([&](const ScratchCloud::PutRow& put_row) {
        if (!cloud.ranks().is_first()) return;
        const BentFacets bent(facets, voxel_size);
        for_each_in_order(facets.facet_count(), [&](std::size_t f) {
            bent.for_places(f, [&](const Vec3& p, const Vec3& n) {
                put_row({p[0], p[1], p[2], n[0], n[1], n[2]}, nullptr);
            });
        });
    });
    return places;
}

} // namespace

int levels_above_sparse(const ScratchCloud& cloud, std::size_t most_points) {
    SparseWindows windows(cloud.depth());
    cloud.for_groups(most_points, [&](const Octree& part) { windows.add(part); });
    windows.join(cloud.ranks());
    return windows.levels_above();
}

ScratchCloud points_between(ScratchCloud& cloud, const PolygonMesh& facets, int levels, int above,
                            const CloudPasses& passes) {
    const ScratchCloud places = places_on(cloud, facets, cloud.no_points().voxel_size(cloud.depth() - above));
    ScratchCloud between = cloud.emptied_aside();
    // Three voxels of the coarsest level tell, and a place may lie one outside the cube.
    const int ghost = 4 << levels;
    const std::vector<VoxelRange> ranges = passes.plan(cloud, ghost);
    cloud.for_tiles(ranges, ghost, [&](const Octree& octree, const VoxelRange& range) {
        const Octree candidates = places.octree_around(range, 0);
        const OctreeLevel level = extract_level(octree, cloud.depth());
        const SparseAreas areas(octree, level, levels);
        std::vector<std::uint8_t> lacking = large_vector<std::uint8_t>(candidates.size());
        for_each_index(candidates.size(), chunks::slow, [&](Index i) {
            lacking[i] = areas.lacks(candidates.positions[i], candidates.normals[i], above);
        });
        for_each_in_order(candidates.size(), [&](std::size_t i) {
            if (lacking[i]) between.add(candidates, i);
        });
    });
    between.finish_sorted();
    return between;
}

} // namespace hsdm
