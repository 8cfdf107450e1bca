#include "hsdm/normals/neighbors.hh"

#include "hsdm/chunks.hh"
#include "hsdm/errors.hh"

#include <tbb/enumerable_thread_specific.h>

#include <bit>
#include <cmath>
#include <numeric>

namespace hsdm {
namespace {

constexpr std::size_t leaf_points = 12;
constexpr std::size_t leaves_per_chunk = 256;
/// Of a voxel of the finest level so many points are looked at together: were it all of them, time would grow
/// with their square where a cloud's parts lie so far apart that each is in few voxels.
constexpr Index crowd = 256;
/// So many candidates per neighbour wanted keep the nearest away from the rim of the 27 voxels.
constexpr std::size_t candidates_per_neighbor = 4;

/// Stands for voxels outside the cube; no code has this bit.
constexpr MortonCode beyond = MortonCode{1} << 63;

/// A run of points in one voxel.
struct Leaf {
    Index begin, end;
    int level;
    Index slot; ///< where its first point's neighbours go
};

/// The first level at which two codes lie in different voxels; morton_levels + 1 if equal.
int split_level(MortonCode a, MortonCode b) {
    if (a == b) return morton_levels + 1;
    return morton_levels - (63 - std::countl_zero(a ^ b)) / 3;
}

/// The largest voxels that hold at most leaf_points points (or are as small as voxels get: at most a crowd).
std::vector<Leaf> find_leaves(const std::vector<MortonCode>& codes) {
    std::vector<Leaf> leaves;
    leaves.reserve(codes.size() / 4 + 1);
    for (std::size_t i = 0, end = 0; i < codes.size(); i = end) {
        int level = i == 0 ? 0 : split_level(codes[i - 1], codes[i]);
        if (i + leaf_points < codes.size())
            level = std::max(level, split_level(codes[i], codes[i + leaf_points]));
        level = std::min(level, morton_levels);
        const int shift = 3 * (morton_levels - level);
        const std::size_t last = level < morton_levels ? codes.size() : std::min(codes.size(), i + crowd);
        for (end = i + 1; end < last && codes[end] >> shift == codes[i] >> shift;) ++end;
        leaves.push_back({static_cast<Index>(i), static_cast<Index>(end), level, static_cast<Index>(i)});
    }
    return leaves;
}

/// The candidates of one leaf, relative to its first point: float suffices to rank distances.
struct Candidates {
    std::vector<float> x, y, z; ///< room for more than there are
    std::vector<Index> id;

    void clear() { id.clear(); }
    void add(const Octree& octree, Index begin, Index end, const Vec3& base) {
        const std::size_t old = id.size(), size = old + (end - begin);
        id.resize(size);
        for (std::vector<float>* axis : {&x, &y, &z})
            if (axis->size() < size) axis->resize(2 * size);
        for (std::size_t c = old; c < size; ++c) {
            const Index i = id[c] = begin + static_cast<Index>(c - old);
            const Vec3 p = octree.positions[i] - base;
            x[c] = static_cast<float>(p[0]);
            y[c] = static_cast<float>(p[1]);
            z[c] = static_cast<float>(p[2]);
        }
    }
};

/// The candidates nearest to a point. They are counted in rings of equal area, so that hardly a comparison
/// decides where the processor goes on: all rings but the last wanted are taken whole, and few are on that.
class Selection {
public:
    /// Finds the `wanted` nearest, ties by place, where there are so many. Within the squared distance
    /// `limit` there should be enough; it costs another look if there are not. Returns the squared distance
    /// of the farthest.
    float find(const Candidates& candidates, const std::array<float, 3>& point, std::size_t wanted,
               float limit) {
        measure(candidates, point);
        near_.resize(distance_.size() + 1);
        if (find_near(limit) < wanted) {
            limit = *std::max_element(distance_.begin(), distance_.end());
            count_ = distance_.size();
            std::iota(near_.begin(), near_.end(), Index{0});
        }
        count_rings(limit);
        return take(wanted);
    }
    std::span<const Index> places() const { return {near_.data(), count_}; }

private:
    static constexpr std::size_t rings = 64;

    void measure(const Candidates& candidates, const std::array<float, 3>& point) {
        distance_.resize(candidates.id.size());
        const auto [px, py, pz] = point;
        for (std::size_t c = 0; c < distance_.size(); ++c) {
            const float dx = candidates.x[c] - px, dy = candidates.y[c] - py, dz = candidates.z[c] - pz;
            distance_[c] = dx * dx + dy * dy + dz * dz;
        }
    }

    std::size_t find_near(float limit) {
        count_ = 0;
        for (std::size_t c = 0; c < distance_.size(); ++c) {
            near_[count_] = static_cast<Index>(c);
            count_ += distance_[c] <= limit;
        }
        return count_;
    }

    void count_rings(float limit) {
        const float scale = rings / limit;
        ring_.resize(count_);
        in_ring_.fill(0);
        for (std::size_t k = 0; k < count_; ++k) {
            const float ring = distance_[near_[k]] * scale;
            // Where distances underflow or overflow, what is no number belongs to the last ring, too.
            ring_[k] = ring < rings - 1.0f ? static_cast<std::uint32_t>(ring) : rings - 1;
            ++in_ring_[ring_[k]];
        }
    }

