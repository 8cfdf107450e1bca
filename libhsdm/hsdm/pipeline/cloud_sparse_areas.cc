#include "hsdm/pipeline/cloud_sparse_areas.hh"

#include "hsdm/core/chunks.hh"
#include "hsdm/core/large_vector.hh"
#include "hsdm/pipeline/bent_facets.hh"
#include "hsdm/pipeline/sparse_areas.hh"

#include <algorithm>
#include <cmath>

namespace hsdm {
namespace {

/// Voxels of the coarsest level that sparse points lie in or beside.
class NearSparse {
public:
    NearSparse(const std::vector<SparseVoxel>& sparse, int above, int depth, double voxel_size)
        : last_((std::int32_t{1} << depth) - 1), voxel_size_(voxel_size) {
        for (const SparseVoxel& voxel : sparse) {
            if (voxel.levels <= above) continue;
            const VoxelCoord at = morton_decode(voxel.code);
            codes_.push_back(voxel.code);
            for (const VoxelCoord& o : neighbor_offsets)
                codes_.push_back(code_of({at[0] + o[0], at[1] + o[1], at[2] + o[2]}));
        }
        sort_unique(codes_);
    }

    bool holds(const Vec3& place) const {
        VoxelCoord at;
        for (unsigned k = 0; k < 3; ++k)
            at[k] = static_cast<std::int32_t>(std::floor(place[k] / voxel_size_));
        return std::ranges::binary_search(codes_, code_of(at));
    }

private:
    /// What lies outside the cube counts as the voxel beside it.
    MortonCode code_of(VoxelCoord at) const {
        for (std::int32_t& c : at) c = std::clamp(c, 0, last_);
        const auto part = [&](unsigned k) { return static_cast<std::uint32_t>(at[k]); };
        return morton_encode(part(0), part(1), part(2));
    }

    std::int32_t last_;
    double voxel_size_;
    std::vector<MortonCode> codes_; // ascending
};

/// Places on the facets of the first rank that may lack points, to the ranks that have their cells.
ScratchCloud places_on(const ScratchCloud& cloud, const PolygonMesh& facets, double voxel_size,
                       const NearSparse& near_sparse) {
    ScratchCloud places = cloud.emptied_aside();
    places.fill([&](const ScratchCloud::PutRow& put_row) {
        if (!cloud.ranks().is_first()) return;
        const BentFacets bent(facets, voxel_size);
        for_each_in_order(facets.facet_count(), [&](std::size_t f) {
            bent.for_places(f, [&](const Vec3& p, const Vec3& n) {
                if (near_sparse.holds(p)) put_row({p[0], p[1], p[2], n[0], n[1], n[2]}, nullptr);
            });
        });
    });
    return places;
}

/// Three voxels of the coarsest level tell what points lack, and a place may lie one outside the cube.
int ghost_of(int levels) {
    return 4 << levels;
}

} // namespace

int levels_above_sparse(const ScratchCloud& cloud, std::size_t most_points) {
    SparseWindows windows(cloud.depth());
    cloud.for_groups(most_points, [&](const Octree& part) { windows.add(part); });
    windows.join(cloud.ranks());
    return windows.levels_above();
}

std::vector<SparseVoxel> sparse_voxels(ScratchCloud& cloud, int levels, const CloudPasses& passes) {
    const int to_coarsest = 3 * (morton_levels - (cloud.depth() - levels));
    const int to_finest = 3 * (morton_levels - cloud.depth());
    std::vector<SparseVoxel> own;
    const int ghost = ghost_of(levels);
    cloud.for_tiles(passes.plan(cloud, ghost), ghost, [&](const Octree& octree, const VoxelRange& range) {
        const OctreeLevel level = extract_level(octree, cloud.depth());
        const SparseAreas areas(octree, level, levels);
        for_each_in_order(octree.size(), [&](std::size_t p) {
            const int too_fine = areas.levels_too_fine(p);
            if (too_fine == 0 || !range.holds(octree.codes[p] >> to_finest)) return;
            const MortonCode code = octree.codes[p] >> to_coarsest;
            if (own.empty() || own.back().code != code) own.push_back({code, 0});
            own.back().levels = std::max(own.back().levels, too_fine);
        });
    });
    return values_of_all(cloud.ranks(), own);
}

ScratchCloud points_between(ScratchCloud& cloud, const PolygonMesh& facets, int levels, int above,
                            const std::vector<SparseVoxel>& sparse, const CloudPasses& passes) {
    const auto voxel_size = [&](int levels_above) {
        return cloud.no_points().voxel_size(cloud.depth() - levels_above);
    };
    const NearSparse near_sparse(sparse, above, cloud.depth() - levels, voxel_size(levels));
    const ScratchCloud places = places_on(cloud, facets, voxel_size(above), near_sparse);
    ScratchCloud between = cloud.emptied_aside();
    const int ghost = ghost_of(levels);
    cloud.for_tiles(passes.plan(cloud, ghost), ghost, [&](const Octree& octree, const VoxelRange& range) {
        const Octree candidates = places.octree_around(range, 0);
        if (candidates.size() == 0) return;
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
