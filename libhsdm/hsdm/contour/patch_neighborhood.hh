#pragma once
// What lies round one voxel, for the separation of patches: the sets near it, samples of their points, and
// the walls and gaps between them.

#include "hsdm/contour/middle_discs.hh"
#include "hsdm/contour/normal_sets.hh"
#include "hsdm/contour/set_relation.hh"
#include "hsdm/core/vector_pair.hh"

#include <span>
#include <utility>
#include <vector>

namespace hsdm {

/// Something of each set: of set s all[first[s]] .. all[first[s + 1]].
template <class T>
struct OfSets {
    std::vector<T> all;
    std::vector<Index> first;

    std::span<const T> of(Index set) const { return {all.data() + first[set], all.data() + first[set + 1]}; }
};
/// Points that stand for those of a set, evenly taken in their order.
using SetSamples = OfSets<Index>;
/// The discs of the walls and gaps that a set bounds.
using SetDiscs = OfSets<SeenDisc>;

/// Appends at most so many points of a set as are looked at.
void sample_set(const OctreeLevel& level, const NormalSets& sets, Index set, std::vector<Index>& samples);

/// Working space of one thread.
struct PatchScratch {
    std::vector<Index> sets;                        // of the voxel and its neighbours, the voxel's own first
    std::vector<Vec3> samples;                      // then the centroids of the sets
    std::vector<Index> first_sample;                // empty: not taken yet
    std::vector<Box> boxes;                         // per set, of its samples
    std::vector<std::pair<double, double>> heights; // per set, of its sheet over its plane
    std::vector<double> spacings;                   // per set; below 0: not measured yet
    std::vector<std::uint8_t> one_sheet;            // per set a row of all, from has_row on
    std::vector<std::uint8_t> has_row;
    std::vector<std::uint32_t> of_sheet; // per set a row: how many sets are of its sheet, then these
    struct Facing {                      // two sheets that face a set
        VectorPair normal, centroid;
        Double2 cosine;
    };
    std::vector<Facing> facing;
    MiddleDiscs discs;                             // its places are the samples, its surfaces the sets
    std::vector<std::pair<double, double>> places; // along a crease, and off its plane
    struct NearCrease {
        double along, beyond;
        std::size_t sample;
    };
    std::vector<NearCrease> near;
};

/// What lies round one voxel: the sets of the 27 voxels, samples of their points, and the discs of walls and
/// gaps. Sets go by their numbers in it, those of the voxel itself first. All of them must have samples,
/// those of the voxel itself where only discs are made. What a question needs is found when it is first
/// asked.
class PatchNeighborhood {
public:
    PatchNeighborhood(const Octree& octree, const OctreeLevel& level, const RelationTest& related,
                      const NormalSets& sets, const SetSamples& samples, PatchScratch& scratch)
        : octree_(octree), level_(level), related_(related), sets_(sets), samples_(samples), at_(scratch) {}

    void gather(Index voxel);
    /// Is a wall or gap near?
    bool is_crowded(const SetDiscs& discs) const;
    /// The discs that are asked for below, of all sets.
    void place_discs(const SetDiscs& discs);

    std::size_t own() const { return own_; }
    std::size_t size() const { return at_.sets.size(); }
    Index number(std::size_t i) const { return at_.sets[i]; }
    const NormalSet& set(std::size_t i) const { return sets_.sets[at_.sets[i]]; }
    std::span<const Index> sampled(std::size_t i) const { return samples_.of(at_.sets[i]); }

    /// Appends the discs between an own set and the nearest opposite sheets before it and behind it.
    void add_discs(std::size_t i, std::vector<SeenDisc>& discs);
    /// Of each sample of a set its patch: they are connected where nothing parts them. Returns the number of
    /// patches.
    std::size_t connect_samples(std::size_t i, std::vector<std::uint8_t>& patch);
    /// Of the shortest ways between two sets, are most parted?
    bool apart(std::size_t i, std::size_t j);
    /// Does the sheet of a set go on beyond the plane of another that it would meet in a crease, beside that
    /// one's sheet? Both sheets end at a crease: the face across a gap from an edge goes on.
    bool goes_on(std::size_t i, std::size_t j, Relation crease);

private:
    struct Crease;

    MiddleDiscs::Surface surface(std::size_t i) const { return {i, set(i).normal}; }
    Index first_sample(std::size_t i) const { return at_.first_sample[i]; }
    std::span<const Vec3> samples(std::size_t i) const {
        return {at_.samples.data() + first_sample(i), at_.samples.data() + first_sample(i + 1)};
    }
    void add_sets(Index voxel);
    void take_samples();
    double spacing(std::size_t i);
    std::span<const std::uint32_t> sheet_of(std::size_t i);
    std::pair<double, double> heights(std::size_t i);
    void find_facing(std::size_t i);
    void add_facing(const NormalSet& from, const NormalSet& a, const NormalSet& b);
    void add_discs_at(const Vec3& p, const Vec3& normal, double radius, std::vector<SeenDisc>& discs) const;
    bool passes(std::size_t i, const Vec3& direction, double from, double most) const;
    void find_near_crease(std::size_t i, const Crease& crease);
    double find_places_of_other(std::size_t j, const Crease& crease);
    std::pair<double, double> other_beside(double along, const Crease& crease) const;

    const Octree& octree_;
    const OctreeLevel& level_;
    const RelationTest& related_;
    const NormalSets& sets_;
    const SetSamples& samples_;
    PatchScratch& at_;
    std::size_t own_ = 0;
    Index most_points_ = 0; // of a set
};

} // namespace hsdm
