#include "hsdm/normals/outside.hh"

#include "hsdm/core/chunks.hh"
#include "hsdm/core/interruption.hh"
#include "hsdm/core/large_vector.hh"
#include "hsdm/normals/constants.hh"
#include "hsdm/octree/constants.hh"

#include <algorithm>
#include <cmath>

namespace hsdm {
namespace {

/// In which of the 26 directions to neighbours the way from an empty voxel out of the box is empty.
class Sky {
public:
    explicit Sky(const EmptySpace& space) : space_(space), open_(space.side() * space.side() * space.side()) {
        for (std::size_t k = 0; k < directions; ++k) {
            const auto step = way(k);
            ways_[k] =
                Vec3(static_cast<double>(step[0]), static_cast<double>(step[1]), static_cast<double>(step[2]))
                    .normalized();
        }
        const auto side = static_cast<std::int32_t>(space.side());
        for_each_in_order(open_.size(), [&](std::size_t c) { see(c, side, 0, directions / 2); });
        for_each_in_order(open_.size(), [&](std::size_t c) {
            see(open_.size() - 1 - c, side, directions / 2, directions);
        });
    }
    /// Whether most of the sky over a plane through a voxel is open, weighed by the cosine.
    bool mostly_open(const VoxelCoord& c, const Vec3& normal) const {
        const auto last = static_cast<std::int32_t>(space_.side()) - 2;
        for (const std::int32_t x : c)
            if (x < -1 || x > last) return true;
        const std::uint32_t open = open_[space_.cell(c)];
        double seen = 0, all = 0;
        for (std::size_t k = 0; k < directions; ++k) {
            const double cosine = ways_[k] | normal;
            if (cosine <= 0) continue;
            all += cosine;
            if ((open >> k & 1) != 0) seen += cosine;
        }
        return 2 * seen > all;
    }

private:
    static constexpr std::size_t directions = 26;

    /// The neighbour's number in a block of 27 without the middle: the first half comes before the middle.
    static std::array<std::int64_t, 3> way(std::size_t k) {
        const auto n = static_cast<std::int64_t>(k < directions / 2 ? k : k + 1);
        return {n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1};
    }
    /// The directions `from` to `to` of a voxel whose neighbours that way are done.
    void see(std::size_t cell, std::int32_t side, std::size_t from, std::size_t to) {
        if (!space_.is_empty(cell)) return;
        const auto place = static_cast<std::int64_t>(cell);
        const std::array<std::int64_t, 3> at{place % side, place / side % side, place / side / side};
        for (std::size_t k = from; k < to; ++k) {
            const std::array<std::int64_t, 3> step = way(k);
            const std::array<std::int64_t, 3> next{at[0] + step[0], at[1] + step[1], at[2] + step[2]};
            const bool out = std::ranges::any_of(next, [&](std::int64_t x) { return x < 0 || x >= side; });
            if (out
                || (open_[static_cast<std::size_t>((next[2] * side + next[1]) * side + next[0])] >> k & 1)
                       != 0)
                open_[cell] |= std::uint32_t{1} << k;
        }
    }

    const EmptySpace& space_;
    std::vector<std::uint32_t> open_;
    std::array<Vec3, directions> ways_;
};

/// Looks from a patch along its normal, both ways.
class View {
public:
    View(const Octree& octree, const OctreeLevel& level, const EmptySpace& space, const Patches& patches,
         double spacing)
        : octree_(octree), level_(level), space_(space), patches_(patches), spacing_(spacing) {}

    /// Empty space counts if it is seen at two places: one voxel may be empty by chance.
    Sight look(const Vec3& from, const Vec3& along) const {
        Index last = EmptySpace::occupied, searched = no_index; // most voxels are passed twice
        for (int step = 0; step <= views::steps; ++step) {
            const VoxelCoord c = voxel_at(from + along * (0.5 * step * level_.voxel_size));
            const Index region = space_.region(c);
            if (region == EmptySpace::occupied) {
                const Index voxel = level_.find(c);
                const Index point = voxel == searched ? no_index : sheet_ahead(voxel, from, along);
                if (point != no_index) return {no_index, patches_.of_point[point], c};
                searched = voxel;
            } else if (region == last) {
                return {region, no_index, c};
            }
            last = region;
        }
        return {};
    }

private:
    VoxelCoord voxel_at(const Vec3& p) const {
        VoxelCoord c;
        for (unsigned k = 0; k < 3; ++k)
            c[k] = static_cast<std::int32_t>(std::floor(p[k] / level_.voxel_size));
        return c;
    }
    /// The first point of the voxel in front of the patch and off its own plane; some of its points are
    /// looked at.
    Index sheet_ahead(Index voxel, const Vec3& from, const Vec3& along) const {
        constexpr Index looked_at = 64;
        const Index begin = level_.first_point[voxel], end = level_.first_point[voxel + 1];
        const double h = spacing_;
        Index first = no_index;
        double nearest = std::numeric_limits<double>::infinity();
        for (Index i = begin; i < end; i += 1 + (end - begin) / looked_at) {
            const Vec3 d = octree_.positions[i] - from;
            const double ahead = d | along;
            // A ray that passes a sheet meets one of its points within that width.
            if (ahead > views::off_plane * h && ahead < nearest
                && d.sqrnorm() - ahead * ahead < spacings::beside * spacings::beside * h * h)
                nearest = ahead, first = i;
        }
        return first;
    }