    float take(std::size_t wanted) {
        std::size_t last = 0, before = 0;
        for (; before + in_ring_[last] < wanted; ++last) before += in_ring_[last];
        ranked_.resize(count_ + 1);
        std::size_t taken = 0, on_last = 0;
        for (std::size_t k = 0; k < count_; ++k) {
            const Index place = near_[k];
            ranked_[on_last] = std::uint64_t{std::bit_cast<std::uint32_t>(distance_[place])} << 32 | place;
            on_last += ring_[k] == last;
            near_[taken] = place;
            taken += ring_[k] < last;
        }
        const auto nearest = ranked_.begin(), end = nearest + static_cast<std::ptrdiff_t>(wanted - before);
        std::partial_sort(nearest, end, nearest + static_cast<std::ptrdiff_t>(on_last));
        for (auto at = nearest; at != end; ++at) near_[taken++] = static_cast<Index>(*at);
        count_ = taken;
        return std::bit_cast<float>(static_cast<std::uint32_t>(end[-1] >> 32));
    }

    std::vector<float> distance_;     // squared, of all candidates
    std::vector<Index> near_;         // places of those within the limit, then of those taken
    std::size_t count_ = 0;           // of these
    std::vector<std::uint32_t> ring_; // of those near
    std::array<std::uint32_t, rings> in_ring_{};
    std::vector<std::uint64_t> ranked_; // on the last ring: bits of the squared distance, then the place
};

class Search {
public:
    /// The neighbours of `points`, or of all if that is null.
    Search(const Octree& octree, const std::vector<Index>* points, Neighbors& result)
        : octree_(octree), points_(points), result_(result) {
        std::vector<Leaf> leaves = find_leaves(octree.codes);
        if (points) keep_leaves_of(*points, leaves);
        if (leaves.empty()) return;
        int deepest = 0;
        for (const Leaf& leaf : leaves) deepest = std::max(deepest, leaf.level);
        levels_.resize(static_cast<std::size_t>(deepest) + 1);
        levels_.back() = extract_level(octree, deepest);
        for (auto level = levels_.size() - 1; level-- > 0;)
            levels_[level] = coarser_level(levels_[level + 1], static_cast<int>(level));
        tbb::enumerable_thread_specific<Scratch> scratch;
        for_chunks(leaves.size(), leaves_per_chunk, [&](std::size_t begin, std::size_t end, std::size_t) {
            Scratch& own = scratch.local();
            for (std::size_t l = begin; l < end; ++l) search_leaf(leaves[l], own);
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

    /// The voxels around the leaf at one level; returns how many points they hold.
    std::size_t around(const Leaf& leaf, int level, std::array<Index, 27>& voxels, std::size_t& count) const {
        const OctreeLevel& grid = levels_[static_cast<std::size_t>(level)];
        const MortonCode code = octree_.codes[leaf.begin] >> (3 * (morton_levels - level));
        const VoxelCoord centre = morton_decode(code);
        const std::int32_t side = std::int32_t{1} << level;
        std::array<std::array<MortonCode, 3>, 3> part; // per axis and step, its bits of the code
        for (unsigned axis = 0; axis < 3; ++axis)
            for (std::int32_t step = -1; step <= 1; ++step) {
                const std::int32_t c = centre[axis] + step;
                part[axis][static_cast<std::size_t>(step + 1)] =
                    c < 0 || c >= side ? beyond : detail::spread_bits(static_cast<std::uint64_t>(c)) << axis;
            }
        std::size_t points = 0;
        count = 0;
        for (MortonCode z : part[2])
            for (MortonCode y : part[1])
                for (MortonCode x : part[0]) {
                    const MortonCode neighbor = x | y | z;
                    const Index v = neighbor < beyond ? grid.find(neighbor) : no_index;
                    if (v == no_index) continue;
                    voxels[count++] = v;
                    points += grid.first_point[v + 1] - grid.first_point[v];
                }
        return points;
    }

    void search_leaf(const Leaf& leaf, Scratch& scratch) const {
        Candidates& candidates = scratch.candidates;
        std::array<Index, 27> voxels;
        std::size_t count = 0;
        int level = leaf.level;
        while (around(leaf, level, voxels, count) < candidates_per_neighbor * result_.count && level > 0)
            --level;
        const Vec3 base = octree_.positions[leaf.begin];
        const OctreeLevel& grid = levels_[static_cast<std::size_t>(level)];
        candidates.clear();
        for (std::size_t v = 0; v < count; ++v) {
            Index first = grid.first_point[voxels[v]], last = grid.first_point[voxels[v] + 1];
            if (level == morton_levels && last - first > 2 * crowd) { // those next to the leaf in order
                first = std::clamp(leaf.begin, first + crowd / 2, last - 3 * crowd / 2) - crowd / 2;
                last = first + 2 * crowd;
            }
            candidates.add(octree_, first, last, base);
        }
        float limit = 0; // not known yet
        if (points_)
            for (Index slot = leaf.slot; slot < points_->size() && (*points_)[slot] < leaf.end; ++slot)
                limit = search_point((*points_)[slot], slot, base, limit, scratch);
        else
            for (Index i = leaf.begin; i < leaf.end; ++i) limit = search_point(i, i, base, limit, scratch);
    }

    /// Returns a squared distance within which the next point of the leaf will find enough.
    float search_point(Index i, Index slot, const Vec3& base, float limit, Scratch& scratch) const {
        const Vec3 p = octree_.positions[i] - base;
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
    if (options.count < 3 || options.count > 64)
        throw OptionError("neighbours " + std::to_string(options.count) + ": must lie in [3, 64]");
    Neighbors result;
    result.count = std::min(static_cast<std::size_t>(options.count), octree.size() - 1);
    const std::size_t size = points ? points->size() : octree.size();
    result.index.resize(size * result.count);
    result.reach.resize(size);
    const Search done(octree, points, result);
    return result;
}

} // namespace

Neighbors find_neighbors(const Octree& octree, const NeighborOptions& options) {
    return search(octree, nullptr, options);
}

Neighbors find_neighbors_of(const Octree& octree, const std::vector<Index>& points,
                            const NeighborOptions& options) {
    return search(octree, &points, options);
}

} // namespace hsdm
