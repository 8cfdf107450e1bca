#include "hsdm/normals/known_points.hh"

#include "hsdm/core/chunks.hh"
#include "hsdm/core/large_vector.hh"

#include <algorithm>

namespace hsdm {

/// A leaf of the part is one of the whole if the part has all of its voxel: what is farther off can only make
/// it smaller, and the points that it holds do not.
KnownPoints::KnownPoints(const Octree& octree, const Neighbors& neighbors, const HasAround& has_around)
    : neighbors_(neighbors), known_(large_vector<std::uint8_t>(octree.size())) {
    for_each_index(neighbors.leaf_level.size(), chunks::slow, [&](Index leaf) {
        const int level = neighbors.leaf_level[leaf];
        const Index begin = neighbors.leaf_first[leaf], end = neighbors.leaf_first[leaf + 1];
        const VoxelCoord voxel = morton_decode(octree.codes[begin] >> 3 * (morton_levels - level));
        const std::uint8_t known = has_around(voxel, level);
        for (Index i = begin; i < end; ++i) known_[i] = known;
    });
}

void KnownPoints::step() {
    std::vector<std::uint8_t> next = large_vector<std::uint8_t>(known_.size());
    for_each_index(next.size(), chunks::quick, [&](Index i) { next[i] = known_[i] && knows_around(i); });
    known_ = std::move(next);
}

void KnownPoints::step(const std::vector<Index>& points, int times) {
    std::vector<std::uint8_t> next = large_vector<std::uint8_t>(points.size());
    for (int time = 0; time < times; ++time) {
        for_each_index(points.size(), chunks::quick,
                       [&](Index k) { next[k] = known_[points[k]] && knows_around(points[k]); });
        for (std::size_t k = 0; k < points.size(); ++k) known_[points[k]] = next[k];
    }
}

void KnownPoints::step_leaves() {
    for_each_index(neighbors_.leaf_level.size(), chunks::quick, [&](Index leaf) {
        const Index begin = neighbors_.leaf_first[leaf], end = neighbors_.leaf_first[leaf + 1];
        if (!all(begin, end)) std::fill(known_.begin() + begin, known_.begin() + end, std::uint8_t{0});
    });
}

bool KnownPoints::all(std::size_t begin, std::size_t end) const {
    return std::all_of(known_.begin() + static_cast<std::ptrdiff_t>(begin),
                       known_.begin() + static_cast<std::ptrdiff_t>(end),
                       [](std::uint8_t k) { return k != 0; });
}

bool KnownPoints::all_around(std::size_t begin, std::size_t end) const {
    for (std::size_t i = begin; i < end; ++i)
        if (!knows_around(static_cast<Index>(i))) return false;
    return true;
}

bool KnownPoints::knows_around(Index point) const {
    return std::ranges::all_of(neighbors_.of(point), [&](Index j) { return known_[j] != 0; });
}

} // namespace hsdm