    const Octree& octree_;
    const OctreeLevel& level_;
    const EmptySpace& space_;
    const Patches& patches_;
    double spacing_;
};

bool between_regions(const Sights& s) {
    return s[0].region != no_index && s[1].region != no_index && s[0].region != s[1].region;
}

/// Sheets that follow each other along a ray face alternately forward and back; how strongly that relates two
/// patches. It is strong if the ray meets the sheet head-on (weighed as patch_evidence weighs a pair of
/// points); a sheet beside the ray, such as the other face of an obtuse crease near by, says nothing.
/// Negative if the patches' normals are alike.
double facing(const Patches& patches, Index p, Index q) {
    const Vec3 d = patches.centroids[q] - patches.centroids[p];
    const double cosine = patches.normals[p] | patches.normals[q];
    const double mirrored = cosine - 2 * (patches.normals[p] | d) * (patches.normals[q] | d) / d.sqrnorm();
    return mirrored * cosine < 0 ? mirrored : 0;
}

/// The sight of a patch on its side away from another patch.
const Sight& far_sight(const std::vector<Sights>& seen, const Patches& patches, Index p, Index other) {
    const bool ahead = (patches.normals[p] | (patches.centroids[other] - patches.centroids[p])) > 0;
    return seen[p][ahead ? 1 : 0];
}

/// Per region +1 outside, -1 inside, 0 unknown. Regions with many patches between them are of opposite kinds,
/// those with two sheets between them of one kind; though if the gap is no wider than the voxels, one is in
/// places seen from the other through both sheets.
std::vector<std::int8_t> classify(std::size_t regions, const std::vector<Sights>& seen,
                                  const Patches& patches) {
    std::vector<SignedEdge> between;
    const auto relate = [&](Index a, Index b, float relation) {
        if (a != b && relation != 0)
            between.push_back({std::min(a, b), std::max(a, b), relation, std::abs(relation)});
    };
    for_each_in_order(seen.size(), [&](std::size_t place) {
        const auto p = static_cast<Index>(place);
        const auto weight = static_cast<float>(patches.counts[p]);
        if (between_regions(seen[p])) relate(seen[p][0].region, seen[p][1].region, -weight);
        for (std::size_t side : {0u, 1u}) {
            const Index q = seen[p][side].patch;
            if (q == no_index || q == p || seen[p][1 - side].region == no_index) continue;
            const Index farther = far_sight(seen, patches, q, p).region;
            const auto surely = static_cast<float>(std::abs(facing(patches, p, q)));
            if (farther != no_index) relate(seen[p][1 - side].region, farther, weight * surely);
        }
    });
    const Signs signs = agglomerate(regions, between);
    std::vector<std::int8_t> kind(regions, 0);
    for (std::size_t r = 0; r < regions; ++r)
        if (signs.component[r] == signs.component[0])
            kind[r] = static_cast<std::int8_t>(signs.sign[r] * signs.sign[0]);
    return kind;
}

std::vector<SignedEdge> facing_patches(const std::vector<Sights>& seen, const Patches& patches) {
    std::vector<SignedEdge> edges;
    for_each_in_order(seen.size(), [&](std::size_t place) {
        const auto p = static_cast<Index>(place);
        for (const Sight& sight : seen[p]) {
            const Index q = sight.patch;
            if (q == no_index || q == p) continue;
            const float weight = in_steps(patches.counts[p] * facing(patches, p, q));
            if (weight != 0)
                push_large(edges, SignedEdge{std::min(p, q), std::max(p, q), weight, std::abs(weight)});
        }
    });
    return edges;
}

/// On which side patches have most of the sky open, if on one side only.
std::vector<std::int8_t> sky_of(const EmptySpace& space, const std::vector<Sights>& seen,
                                const Patches& patches, std::span<const std::uint8_t> beside) {
    const Sky sky(space);
    std::vector<std::int8_t> result = large_vector<std::int8_t>(patches.size());
    for_each_index(patches.size(), chunks::light, [&](Index p) {
        const auto open = [&](std::size_t side, const Vec3& normal) {
            const Sight& sight = seen[p][side];
            return sight.region != no_index && (beside[p] >> side & 1) == 0
                   && sky.mostly_open(sight.voxel, normal);
        };
        result[p] = static_cast<std::int8_t>(open(0, patches.normals[p]) - open(1, -patches.normals[p]));
    });
    return result;
}

/// What the points of patches in a voxel see of the sky: the sum of the ways that lead to it.
struct SkyOfVoxel {
    Vec3 ways{0, 0, 0};
    double points = 0;

