#include "hsdm/contour/outlier_sets.hh"

#include "hsdm/core/chunks.hh"

#include <algorithm>

namespace hsdm {
namespace {

/// Is set s an outlier? `group` is scratch.
bool reaches_few(const OctreeLevel& level, const RelationTest& related, const NormalSets& sets, double most,
                 std::size_t most_sets, Index s, std::vector<Index>& group) {
    group.assign(1, s);
    for (std::size_t i = 0; i < group.size(); ++i) {
        const NormalSet& set = sets.sets[group[i]];
        const VoxelCoord at = level.coord(set.voxel);
        for (const VoxelCoord& offset : neighbor_offsets) {
            const Index voxel = level.find({at[0] + offset[0], at[1] + offset[1], at[2] + offset[2]});
            if (voxel == no_index) continue;
            for (Index t = sets.first[voxel]; t < sets.first[voxel + 1]; ++t) {
                if (!related.smooth(set, sets.sets[t])) continue;
                if (sets.sets[t].count > most) return false;
                if (std::find(group.begin(), group.end(), t) == group.end()) group.push_back(t);
            }
            if (group.size() > most_sets) return false;
        }
    }
    return true;
}

/// Does the foot of p on the plane of a set lie amid its points, which spread evenly?
bool is_over(const NormalSet& set, const Vec3& p, double distance) {
    const Vec3 foot = p - distance * set.normal - set.centroid;
    const double length_squared = foot.sqrnorm();
    return length_squared * length_squared <= set.spread.reach_squared(foot);
}

/// Does set s face aside from sheets of many points in the voxels around that face two opposite ways, and lie
/// amid their points, over all of them or under all of them?
bool lies_between(const OctreeLevel& level, const NormalSets& sets, double most, double most_cosine,
                  Index s) {
    const NormalSet& set = sets.sets[s];
    const NormalSet* first = nullptr;
    std::array<bool, 2> over{}, under{}; // of those that face as the first, and against it
    const auto look_at = [&](Index voxel) {
        for (const NormalSet& sheet : sets.of_voxel(voxel)) {
            if (sheet.count <= most || std::abs(sheet.normal | set.normal) >= most_cosine) continue;
            const double distance = sheet.normal | (set.centroid - sheet.centroid);
            if (!is_over(sheet, set.centroid, distance)) continue;
            if (first == nullptr) first = &sheet;
            const double cosine = sheet.normal | first->normal;
            if (std::abs(cosine) <= most_cosine) continue;
            (distance > 0 ? over : under)[cosine < 0] = true;
        }
    };
    look_at(set.voxel);
    for_neighbors(level, set.voxel, look_at);
    return (over[0] && over[1]) || (under[0] && under[1]);
}

Vec3 middle_of(const OctreeLevel& level, Index voxel) {
    const VoxelCoord c = level.coord(voxel);
    return (Vec3(c[0], c[1], c[2]) + Vec3(0.5, 0.5, 0.5)) * level.voxel_size;
}

void remove(const OctreeLevel& level, const std::vector<std::uint8_t>& is_outlier, NormalSets& sets) {
    Index kept = 0;
    for (std::size_t v = 0, s = 0; v < level.size(); ++v) {
        const std::size_t begin = s, end = sets.first[v + 1];
        sets.first[v] = kept;
        std::array<std::uint8_t, NormalSets::most_per_voxel> renumbered;
        for (; s < end; ++s) {
            renumbered[s - begin] =
                is_outlier[s] ? NormalSets::no_set : static_cast<std::uint8_t>(kept - sets.first[v]);
            if (!is_outlier[s]) sets.sets[kept++] = sets.sets[s];
        }
        if (kept - sets.first[v] == end - begin) continue; // nothing went, as nearly everywhere
        for (Index p = level.first_point[v]; p < level.first_point[v + 1]; ++p)
            if (std::uint8_t& number = sets.of_point[p]; number != NormalSets::no_set)
                number = renumbered[number];
    }
    sets.first.back() = kept;
    sets.sets.resize(kept);
}

} // namespace

SetSizes sizes_of(const NormalSets& sets) {
    SetSizes sizes;
    for (const NormalSet& set : sets.sets) {
        const double count = set.count;
        sizes.points += count;
        sizes.squares += count * count;
    }
    return sizes;
}

Occurrences drop_outlier_sets(const OctreeLevel& level, const RelationTest& related, NormalSets& sets,
                              const OutlierSetOptions& options) {
    const double typical = options.typical > 0 ? options.typical : sizes_of(sets).typical();
    const double most = std::max(1.0, options.most_share * typical);
    std::vector<std::uint8_t> is_outlier(sets.sets.size(), 0);
    for_chunks(sets.sets.size(), chunks::slow, [&](std::size_t begin, std::size_t end, std::size_t) {
        std::vector<Index> group;
        for (std::size_t s = begin; s < end; ++s)
            is_outlier[s] =
                sets.sets[s].count <= most
                && (reaches_few(level, related, sets, most, options.most_sets, static_cast<Index>(s), group)
                    || lies_between(level, sets, most, related.cos_smooth(), static_cast<Index>(s)));
    });
    Occurrences points;
    for (std::size_t s = 0; s < is_outlier.size(); ++s)
        if (is_outlier[s]) points.add({sets.sets[s].count, middle_of(level, sets.sets[s].voxel)});
    if (points.count > 0) remove(level, is_outlier, sets);
    return points;
}

} // namespace hsdm
