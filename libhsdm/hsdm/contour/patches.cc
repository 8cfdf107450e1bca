#include "hsdm/contour/patches.hh"

#include "hsdm/contour/patch_neighborhood.hh"
#include "hsdm/core/chunks.hh"
#include "hsdm/core/parallel_sort.hh"

#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <array>
#include <atomic>

namespace hsdm {
namespace {

/// Voxels whose points lie on several sheets, by which alone anything ends.
std::vector<Index> voxels_with_several(const NormalSets& sets) {
    return indices_where(sets.first.size() - 1, chunks::usual,
                         [&](Index v) { return sets.first[v + 1] - sets.first[v] > 1; });
}

class PatchSeparation {
public:
    PatchSeparation(const Octree& octree, const OctreeLevel& level, const RelationTest& related,
                    NormalSets& sets)
        : octree_(octree), level_(level), related_(related), sets_(sets) {}

    PatchCounts run() {
        voxels_ = voxels_with_several(sets_);
        split();
        note_apart();
        return counts_;
    }

private:
    /// Voxels that have to be written anew: their sets, and the set of each of their points.
    struct Split {
        Index voxel;
        std::vector<NormalSet> sets;
        std::vector<std::uint8_t> of_point; ///< as NormalSets::of_point
    };

    PatchNeighborhood neighborhood(const SetSamples& samples) {
        return {octree_, level_, related_, sets_, samples, scratch_.local()};
    }

    /// What find(voxel, i, found) appends for the i-th set of each of these voxels, which must ascend; of
    /// other sets nothing. `make_find` makes one for a chunk.
    template <class T, class MakeFind>
    OfSets<T> of_sets(const std::vector<Index>& voxels, MakeFind&& make_find) {
        OfSets<T> result{{}, large_vector<Index>(sets_.sets.size() + 1)};
        const auto look = [&](std::size_t begin, std::size_t end, std::vector<T>& found) {
            auto find = make_find();
            for (std::size_t k = begin; k < end; ++k) {
                const Index first = sets_.first[voxels[k]], last = sets_.first[voxels[k] + 1];
                for (Index s = first; s < last; ++s) {
                    const std::size_t before = found.size();
                    find(voxels[k], s - first, found);
                    result.first[s + 1] = static_cast<Index>(found.size() - before);
                }
            }
        };
        result.all = collected<T>(voxels.size(), chunks::heavy, look);
        counts_to_first(result.first);
        return result;
    }
    SetSamples find_samples(const std::vector<Index>& voxels) {
        return of_sets<Index>(voxels, [&] {
            return [this](Index voxel, Index i, std::vector<Index>& found) {
                sample_set(level_, sets_, sets_.first[voxel] + i, found);
            };
        });
    }
    SetDiscs find_discs(const std::vector<Index>& voxels, const SetSamples& samples) {
        return of_sets<SeenDisc>(voxels, [&] {
            return
                [around = neighborhood(samples)](Index voxel, Index i, std::vector<SeenDisc>& found) mutable {
                    if (i == 0) around.gather(voxel);
                    around.add_discs(i, found);
                };
        });
    }

    void split() {
        const std::vector<Index> near = with_neighbors(voxels_);
        const SetSamples samples = find_samples(near);
        const SetDiscs discs = find_discs(near, samples);
        std::vector<std::uint8_t> crowded(voxels_.size(), 0);
        std::vector<Split> splits =
            collected<Split>(voxels_.size(), chunks::heavy,
                             [&](std::size_t begin, std::size_t end, std::vector<Split>& found) {
                                 PatchNeighborhood around = neighborhood(samples);
                                 for (std::size_t k = begin; k < end; ++k) {
                                     around.gather(voxels_[k]);
                                     crowded[k] = around.is_crowded(discs);
                                     if (!crowded[k]) continue;
                                     around.place_discs(discs);
                                     split_voxel(around, voxels_[k], found);
                                 }
                             });
        std::size_t kept = 0;
        for (std::size_t k = 0; k < voxels_.size(); ++k)
            if (crowded[k]) voxels_[kept++] = voxels_[k];
        voxels_.resize(kept);
        counts_.crowded = kept;
        if (!splits.empty()) insert(splits);
    }

    void split_voxel(PatchNeighborhood& around, Index voxel, std::vector<Split>& found) const {
        const Index begin = level_.first_point[voxel], end = level_.first_point[voxel + 1];
        Split result{voxel, {}, {}};
        std::vector<std::uint8_t> patch;
        std::size_t room = NormalSets::most_per_voxel - around.own();
        for (std::size_t i = 0; i < around.own(); ++i) {
            const std::size_t count = around.connect_samples(i, patch);
            if (count < 2 || count - 1 > room) continue;
            room -= count - 1;
            if (result.of_point.empty())
                result.of_point.assign(sets_.of_point.begin() + begin, sets_.of_point.begin() + end);
            label_points(around, static_cast<std::uint8_t>(i), patch, begin, result.of_point);
        }
        if (result.of_point.empty()) return;
        rebuild(begin, result);
        found.push_back(std::move(result));
    }

    /// Marks the points of patches of the voxel's i-th set by i + (patch << 3); both are less than 8.
    void label_points(const PatchNeighborhood& around, std::uint8_t i, const std::vector<std::uint8_t>& patch,
                      Index begin, std::vector<std::uint8_t>& of_point) const {
        const auto samples = around.sampled(i);
        const auto squared = [&](std::size_t s, const Vec3& p) {
            return (octree_.positions[samples[s]] - p).sqrnorm();
        };
        for (std::size_t k = 0; k < of_point.size(); ++k) {
            if (of_point[k] != i) continue;
            const Vec3& p = octree_.positions[begin + k];
            std::size_t nearest = 0;
            for (std::size_t s = 1; s < samples.size(); ++s)
                if (squared(s, p) < squared(nearest, p)) nearest = s;
            of_point[k] = static_cast<std::uint8_t>(i | patch[nearest] << 3);
        }
    }