    void add(const Vec3& way, double count) { ways += count * way, points += count; }
};

/// The sky of all voxels that patches lie in.
class SkyOfVoxels {
public:
    SkyOfVoxels(const EmptySpace& space, const Patches& patches, const std::vector<std::int8_t>& sky,
                double voxel_size)
        : space_(space),
          number_(space.side() * space.side() * space.side(), no_index),
          inverse_size_(1 / voxel_size) {
        for_each_in_order(sky.size(), [&](std::size_t p) {
            if (sky[p] == 0) return;
            Index& number = number_[space_.cell(voxel_at(patches.centroids[p]))];
            if (number == no_index) {
                number = static_cast<Index>(voxels_.size());
                voxels_.emplace_back();
            }
            voxels_[number].add(sky[p] * patches.normals[p], patches.counts[p]);
        });
    }

    /// Is most of what is seen of the sky around a place on that side? A layer may lie in the next voxel.
    bool is_clear(const Vec3& place, const Vec3& way) const {
        const VoxelCoord c = voxel_at(place);
        double along = 0, points = 0;
        for (std::int32_t z = -1; z <= 1; ++z)
            for (std::int32_t y = -1; y <= 1; ++y)
                for (std::int32_t x = -1; x <= 1; ++x) {
                    const Index v = number_[space_.cell(VoxelCoord{c[0] + x, c[1] + y, c[2] + z})];
                    if (v != no_index) along += voxels_[v].ways | way, points += voxels_[v].points;
                }
        return along >= turning::clear_views * points;
    }

private:
    VoxelCoord voxel_at(const Vec3& p) const {
        const auto last = static_cast<std::int32_t>(space_.side()) - 3; // of the cube, without its margin
        VoxelCoord c;
        for (unsigned k = 0; k < 3; ++k)
            c[k] = std::clamp(static_cast<std::int32_t>(std::floor(p[k] * inverse_size_)), 0, last);
        return c;
    }

    const EmptySpace& space_;
    std::vector<Index> number_; // per cell of the space
    std::vector<SkyOfVoxel> voxels_;
    double inverse_size_;
};

std::vector<std::int8_t> clear_sky_of(const EmptySpace& space, const Patches& patches,
                                      const std::vector<std::int8_t>& sky, double voxel_size) {
    const SkyOfVoxels around(space, patches, sky, voxel_size);
    std::vector<std::int8_t> clear = large_vector<std::int8_t>(sky.size());
    for_each_index(sky.size(), chunks::light, [&](Index p) {
        const bool is_clear =
            sky[p] != 0 && around.is_clear(patches.centroids[p], sky[p] * patches.normals[p]);
        clear[p] = is_clear ? sky[p] : std::int8_t{0};
    });
    return clear;
}

} // namespace

int depth_of_space(double cube_extent, double spacing, const OutsideOptions& options) {
    int depth = options.deepest;
    while (depth > 1 && cube_extent / static_cast<double>(1u << depth) < options.voxel_spacings * spacing)
        --depth;
    return depth;
}

std::vector<Sights> look_around(const Octree& octree, const OctreeLevel& level, const EmptySpace& space,
                                const Patches& patches, double spacing, Index begin, Index end) {
    const View view(octree, level, space, patches, spacing);
    std::vector<Sights> seen = large_vector<Sights>(end - begin);
    for_each_index(seen.size(), chunks::slow, [&](Index k) {
        const Vec3 &from = patches.centroids[begin + k], &along = patches.normals[begin + k];
        seen[k] = {view.look(from, along), view.look(from, -along)};
    });
    return seen;
}

OutsideView judge_sights(const EmptySpace& space, const std::vector<Sights>& seen, const Patches& patches,
                         double voxel_size, std::span<const std::uint8_t> beside) {
    const std::vector<std::int8_t> kind = classify(space.regions(), seen, patches);
    OutsideView result;
    assign_large(result.votes, patches.size(), 0);
    for_each_index(patches.size(), chunks::light, [&](Index p) {
        if (!between_regions(seen[p])) return;
        const std::int8_t front = kind[seen[p][0].region];
        if (front * kind[seen[p][1].region] == -1) result.votes[p] = front;
    });
    result.facing = facing_patches(seen, patches);
    if (beside.empty()) return result;
    result.sky = sky_of(space, seen, patches, beside);
    result.clear_sky = clear_sky_of(space, patches, result.sky, voxel_size);
    return result;
}

OutsideView view_outside(const Octree& octree, const Patches& patches, double spacing,
                         const OutsideOptions& options) {
    const OctreeLevel level = extract_level(octree, depth_of_space(octree.extent, spacing, options));
    const EmptySpace space(level.codes, level.depth);
    const auto all = static_cast<Index>(patches.size());
    return judge_sights(space, look_around(octree, level, space, patches, spacing, 0, all), patches,
                        level.voxel_size, options.beside);
}

} // namespace hsdm
