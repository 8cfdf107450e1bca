#include "hsdm/contour/patches.hh"

#include "hsdm/contour/components.hh"
#include "hsdm/contour/constants.hh"
#include "hsdm/contour/middle_discs.hh"
#include "hsdm/core/chunks.hh"
#include "hsdm/core/constants.hh"
#include "hsdm/core/parallel_sort.hh"
#include "hsdm/core/vector_pair.hh"
#include "hsdm/octree/constants.hh"

#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <optional>

namespace hsdm {
namespace {

/// The discs of walls and gaps, by the sets that bound these: those of set s are all[first[s]] ..
/// all[first[s + 1]].
struct SetDiscs {
    struct Disc {
        Vec3 point; // of the set
        double off; // from there to the disc's middle, along the set's normal: ahead are gaps
        double radius;
    };
    std::vector<Disc> all;
    std::vector<Index> first;
};

/// Working space of one thread.
struct PatchScratch {
    std::vector<Index> sets;   // of the voxel and its neighbours, the voxel's own first
    std::vector<Vec3> samples; // then the centroids of the sets
    std::vector<Index> first_sample;
    std::vector<double> spacings;        // per set; below 0: not measured yet
    std::vector<std::uint8_t> one_sheet; // per set a row of all, from has_row on
    std::vector<std::uint8_t> has_row;
    std::vector<std::uint32_t> of_sheet; // per set a row: how many sets are of its sheet, then these
    struct Facing {                      // two sheets that face a set
        VectorPair normal, centroid;
        Double2 cosine;
    };
    std::vector<Facing> facing;
    std::vector<MiddleDisc> of_set;
    MiddleDiscs discs;                             // its places are the samples, its surfaces the sets
    std::vector<std::pair<double, double>> places; // along a crease, and off its plane
    struct NearCrease {
        double along, beyond;
        std::size_t sample;
    };
    std::vector<NearCrease> near;
};

/// The shortest of the ways that are offered; of equally long ones those that came first.
class ShortestWays {
public:
    struct Way {
        double squared_length;
        std::size_t p, q;
    };

    void offer(const Way& way) {
        if (count_ == nearest_asked) {
            if (!(way.squared_length < ways_[count_ - 1].squared_length)) return;
            --count_;
        }
        std::size_t at = count_++;
        for (; at > 0 && way.squared_length < ways_[at - 1].squared_length; --at) ways_[at] = ways_[at - 1];
        ways_[at] = way;
    }
    std::span<const Way> found() const { return {ways_.data(), count_}; }

private:
    std::array<Way, nearest_asked> ways_;
    std::size_t count_ = 0;
};

/// What lies round one voxel: the sets of the 27 voxels, samples of their points, and the discs of walls and
/// gaps.
class Neighborhood {
public:
    Neighborhood(const Octree& octree, const OctreeLevel& level, const RelationTest& related,
                 const NormalSets& sets, PatchScratch& scratch)
        : octree_(octree), level_(level), related_(related), sets_(sets), at_(scratch) {}

    void gather(Index voxel) {
        at_.sets.clear();
        add_sets(voxel);
        own_ = at_.sets.size();
        for_neighbors(level_, voxel, [&](Index v) { add_sets(v); });
        at_.samples.clear();
        at_.spacings.assign(size(), -1);
        at_.has_row.assign(size(), 0);
        at_.one_sheet.resize(size() * size());
        at_.of_sheet.resize(size() * (size() + 1));
        most_points_ = 0;
        for (std::size_t i = 0; i < size(); ++i) most_points_ = std::max(most_points_, set(i).count);
    }
    /// Is a wall or gap near?
    bool is_crowded(const SetDiscs& discs) const {
        return std::ranges::any_of(at_.sets, [&](Index s) { return discs.first[s] < discs.first[s + 1]; });
    }
    /// What is asked of samples: of those of so many sets.
    void lay_out(const SetDiscs& discs, std::size_t sampled) {
        take_samples(sampled);
        for (std::size_t i = 0; i < size(); ++i) at_.samples.push_back(set(i).centroid);
        at_.discs.reset(at_.samples, size(), set(0).centroid, level_.voxel_size);
        for (const Index s : at_.sets) {
            const Vec3& normal = sets_.sets[s].normal;
            at_.of_set.clear();
            for (Index d = discs.first[s]; d < discs.first[s + 1]; ++d) {
                const auto& [point, off, radius] = discs.all[d];
                at_.of_set.push_back({point + normal * off, normal, point, radius * radius, off > 0});
            }
            at_.discs.add(at_.of_set);
        }
    }

