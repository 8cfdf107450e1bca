#include "hsdm/normals/neighbors.hh"

#include "hsdm/core/check_option.hh"
#include "hsdm/core/chunks.hh"
#include "hsdm/core/interruption.hh"
#include "hsdm/core/lanes.hh"
#include "hsdm/core/large_vector.hh"
#include "hsdm/normals/constants.hh"
#include "hsdm/normals/near_lanes.hh"

#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <numeric>

namespace hsdm {
namespace {

/// At most so many points of one voxel of the finest level are searched together. With all of them time would
/// grow with their square for clouds whose parts lie so far apart that each is in few voxels.
constexpr Index crowd = 256;

/// A run of points in one voxel.
struct Leaf {
    Index begin, end;
    int level;
    Index slot; ///< index of its first point in the result
};

/// The largest voxels that hold at most leaf_points points (or are as small as voxels get: at most a crowd).
std::vector<Leaf> find_leaves(std::span<const MortonCode> codes) {
    std::vector<Leaf> leaves;
    leaves.reserve(codes.size() / 4 + 1);
    for (std::size_t i = 0, end = 0; i < codes.size(); i = end) {
        if (leaves.size() % chunks::quick == 0) Interruption::poll();
        int level = i == 0 ? 0 : split_level(codes[i - 1], codes[i]);
        if (i + neighborhoods::leaf_points < codes.size())
            level = std::max(level, split_level(codes[i], codes[i + neighborhoods::leaf_points]));
        level = std::min(level, morton_levels);
        const int shift = 3 * (morton_levels - level);
        const std::size_t last = level < morton_levels ? codes.size() : std::min(codes.size(), i + crowd);
        for (end = i + 1; end < last && codes[end] >> shift == codes[i] >> shift;) ++end;
        leaves.push_back({static_cast<Index>(i), static_cast<Index>(end), level, static_cast<Index>(i)});
    }
    return leaves;
}

std::array<std::size_t, morton_levels + 1> count_leaves(const std::vector<Leaf>& leaves) {
    std::array<std::size_t, morton_levels + 1> counts{};
    for (const Leaf& leaf : leaves) ++counts[static_cast<std::size_t>(leaf.level)];
    return counts;
}

constexpr std::size_t lanes = 4;

Float4 lanes_at(const std::vector<float>& values, std::size_t place) {
    Float4 result;
    std::memcpy(&result, values.data() + place, sizeof(result));
    return result;
}

/// The points of the voxels around one, relative to that one's first: float suffices to rank distances.
struct Candidates {
    /// level and code of the middle voxel; leaves next to each other share candidates if these are equal
    int level = -1;
    MortonCode code = 0;
    Vec3 base{0, 0, 0};
    std::vector<float> x, y, z; ///< room for more than there are
    std::vector<Index> id;

    void add(const Octree& octree, Index begin, Index end) {
        const std::size_t old = id.size(), size = old + (end - begin);
        id.resize(size);
        for (std::vector<float>* axis : {&x, &y, &z})
            if (axis->size() < size + NearLanes::most) axis->resize(2 * size + NearLanes::most);
        const std::array<float*, 3> to{x.data() + old, y.data() + old, z.data() + old};
        const Vec3* const from = octree.positions.data() + begin;
        const Vec3 origin = base; // of its own, which no value written can be
        for (Index c = 0; c < end - begin; ++c) {
            id[old + c] = begin + c;
            for (unsigned axis = 0; axis < 3; ++axis)
                to[axis][c] = static_cast<float>(from[c][axis] - origin[axis]);
        }
    }
};

/// Selects the candidates nearest to a point: finds a squared distance within which there are exactly as many
/// as wanted, by a search over distances, so that hardly any branch is unpredictable and nothing is sorted.
class Selection {
public:
    /// Finds the `wanted` nearest, or all if there are fewer; ties by place. `limit` is a squared distance
    /// that should hold enough; if it does not, another pass is made. Returns the squared distance of the
    /// farthest.
    float find(const Candidates& candidates, const std::array<float, 3>& point, std::size_t wanted,
               float limit) {
        limit = std::min(limit, beyond_all);
        find_near(candidates, point, limit);
        if (count_ < wanted) {
            all_are_near(candidates.id.size());
            limit = farthest_within(beyond_all);
        }
        return take(wanted, limit);
    }
    std::span<const Index> places() const { return {near_.data(), count_}; }

private:
    /// Distances that overflow, and NaN, count as this.
    static constexpr float beyond_all = std::numeric_limits<float>::max();