    /// Sets anew from labels, by descending count.
    void rebuild(Index begin, Split& split) const {
        std::vector<std::uint8_t> labels;
        for (std::uint8_t label : split.of_point)
            if (label != NormalSets::no_set && std::ranges::find(labels, label) == labels.end())
                labels.push_back(label);
        struct Found {
            NormalSet set;
            std::uint8_t label;
        };
        std::vector<Found> found;
        std::vector<Index> points;
        for (std::uint8_t label : labels) {
            points.clear();
            for (std::size_t k = 0; k < split.of_point.size(); ++k)
                if (split.of_point[k] == label) points.push_back(begin + static_cast<Index>(k));
            found.push_back({measure_set(octree_, points, split.voxel, level_.voxel_size), label});
        }
        std::ranges::stable_sort(found,
                                 [](const Found& a, const Found& b) { return a.set.count > b.set.count; });
        for (std::uint8_t& label : split.of_point) {
            if (label == NormalSets::no_set) continue;
            const auto at = std::ranges::find(found, label, &Found::label);
            label = static_cast<std::uint8_t>(at - found.begin());
        }
        for (const Found& f : found) split.sets.push_back(f.set);
    }

    /// Puts the split voxels' sets in place of those before.
    void insert(const std::vector<Split>& splits) {
        std::vector<NormalSet> sets;
        std::vector<Index> first(1, 0);
        auto next = splits.begin();
        for (Index v = 0; v + 1 < sets_.first.size(); ++v) {
            const Index begin = sets_.first[v], end = sets_.first[v + 1];
            if (next != splits.end() && next->voxel == v) {
                counts_.split += next->sets.size() - (end - begin);
                sets.insert(sets.end(), next->sets.begin(), next->sets.end());
                ++next;
            } else {
                for (Index s = begin; s < end; ++s) sets.push_back(sets_.sets[s]);
            }
            first.push_back(static_cast<Index>(sets.size()));
        }
        for (const Split& split : splits)
            std::ranges::copy(split.of_point, sets_.of_point.begin() + level_.first_point[split.voxel]);
        sets_.sets = std::move(sets);
        sets_.first = std::move(first);
    }

    /// These voxels and those round them.
    std::vector<Index> with_neighbors(const std::vector<Index>& voxels) const {
        std::vector<std::uint8_t> marked(level_.size(), 0);
        for_each_index(voxels.size(), chunks::usual, [&](Index k) {
            const auto mark = [&](Index v) {
                std::atomic_ref(marked[v]).store(1, std::memory_order_relaxed);
            };
            mark(voxels[k]);
            for_neighbors(level_, voxels[k], mark);
        });
        return indices_where(level_.size(), chunks::light, [&](Index v) { return marked[v] != 0; });
    }

    /// Does one of two sheets go on beyond their crease?
    static bool any_goes_on(PatchNeighborhood& around, std::size_t i, std::size_t j, Relation relation) {
        return relation != Relation::smooth
               && (around.goes_on(i, j, relation) || around.goes_on(j, i, relation));
    }

    /// Pairs of related sets with a wall or gap between them.
    void note_apart() {
        using Pair = std::array<Index, 2>;
        voxels_ = with_neighbors(voxels_); // an edge before a face may lie in the next one
        const std::vector<Index> near = with_neighbors(voxels_);
        const SetSamples samples = find_samples(near);
        const SetDiscs discs = find_discs(near, samples);
        std::vector<Pair> pairs = collected<Pair>(
            voxels_.size(), chunks::heavy, [&](std::size_t begin, std::size_t end, std::vector<Pair>& found) {
                PatchNeighborhood around = neighborhood(samples);
                for (std::size_t k = begin; k < end; ++k) {
                    around.gather(voxels_[k]);
                    around.place_discs(discs);
                    for (std::size_t i = 0; i < around.own(); ++i)
                        for (std::size_t j = i + 1; j < around.size(); ++j) {
                            const Relation relation = related_(around.set(i), around.set(j));
                            if (relation == Relation::none) continue;
                            if (!around.apart(i, j) && !any_goes_on(around, i, j, relation)) continue;
                            found.push_back({around.number(i), around.number(j)});
                            found.push_back({around.number(j), around.number(i)});
                        }
                }
            });
        parallel_sort_unique(pairs);
        counts_.apart = pairs.size() / 2;
        if (pairs.empty()) return;
        sets_.first_apart.assign(sets_.sets.size() + 1, 0);
        for (const Pair& p : pairs) {
            ++sets_.first_apart[p[0] + 1];
            sets_.apart.push_back(p[1]);
        }
        counts_to_first(sets_.first_apart);
    }

    const Octree& octree_;
    const OctreeLevel& level_;
    const RelationTest& related_;
    NormalSets& sets_;
    std::vector<Index> voxels_; // with several sheets; later those near walls and gaps
    PatchCounts counts_;
    tbb::enumerable_thread_specific<PatchScratch> scratch_;
};

} // namespace

PatchCounts separate_patches(const Octree& octree, const OctreeLevel& level, const RelationTest& related,
                             NormalSets& sets) {
    return PatchSeparation(octree, level, related, sets).run();
}

} // namespace hsdm