    std::size_t own() const { return own_; }
    std::size_t size() const { return at_.sets.size(); }
    Index number(std::size_t i) const { return at_.sets[i]; }
    const NormalSet& set(std::size_t i) const { return sets_.sets[at_.sets[i]]; }
    std::span<const Vec3> samples(std::size_t i) const {
        return {at_.samples.data() + at_.first_sample[i], at_.samples.data() + at_.first_sample[i + 1]};
    }

    /// Appends the discs between an own set and the nearest opposite sheets before it and behind it.
    void add_discs(std::size_t i, std::vector<SetDiscs::Disc>& discs) {
        find_facing(i);
        if (at_.facing.empty()) return;
        const double radius = spacings::beside * spacing(i);
        if (radius == 0) return;
        if (at_.samples.empty()) take_samples(own_);
        for (const Vec3& p : samples(i)) add_discs_at(p, set(i).normal, radius, discs);
    }

    /// Does a wall or gap stand on a set?
    bool has_standing(std::size_t i) const { return at_.discs.stand_on(surface(i)); }
    /// Does one of them part two samples, by their numbers, of a surface with the normal of a set?
    bool parted(std::size_t p, std::size_t q, std::size_t i) const {
        return at_.discs.part(p, q, std::array{surface(i)});
    }
    /// The same of a surface with the normal of one set or of another.
    bool parted(std::size_t p, std::size_t q, std::size_t i, std::size_t j) const {
        return at_.discs.part(p, q, std::array{surface(i), surface(j)});
    }
    std::size_t first_sample(std::size_t i) const { return at_.first_sample[i]; }

    /// Of the shortest ways between two sets, are most parted?
    bool apart(std::size_t i, std::size_t j) {
        if (!has_standing(i) && !has_standing(j)) return false;
        ShortestWays ways;
        for (std::size_t p = first_sample(i); p < first_sample(i + 1); ++p)
            for (std::size_t q = first_sample(j); q < first_sample(j + 1); ++q)
                ways.offer({(at_.samples[q] - at_.samples[p]).sqrnorm(), p, q});
        const std::size_t most = ways.found().size() / 2; // more are most of them
        std::size_t parted_ways = 0, open_ways = 0;
        for (const auto& [squared_length, p, q] : ways.found()) {
            ++(parted(p, q, i, j) ? parted_ways : open_ways);
            if (parted_ways > most) return true;
            if (open_ways >= ways.found().size() - most) return false;
        }
        return false;
    }

    /// Does the sheet of a set go on beyond the plane of another that it would meet in a crease, beside that
    /// one's sheet? Both sheets end at a crease: the face across a gap from an edge goes on.
    bool goes_on(std::size_t i, std::size_t j, Relation crease) {
        const NormalSet &a = set(i), &b = set(j);
        const double step = spacing(i);
        if (step == 0) return false;
        const Vec3 cross = a.normal % b.normal;
        const double sine = cross.norm();
        const Vec3 along = cross / sine;
        const double outward = (crease == Relation::convex ? 1 : -1) / sine;
        const double here = along | b.centroid, far = sheets::beside * level_.voxel_size;
        const double least = patches::goes_on_from * step, most = patches::goes_on_within * step;
        // Points of the sheet near the crease: where along it, and how far beyond the other's plane.
        auto& near = at_.near;
        near.clear();
        for (const std::uint32_t k : sheet_of(i)) {
            for (std::size_t sample = first_sample(k); sample < first_sample(k + 1); ++sample) {
                const Vec3& p = at_.samples[sample];
                const double s = along | p, t = outward * (b.normal | (p - b.centroid));
                // One branch, as neither can be foreseen.
                if (int{std::abs(s - here) > far} | int{std::abs(t) > most}) continue;
                if (std::abs(a.normal | (p - a.centroid)) > relations::smooth_gap * level_.voxel_size)
                    continue;
                near.push_back({s, t, sample});
            }
        }
        if (near.size() < points_of_plane) return false;
        // Where the other sheet is near the crease: the place along it, and how far off the plane, for
        // normals have errors.
        auto& places = at_.places;
        places.clear();
        for (const std::uint32_t k : sheet_of(j))
            for (const Vec3& q : samples(k))
                if (std::abs(a.normal | (q - a.centroid)) < far)
                    if (const double s = along | q;
                        std::abs(s - here) < far + step) // what is looked up below
                        places.emplace_back(s, outward * (b.normal | (q - b.centroid)));
        std::sort(places.begin(), places.end());
        const std::size_t middle = at_.first_sample.back() + i; // the centroid
        unsigned beyond = 0, before = 0;
        for (const auto& [s, t, sample] : near) {
            double lowest = most, highest = -most;
            for (auto place =
                     std::lower_bound(places.begin(), places.end(), std::pair(s - 0.5 * step, -most));
                 place != places.end() && place->first <= s + 0.5 * step; ++place) {
                lowest = std::min(lowest, place->second);
                highest = std::max(highest, place->second);
            }
            if (lowest > highest) continue; // the other sheet is not there
            before += t < lowest - least;
            beyond += t > highest + least && !parted(middle, sample, i);
        }
        return beyond >= points_of_plane && 2 * beyond >= before;
    }

private:
    MiddleDiscs::Surface surface(std::size_t i) const { return {i, set(i).normal}; }