    void find_near(const Candidates& candidates, const std::array<float, 3>& point, float limit) {
        const std::size_t size = candidates.id.size();
        distance_.resize(size + NearLanes::most);
        near_.resize(size + NearLanes::most);
        near_distance_.resize(size + 2 * NearLanes::most);
        count_ = lanes_.find({{candidates.x.data(), candidates.y.data(), candidates.z.data()}, size}, point,
                             limit, {distance_.data(), near_.data(), near_distance_.data()});
        fill_up();
    }
    void all_are_near(std::size_t size) {
        count_ = size;
        for (std::size_t c = 0; c < size; ++c) {
            near_[c] = static_cast<Index>(c);
            near_distance_[c] = distance_[c] < beyond_all ? distance_[c] : beyond_all;
        }
        fill_up();
    }
    /// Fills the unused lanes with distances beyond any limit.
    void fill_up() {
        for (std::size_t k = count_; k < padded(count_); ++k)
            near_distance_[k] = std::numeric_limits<float>::infinity();
    }
    static std::size_t padded(std::size_t size) {
        return (size + NearLanes::most - 1) / NearLanes::most * NearLanes::most;
    }

    /// Narrows the interval of squared distances: of those near, `below` lie within `low` (too few), more
    /// than wanted within `high`. On a surface sampled evenly their number grows with the squared distance.
    float take(std::size_t wanted, float high) {
        constexpr int most_looks = 8; // more would not help if distances are equal
        float low = -1;
        std::size_t below = 0, within = count_;
        for (int look = 0; look < most_looks && within > wanted; ++look) {
            const float least = std::max(low, 0.0f);
            const float share = static_cast<float>(wanted - below) / static_cast<float>(within - below);
            const float middle = least + (high - least) * share;
            if (const std::size_t found = count_within(middle); found < wanted)
                low = middle, below = found;
            else
                high = middle, within = found;
        }
        if (within == wanted) {
            const float farthest = farthest_within(high);
            keep(high);
            return farthest;
        }
        rank(low, high);
        const auto [farthest, last] = ranked_[wanted - below - 1];
        keep_up_to(farthest, last);
        return farthest;
    }

    /// Sorts those near that are beyond `low` and within `high`, nearest first.
    void rank(float low, float high) {
        ranked_.clear();
        for (std::size_t k = 0; k < count_; ++k)
            if (near_distance_[k] > low && near_distance_[k] <= high)
                ranked_.emplace_back(near_distance_[k], near_[k]);
        std::sort(ranked_.begin(), ranked_.end());
    }
    /// Those nearer, and of those as far the ones up to a place; they stay in the order of places, which does
    /// not depend on how the distance was found.
    void keep_up_to(float farthest, Index last) {
        std::size_t kept = 0;
        for (std::size_t k = 0; k < count_; ++k)
            if (near_distance_[k] < farthest || (near_distance_[k] == farthest && near_[k] <= last))
                near_[kept++] = near_[k];
        count_ = kept;
    }
    void keep(float limit) { count_ = lanes_.keep(near_distance_.data(), count_, limit, near_.data()); }

    std::size_t count_within(float limit) const { return lanes_.count(near_distance_.data(), count_, limit); }
    float farthest_within(float limit) const {
        Float4 most{};
        for (std::size_t k = 0; k < count_; k += lanes) {
            const Float4 distance = lanes_at(near_distance_, k);
            most = max_lanes(most, distance <= limit ? distance : Float4{});
        }
        return std::max(std::max(most[0], most[1]), std::max(most[2], most[3]));
    }

