#include "hsdm/contour/sets_round_face.hh"

#include "hsdm/contour/components.hh"
#include "hsdm/contour/constants.hh"
#include "hsdm/octree/constants.hh"

#include <algorithm>
#include <cmath>

namespace hsdm {
namespace {

bool adjacent(const VoxelCoord& a, const VoxelCoord& b) {
    return std::abs(a[0] - b[0]) <= 1 && std::abs(a[1] - b[1]) <= 1 && std::abs(a[2] - b[2]) <= 1;
}

} // namespace

bool SetsRoundFace::gather(Index grid_point, unsigned axis) {
    members_.clear();
    if (sets_.apart.empty()) return false;
    bool any_apart = false;
    const unsigned u = (axis + 1) % 3, v = (axis + 2) % 3;
    for (unsigned corner = 0; corner < 4; ++corner) {
        const unsigned up_u = corner & 1, up_v = corner >> 1;
        Index g = grid_point;
        if (up_u) g = grid_.next[g][u];
        if (g != no_index && up_v) g = grid_.next[g][v];
        if (g == no_index) continue;
        for (unsigned octant = 0; octant < 8; ++octant) {
            // A voxel between two corners of the face is taken at the lower one.
            if ((up_u && !(octant >> u & 1)) || (up_v && !(octant >> v & 1))) continue;
            const Index voxel = grid_.voxels[g][octant];
            if (voxel == no_index) continue;
            VoxelCoord at{static_cast<int>(octant & 1), static_cast<int>(octant >> 1 & 1),
                          static_cast<int>(octant >> 2)};
            at[u] += static_cast<int>(up_u);
            at[v] += static_cast<int>(up_v);
            for (Index s = sets_.first[voxel]; s < sets_.first[voxel + 1]; ++s) {
                members_.push_back({s, at, 0});
                any_apart = any_apart || sets_.first_apart[s] < sets_.first_apart[s + 1];
            }
        }
    }
    if (any_apart) find_patches();
    return any_apart;
}

void SetsRoundFace::find_patches() {
    label_components(
        members_.size(), [&](std::size_t i) -> std::uint8_t& { return members_[i].patch; },
        [&](std::size_t i, std::size_t j) {
            const Member &a = members_[i], &b = members_[j];
            return adjacent(a.at, b.at) && related_.smooth(set(a), set(b));
        });
}

const SetsRoundFace::Member* SetsRoundFace::find(Index s) const {
    const auto at = std::ranges::find(members_, s, &Member::set);
    return at == members_.end() ? nullptr : &*at;
}

double SetsRoundFace::points_of(std::uint8_t patch) const {
    double points = 0;
    for (const Member& m : members_)
        if (m.patch == patch) points += set(m).count;
    return points;
}

bool SetsRoundFace::parted(Index s, Index t) const {
    const Member *const a = find(s), *const b = find(t);
    if (a == nullptr || b == nullptr || a->patch == b->patch) return false;
    if (std::min(points_of(a->patch), points_of(b->patch)) < spacings::points_per_voxel) return false;
    return std::ranges::any_of(members_, [&](const Member& i) {
        return i.patch == a->patch && std::ranges::any_of(members_, [&](const Member& j) {
                   return j.patch == b->patch && related_.apart(set(i), set(j));
               });
    });
}

bool SetsRoundFace::meets(const Member& rim, std::uint8_t patch, Relation kind) const {
    return std::ranges::any_of(members_, [&](const Member& m) {
        return m.patch == patch && adjacent(rim.at, m.at) && related_(set(rim), set(m)) == kind;
    });
}

bool SetsRoundFace::joined_by_rim(Index s, Index t) const {
    const Member *const a = find(s), *const b = find(t);
    if (a == nullptr || b == nullptr) return false;
    return std::ranges::any_of(members_, [&](const Member& rim) {
        return std::ranges::any_of(std::array{Relation::convex, Relation::concave}, [&](Relation kind) {
            return meets(rim, a->patch, kind) && meets(rim, b->patch, kind);
        });
    });
}

} // namespace hsdm