    void add_sets(Index v) {
        for (Index s = sets_.first[v]; s < sets_.first[v + 1]; ++s) at_.sets.push_back(s);
    }

    static bool opposed(const NormalSet& a, const NormalSet& b) {
        return (a.normal | b.normal) < angles::opposed;
    }

    /// Of a set's points, from one sample to the next.
    static Index sample_stride(const NormalSet& set) {
        return static_cast<Index>(chunk_count(set.count, patches::most_samples));
    }
    static double sample_count(const NormalSet& set) {
        return static_cast<double>(chunk_count(set.count, sample_stride(set)));
    }

    /// At most so many points of each of the first sets, evenly taken in their order.
    void take_samples(std::size_t sets) {
        at_.samples.clear();
        at_.first_sample.assign(1, 0);
        for (std::size_t i = 0; i < sets; ++i) {
            const NormalSet& s = set(i);
            Index skipped = 0; // points of the set until the next sample
            for (Index k = level_.first_point[s.voxel]; k < level_.first_point[s.voxel + 1]; ++k) {
                if (sets_.of_point[k] != at_.sets[i] || skipped-- > 0) continue;
                at_.samples.push_back(octree_.positions[k]);
                skipped = sample_stride(s) - 1;
            }
            at_.first_sample.push_back(static_cast<Index>(at_.samples.size()));
        }
    }

    /// Spacing of the samples on the sheet of a set, from the fullest of its sets around; 0 if they are too
    /// few for a sheet.
    double spacing(std::size_t i) {
        double& known = at_.spacings[i];
        if (known >= 0) return known;
        double points = 0, squares = 0;
        Index scanned = 0; // points of the sheet
        for (const std::uint32_t j : sheet_of(i)) {
            const double n = sample_count(set(j));
            points += n;
            squares += n * n;
            scanned += set(j).count;
        }
        // A wall that fills half of a voxel's width in three voxels has more than half; odd normals have not.
        const double least = std::max(spacings::points_per_voxel, 0.5 * most_points_);
        return known = scanned < least ? 0 : level_.voxel_size * std::sqrt(points / squares);
    }

    /// The sets of a set's sheet: itself, and those smooth with it.
    std::span<const std::uint32_t> sheet_of(std::size_t i) {
        std::uint32_t* const sheet = at_.of_sheet.data() + i * (size() + 1);
        if (!at_.has_row[i]) {
            std::uint8_t* const row = at_.one_sheet.data() + i * size();
            *sheet = 0;
            for (std::size_t k = 0; k < size(); ++k) {
                row[k] = at_.has_row[k] ? at_.one_sheet[k * size() + i]
                                        : k == i || related_.smooth(set(i), set(k));
                if (row[k]) sheet[++*sheet] = static_cast<std::uint32_t>(k);
            }
            at_.has_row[i] = 1;
        }
        return {sheet + 1, *sheet};
    }

    void add_facing(const NormalSet& from, const NormalSet& a, const NormalSet& b) {
        at_.facing.push_back({VectorPair(a.normal, b.normal), VectorPair(a.centroid, b.centroid),
                              Double2{from.normal | a.normal, from.normal | b.normal}});
    }

    /// The sets that face another, two at a time.
    void find_facing(std::size_t i) {
        const NormalSet& a = set(i);
        at_.facing.clear();
        std::optional<std::size_t> odd;
        for (std::size_t j = 0; j < size(); ++j) {
            if (j == i || !opposed(a, set(j))) continue;
            if (odd) add_facing(a, set(*odd), set(j));
            odd = odd ? std::nullopt : std::optional(j);
        }
        if (odd) add_facing(a, set(*odd), set(*odd)); // twice: two at a time are looked at
    }