    const NearLanes& lanes_ = near_lanes().front();
    std::vector<float> distance_;      // squared, of all candidates
    std::vector<Index> near_;          // places of those within the limit, then of those taken
    std::size_t count_ = 0;            // of these
    std::vector<float> near_distance_; // of those within the limit
    std::vector<std::pair<float, Index>> ranked_;
};

class Search {
public:
    /// The neighbours of `points`, or of all if that is null.
    Search(const Octree& octree, const std::vector<Index>* points, std::optional<int> finest_level,
           Neighbors& result)
        : octree_(octree), points_(points), result_(result) {
        std::vector<Leaf> leaves = find_leaves(octree.codes);
        const int finest = finest_level ? *finest_level : finest_leaves(count_leaves(leaves));
        for (Leaf& leaf : leaves) leaf.level = std::min(leaf.level, finest);
        if (points) keep_leaves_of(*points, leaves);
        if (leaves.empty()) return;
        int deepest = 0;
        for (const Leaf& leaf : leaves) deepest = std::max(deepest, leaf.level);
        levels_.resize(static_cast<std::size_t>(deepest) + 1);
        levels_.back() = extract_level(octree, deepest);
        for (auto level = levels_.size() - 1; level-- > 0;)
            levels_[level] = coarser_level(levels_[level + 1], static_cast<int>(level));
        if (!points) resize_large(result.leaf_level, leaves.size());
        tbb::enumerable_thread_specific<Scratch> scratch;
        for_chunks(leaves.size(), chunks::heavy, [&](std::size_t begin, std::size_t end, std::size_t) {
            Scratch& own = scratch.local();
            float limit = 0; // not known yet
            for (std::size_t l = begin; l < end; ++l) {
                limit = search_leaf(leaves[l], limit, own);
                if (!points) result.leaf_level[l] = static_cast<std::uint8_t>(own.candidates.level);
            }
        });
        if (points) return;
        result.leaf_first.reserve(leaves.size() + 1);
        for (const Leaf& leaf : leaves) result.leaf_first.push_back(leaf.begin);
        result.leaf_first.push_back(static_cast<Index>(octree.size()));
    }

private:
    struct Scratch {
        Candidates candidates;
        Selection selection;
    };

    static void keep_leaves_of(const std::vector<Index>& points, std::vector<Leaf>& leaves) {
        std::size_t kept = 0;
        Index slot = 0;
        for (Leaf leaf : leaves) {
            leaf.slot = slot;
            while (slot < points.size() && points[slot] < leaf.end) ++slot;
            if (slot > leaf.slot) leaves[kept++] = leaf;
        }
        leaves.resize(kept);
    }

    /// The voxels around one, and that itself; returns how many points they hold.
    std::size_t around(MortonCode code, int level, std::array<Index, 27>& voxels, std::size_t& count) const {
        const OctreeLevel& grid = levels_[static_cast<std::size_t>(level)];
        VoxelsAround beside(grid, code);
        std::size_t points = 0;
        count = 0;
        VoxelCoord step;
        for (step[2] = -1; step[2] <= 1; ++step[2])
            for (step[1] = -1; step[1] <= 1; ++step[1])
                for (step[0] = -1; step[0] <= 1; ++step[0]) {
                    const Index v = beside.find(step);
                    if (v == no_index) continue;
                    voxels[count++] = v;
                    points += grid.first_point[v + 1] - grid.first_point[v];
                }
        return points;
    }

    /// The candidates of a leaf: of the finest level that has enough, often those of the leaf before.
    void find_candidates(const Leaf& leaf, Candidates& candidates) const {
        std::array<Index, 27> voxels;
        std::size_t count = 0;
        for (int level = leaf.level;; --level) {
            const MortonCode code = octree_.codes[leaf.begin] >> (3 * (morton_levels - level));
            if (candidates.level == level && candidates.code == code && level < morton_levels) return;
            if (around(code, level, voxels, count) < neighborhoods::candidates_per_neighbor * result_.count
                && level > 0)
                continue;
            candidates.level = level;
            candidates.code = code;
            return gather(leaf, {voxels.data(), count}, candidates);
        }
    }

    void gather(const Leaf& leaf, std::span<const Index> voxels, Candidates& candidates) const {
        const OctreeLevel& grid = levels_[static_cast<std::size_t>(candidates.level)];
        candidates.base = octree_.positions[grid.first_point[grid.find(candidates.code)]];
        candidates.id.clear();
        for (Index v : voxels) {
            Index first = grid.first_point[v], last = grid.first_point[v + 1];
            if (candidates.level == morton_levels && last - first > 2 * crowd) { // next to the leaf in order
                first = std::clamp(leaf.begin, first + crowd / 2, last - 3 * crowd / 2) - crowd / 2;
                last = first + 2 * crowd;
            }
            candidates.add(octree_, first, last);
        }
    }

    /// Takes and returns a squared distance within which the next point should find enough.
    float search_leaf(const Leaf& leaf, float limit, Scratch& scratch) const {
        find_candidates(leaf, scratch.candidates);
        if (points_)
            for (Index slot = leaf.slot; slot < points_->size() && (*points_)[slot] < leaf.end; ++slot)
                limit = search_point((*points_)[slot], slot, limit, scratch);
        else
            for (Index i = leaf.begin; i < leaf.end; ++i) limit = search_point(i, i, limit, scratch);
        return limit;
    }

    float search_point(Index i, Index slot, float limit, Scratch& scratch) const {
        const Vec3 p = octree_.positions[i] - scratch.candidates.base;
        const std::array<float, 3> point{static_cast<float>(p[0]), static_cast<float>(p[1]),
                                         static_cast<float>(p[2])};
        const std::size_t wanted = result_.count + 1; // the point itself is among them
        const float farthest = scratch.selection.find(scratch.candidates, point, wanted, limit);
        Index* out = result_.index.data() + slot * result_.count;
        std::size_t found = 0;
        for (Index place : scratch.selection.places()) {
            const Index id = scratch.candidates.id[place];
            if (id != i && found < result_.count) out[found++] = id;
        }
        result_.reach[slot] = std::sqrt(static_cast<double>(farthest));
        return 1.5f * farthest;
    }

    const Octree& octree_;
    const std::vector<Index>* points_;
    Neighbors& result_;
    std::vector<OctreeLevel> levels_;
};

Neighbors search(const Octree& octree, const std::vector<Index>* points, const NeighborOptions& options) {
    check_option(options.count >= 3 && options.count <= 64, "neighbours", options.count, "lie in [3, 64]");
    Neighbors result;
    result.count = std::min(static_cast<std::size_t>(options.count), octree.size() - 1);
    const std::size_t size = points ? points->size() : octree.size();
    resize_large(result.index, size * result.count);
    resize_large(result.reach, size);
    const Search done(octree, points, options.finest_level, result);
    return result;
}

} // namespace

std::array<std::size_t, morton_levels + 1> count_leaves(std::span<const MortonCode> codes) {
    return count_leaves(find_leaves(codes));
}

/// If few leaves are on the deepest level, that level is not worth building: they are searched one level
/// above, where a voxel holds at most eight of them.
int finest_leaves(const std::array<std::size_t, morton_levels + 1>& leaves) {
    constexpr std::size_t few = 64; // one in so many
    int deepest = morton_levels;
    while (deepest > 0 && leaves[static_cast<std::size_t>(deepest)] == 0) --deepest;
    const std::size_t all = std::accumulate(leaves.begin(), leaves.end(), std::size_t{0});
    if (deepest == morton_levels || few * leaves[static_cast<std::size_t>(deepest)] >= all) return deepest;
    return deepest - 1;
}

Neighbors find_neighbors(const Octree& octree, const NeighborOptions& options) {
    return search(octree, nullptr, options);
}

Neighbors find_neighbors_of(const Octree& octree, const std::vector<Index>& points,
                            const NeighborOptions& options) {
    return search(octree, &points, options);
}

} // namespace hsdm