    /// The discs between a sheet at one of its points and the nearest opposite one behind it and before it.
    void add_discs_at(const Vec3& p, const Vec3& normal, double radius,
                      std::vector<SetDiscs::Disc>& discs) const {
        const double h = level_.voxel_size, widest = patches::widest * h,
                     beside = sheets::beside * sheets::beside * h * h;
        Double2 behind = Double2{} + widest, front = behind; // the nearest sheets
        const VectorPair place(p, p), normals(normal, normal);
        for (const auto& [facing, centroid, cosine] : at_.facing) {
            const Double2 t = (facing | (centroid - place)) / cosine;
            const VectorPair off = place + normals * t - centroid;
            const Double2 distance = (off | off) > beside ? Double2{} + widest : max_lanes(t, -t);
            front = min_lanes(t > 0 ? distance : front, front);
            behind = min_lanes(t > 0 ? behind : distance, behind);
        }
        const double nearest[2] = {std::min(behind[0], behind[1]), std::min(front[0], front[1])};
        if (nearest[0] < widest) discs.push_back({p, -0.5 * nearest[0], radius});
        if (nearest[1] < widest) discs.push_back({p, 0.5 * nearest[1], radius});
    }

    const Octree& octree_;
    const OctreeLevel& level_;
    const RelationTest& related_;
    const NormalSets& sets_;
    PatchScratch& at_;
    std::size_t own_ = 0;
    Index most_points_ = 0; // of a set
};

/// Of each point of a set its patch: sampled points are connected that nothing parts, others belong with the
/// nearest sample. Returns the number of patches.
std::size_t connect_samples(const Neighborhood& around, std::size_t i, std::vector<std::uint8_t>& patch) {
    const auto samples = around.samples(i);
    const std::size_t first = around.first_sample(i);
    patch.assign(samples.size(), 0);
    if (!around.has_standing(i)) return 1;
    return label_components(
        samples.size(), [&](std::size_t k) -> std::uint8_t& { return patch[k]; },
        [&](std::size_t k, std::size_t j) { return !around.parted(first + k, first + j, i); });
}

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
        std::vector<Index> of_point; ///< number within the voxel, or no_index
    };

    /// Those of all sets of these voxels, ascending.
    SetDiscs find_discs(const std::vector<Index>& voxels) {
        SetDiscs discs{{}, large_vector<Index>(sets_.sets.size() + 1)};
        const auto look = [&](std::size_t begin, std::size_t end, std::vector<SetDiscs::Disc>& found) {
            Neighborhood around(octree_, level_, related_, sets_, scratch_.local());
            for (std::size_t k = begin; k < end; ++k) {
                around.gather(voxels[k]);
                for (std::size_t i = 0; i < around.own(); ++i) {
                    const std::size_t before = found.size();
                    around.add_discs(i, found);
                    discs.first[around.number(i) + 1] = static_cast<Index>(found.size() - before);
                }
            }
        };
        discs.all = collected<SetDiscs::Disc>(voxels.size(), chunks::heavy, look);
        counts_to_first(discs.first);
        return discs;
    }

    void split() {
        const SetDiscs discs = find_discs(with_neighbors(voxels_));
        std::vector<std::uint8_t> crowded(voxels_.size(), 0);
        std::vector<Split> splits =
            collected<Split>(voxels_.size(), chunks::heavy,
                             [&](std::size_t begin, std::size_t end, std::vector<Split>& found) {
                                 PatchScratch& scratch = scratch_.local();
                                 Neighborhood around(octree_, level_, related_, sets_, scratch);
                                 for (std::size_t k = begin; k < end; ++k) {
                                     around.gather(voxels_[k]);
                                     crowded[k] = around.is_crowded(discs);
                                     if (!crowded[k]) continue;
                                     around.lay_out(discs, around.own());
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

    void split_voxel(const Neighborhood& around, Index voxel, std::vector<Split>& found) const {
        const Index begin = level_.first_point[voxel], end = level_.first_point[voxel + 1];
        Split result{voxel, {}, {}};
        std::vector<std::uint8_t> patch;
        std::size_t room = NormalSets::most_per_voxel - around.own();
        for (std::size_t i = 0; i < around.own(); ++i) {
            const std::size_t count = connect_samples(around, i, patch);
            if (count < 2 || count - 1 > room) continue;
            room -= count - 1;
            if (result.of_point.empty())
                result.of_point.assign(sets_.of_point.begin() + begin, sets_.of_point.begin() + end);
            label_points(around, i, patch, begin, result.of_point);
        }
        if (result.of_point.empty()) return;
        rebuild(begin, result);
        found.push_back(std::move(result));
    }

    /// Marks the points of patches by set + (patch << 28); most sets of a scan are fewer.
    void label_points(const Neighborhood& around, std::size_t i, const std::vector<std::uint8_t>& patch,
                      Index begin, std::vector<Index>& of_point) const {
        const auto samples = around.samples(i);
        for (std::size_t k = 0; k < of_point.size(); ++k) {
            if (of_point[k] != around.number(i)) continue;
            const Vec3& p = octree_.positions[begin + k];
            std::size_t nearest = 0;
            for (std::size_t s = 1; s < samples.size(); ++s)
                if ((samples[s] - p).sqrnorm() < (samples[nearest] - p).sqrnorm()) nearest = s;
            of_point[k] = around.number(i) | static_cast<Index>(patch[nearest]) << 28;
        }
    }

    /// Sets anew from labels, by descending count.
    void rebuild(Index begin, Split& split) const {
        std::vector<Index> labels;
        for (Index label : split.of_point)
            if (label != no_index && std::ranges::find(labels, label) == labels.end())
                labels.push_back(label);
        struct Found {
            NormalSet set;
            Index label;
        };
        std::vector<Found> found;
        std::vector<Index> points;
        for (Index label : labels) {
            points.clear();
            for (std::size_t k = 0; k < split.of_point.size(); ++k)
                if (split.of_point[k] == label) points.push_back(begin + static_cast<Index>(k));
            found.push_back({measure_set(octree_, points, split.voxel, level_.voxel_size), label});
        }
        std::ranges::stable_sort(found,
                                 [](const Found& a, const Found& b) { return a.set.count > b.set.count; });
        for (Index& label : split.of_point) {
            if (label == no_index) continue;
            const auto at = std::ranges::find(found, label, &Found::label);
            label = static_cast<Index>(at - found.begin());
        }
        for (const Found& f : found) split.sets.push_back(f.set);
    }

    /// Puts the split voxels' sets in place of those before.
    void insert(const std::vector<Split>& splits) {
        std::vector<NormalSet> sets;
        std::vector<Index> first(1, 0), moved(sets_.sets.size());
        auto next = splits.begin();
        for (Index v = 0; v + 1 < sets_.first.size(); ++v) {
            const Index begin = sets_.first[v], end = sets_.first[v + 1];
            if (next != splits.end() && next->voxel == v) {
                counts_.split += next->sets.size() - (end - begin);
                sets.insert(sets.end(), next->sets.begin(), next->sets.end());
                ++next;
            } else {
                for (Index s = begin; s < end; ++s) {
                    moved[s] = static_cast<Index>(sets.size());
                    sets.push_back(sets_.sets[s]);
                }
            }
            first.push_back(static_cast<Index>(sets.size()));
        }
        for_each_index(sets_.of_point.size(), chunks::light, [&](Index k) {
            if (sets_.of_point[k] != no_index) sets_.of_point[k] = moved[sets_.of_point[k]];
        });
        for (const Split& split : splits)
            for (std::size_t k = 0; k < split.of_point.size(); ++k)
                sets_.of_point[level_.first_point[split.voxel] + k] =
                    split.of_point[k] == no_index ? no_index : first[split.voxel] + split.of_point[k];
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
    static bool any_goes_on(Neighborhood& around, std::size_t i, std::size_t j, Relation relation) {
        return relation != Relation::smooth
               && (around.goes_on(i, j, relation) || around.goes_on(j, i, relation));
    }

    /// Pairs of related sets with a wall or gap between them.
    void note_apart() {
        using Pair = std::array<Index, 2>;
        voxels_ = with_neighbors(voxels_); // an edge before a face may lie in the next one
        const SetDiscs discs = find_discs(with_neighbors(voxels_));
        std::vector<Pair> pairs = collected<Pair>(
            voxels_.size(), chunks::heavy, [&](std::size_t begin, std::size_t end, std::vector<Pair>& found) {
                PatchScratch& scratch = scratch_.local();
                Neighborhood around(octree_, level_, related_, sets_, scratch);
                for (std::size_t k = begin; k < end; ++k) {
                    around.gather(voxels_[k]);
                    around.lay_out(discs, around.size());
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
