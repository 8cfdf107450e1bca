#include "hsdm/contour/patch_neighborhood.hh"

#include "hsdm/contour/components.hh"
#include "hsdm/contour/constants.hh"
#include "hsdm/core/chunks.hh"
#include "hsdm/core/constants.hh"
#include "hsdm/octree/constants.hh"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace hsdm {
namespace {

/// The shortest of the ways that are offered; of equally long ones those that came first.
class ShortestWays {
public:
    struct Way {
        double squared_length;
        std::uint32_t p, q;
    };

    /// Would a way as long be taken?
    bool wants(double squared_length) const { return squared_length < longest_; }
    void offer(const Way& way) {
        if (!wants(way.squared_length)) return;
        std::size_t at = count_ == nearest_asked ? count_ - 1 : count_++;
        for (; at > 0 && way.squared_length < ways_[at - 1].squared_length; --at) ways_[at] = ways_[at - 1];
        ways_[at] = way;
        if (count_ == nearest_asked) longest_ = ways_[count_ - 1].squared_length;
    }
    std::span<const Way> found() const { return {ways_.data(), count_}; }

private:
    std::array<Way, nearest_asked> ways_;
    std::size_t count_ = 0;
    double longest_ = Box::inf;
};

/// No more than from any place in the box, as products and sums are rounded one way.
double squared_distance(const Vec3& p, const Box& box) {
    Vec3 off;
    for (std::size_t axis = 0; axis < 3; ++axis)
        off[axis] = std::max(0.0, std::max(box.lo[axis] - p[axis], p[axis] - box.hi[axis]));
    return off.sqrnorm();
}

/// Of a set's points, from one sample to the next.
Index stride_of_samples(const NormalSet& set) {
    return static_cast<Index>(chunk_count(set.count, patches::most_samples));
}
double samples_of(const NormalSet& set) {
    return static_cast<double>(chunk_count(set.count, stride_of_samples(set)));
}

bool opposed(const NormalSet& a, const NormalSet& b) {
    return (a.normal | b.normal) < angles::opposed;
}

} // namespace

void sample_set(const OctreeLevel& level, const NormalSets& sets, Index set, std::vector<Index>& samples) {
    const NormalSet& s = sets.sets[set];
    Index skipped = 0; // points of the set until the next sample
    sets.for_points_of(set, level, [&](Index k) {
        if (skipped-- > 0) return;
        samples.push_back(k);
        skipped = stride_of_samples(s) - 1;
    });
}

void PatchNeighborhood::gather(Index voxel) {
    at_.sets.clear();
    add_sets(voxel);
    own_ = at_.sets.size();
    for_neighbors(level_, voxel, [&](Index v) { add_sets(v); });
    at_.first_sample.clear();
    at_.spacings.assign(size(), -1);
    at_.heights.assign(size(), {Box::inf, -Box::inf});
    at_.has_row.assign(size(), 0);
    at_.one_sheet.resize(size() * size());
    at_.of_sheet.resize(size() * (size() + 1));
    most_points_ = 0;
    for (std::size_t i = 0; i < size(); ++i) most_points_ = std::max(most_points_, set(i).count);
}

void PatchNeighborhood::add_sets(Index v) {
    for (Index s = sets_.first[v]; s < sets_.first[v + 1]; ++s) at_.sets.push_back(s);
}

bool PatchNeighborhood::is_crowded(const SetDiscs& discs) const {
    return std::ranges::any_of(at_.sets, [&](Index s) { return discs.first[s] < discs.first[s + 1]; });
}

void PatchNeighborhood::place_discs(const SetDiscs& discs) {
    at_.discs.reset(size(), set(0).centroid, level_.voxel_size);
    for (const Index s : at_.sets) at_.discs.add(sets_.sets[s].normal, discs.of(s));
}

/// Of all sets, when they are asked for: most voxels have no two that anything could part.
void PatchNeighborhood::take_samples() {
    if (!at_.first_sample.empty()) return;
    at_.first_sample.assign(1, 0);
    at_.samples.clear();
    at_.boxes.assign(size(), Box{});
    for (std::size_t i = 0; i < size(); ++i) {
        for (const Index k : sampled(i)) {
            at_.samples.push_back(octree_.positions[k]);
            at_.boxes[i].add(octree_.positions[k]);
        }
        at_.first_sample.push_back(static_cast<Index>(at_.samples.size()));
    }
    for (std::size_t i = 0; i < size(); ++i) at_.samples.push_back(set(i).centroid);
    at_.discs.set_places(at_.samples);
}

/// Spacing of the samples on the sheet of a set, from the fullest of its sets around; 0 if they are too few
/// for a sheet.
double PatchNeighborhood::spacing(std::size_t i) {
    double& known = at_.spacings[i];
    if (known >= 0) return known;
    double points = 0, squares = 0;
    Index scanned = 0; // points of the sheet
    for (const std::uint32_t j : sheet_of(i)) {
        const double n = samples_of(set(j));
        points += n;
        squares += n * n;
        scanned += set(j).count;
    }
    // A wall that fills half of a voxel's width in three voxels has more than half; odd normals have not.
    const double least = std::max(spacings::points_per_voxel, 0.5 * most_points_);
    return known = scanned < least ? 0 : level_.voxel_size * std::sqrt(points / squares);
}

/// The sets of a set's sheet: itself, and those smooth with it.
std::span<const std::uint32_t> PatchNeighborhood::sheet_of(std::size_t i) {
    std::uint32_t* const sheet = at_.of_sheet.data() + i * (size() + 1);
    if (!at_.has_row[i]) {
        std::uint8_t* const row = at_.one_sheet.data() + i * size();
        *sheet = 0;
        for (std::size_t k = 0; k < size(); ++k) {
            row[k] =
                at_.has_row[k] ? at_.one_sheet[k * size() + i] : k == i || related_.smooth(set(i), set(k));
            if (row[k]) sheet[++*sheet] = static_cast<std::uint32_t>(k);
        }
        at_.has_row[i] = 1;
    }
    return {sheet + 1, *sheet};
}

void PatchNeighborhood::add_facing(const NormalSet& from, const NormalSet& a, const NormalSet& b) {
    at_.facing.push_back({VectorPair(a.normal, b.normal), VectorPair(a.centroid, b.centroid),
                          Double2{from.normal | a.normal, from.normal | b.normal}});
}

/// The sets that face another, two at a time.
void PatchNeighborhood::find_facing(std::size_t i) {
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

void PatchNeighborhood::add_discs(std::size_t i, std::vector<SeenDisc>& discs) {
    find_facing(i);
    if (at_.facing.empty()) return;
    const double radius = spacings::beside * spacing(i);
    if (radius == 0) return;
    for (const Index k : sampled(i)) add_discs_at(octree_.positions[k], set(i).normal, radius, discs);
}

/// The discs between a sheet at one of its points and the nearest opposite one behind it and before it.
void PatchNeighborhood::add_discs_at(const Vec3& p, const Vec3& normal, double radius,
                                     std::vector<SeenDisc>& discs) const {
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

std::size_t PatchNeighborhood::connect_samples(std::size_t i, std::vector<std::uint8_t>& patch) {
    patch.assign(sampled(i).size(), 0);
    if (!at_.discs.stand_on(surface(i))) return 1;
    take_samples();
    if (!at_.discs.look_at(std::array{surface(i)}, at_.boxes[i])) return 1;
    const std::size_t first = first_sample(i);
    return label_components(
        patch.size(), [&](std::size_t k) -> std::uint8_t& { return patch[k]; },
        [&](std::size_t k, std::size_t j) { return !at_.discs.part(first + k, first + j); });
}

bool PatchNeighborhood::apart(std::size_t i, std::size_t j) {
    if (!at_.discs.stand_on(surface(i)) && !at_.discs.stand_on(surface(j))) return false;
    take_samples();
    ShortestWays ways;
    for (std::uint32_t p = first_sample(i); p < first_sample(i + 1); ++p)
        if (ways.wants(squared_distance(at_.samples[p], at_.boxes[j])))
            for (std::uint32_t q = first_sample(j); q < first_sample(j + 1); ++q)
                ways.offer({(at_.samples[q] - at_.samples[p]).sqrnorm(), p, q});
    Box box;
    for (const auto& [squared_length, p, q] : ways.found()) {
        box.add(at_.samples[p]);
        box.add(at_.samples[q]);
    }
    if (!at_.discs.look_at(std::array{surface(i), surface(j)}, box)) return false;
    const std::size_t most = ways.found().size() / 2; // more are most of them
    std::size_t parted_ways = 0, open_ways = 0;
    for (const auto& [squared_length, p, q] : ways.found()) {
        ++(at_.discs.part(p, q) ? parted_ways : open_ways);
        if (parted_ways > most) return true;
        if (open_ways >= ways.found().size() - most) return false;
    }
    return false;
}

/// Where two planes would meet.
struct PatchNeighborhood::Crease {
    const NormalSet &a, &b; // a's sheet may go on beyond b's
    Vec3 along;             // the crease
    double sine, outward;   // of the angle; what turns heights over b's plane to ways along a's, beyond
    double here, far;       // b's place along the crease, and how far from there or off a is too far
    double least, most;     // how far beyond a point tells that a goes on
    double half_window;     // along the crease: in it b's sheet is beside a point
};

/// How far off the plane of a set the samples of its sheet lie, at least and at most.
std::pair<double, double> PatchNeighborhood::heights(std::size_t i) {
    auto& known = at_.heights[i];
    if (known.first > known.second)
        for (const std::uint32_t k : sheet_of(i))
            for (const Vec3& p : samples(k)) {
                const double height = set(i).normal | (p - set(i).centroid);
                known.first = std::min(known.first, height);
                known.second = std::max(known.second, height);
            }
    return known;
}

/// May samples of a set lie within so much of `from` in a direction? What rounding may hide is generous:
/// coordinates are at most 2^16 voxels.
bool PatchNeighborhood::passes(std::size_t i, const Vec3& direction, double from, double most) const {
    const double rounding = 1e-6 * level_.voxel_size;
    const Box& box = at_.boxes[i];
    const Vec3 middle = (box.lo + box.hi) * 0.5, half = (box.hi - box.lo) * 0.5;
    double reach = most + rounding;
    for (std::size_t axis = 0; axis < 3; ++axis) reach += std::abs(direction[axis]) * half[axis];
    return std::abs((direction | middle) - from) <= reach;
}

/// Samples of a's sheet near the crease: where along it, and how far beyond the other's plane.
void PatchNeighborhood::find_near_crease(std::size_t i, const Crease& crease) {
    const auto& [a, b, along, sine, outward, here, far, least, most, half_window] = crease;
    const double height = b.normal | b.centroid, gap = relations::smooth_gap * level_.voxel_size;
    at_.near.clear();
    for (const std::uint32_t k : sheet_of(i)) {
        if (!passes(k, b.normal, height, most * sine) || !passes(k, along, here, far)) continue;
        for (std::size_t sample = first_sample(k); sample < first_sample(k + 1); ++sample) {
            const Vec3& p = at_.samples[sample];
            const double s = along | p, t = outward * (b.normal | (p - b.centroid));
            // One branch, as neither can be foreseen.
            if (int{std::abs(s - here) > far} | int{std::abs(t) > most}) continue;
            if (std::abs(a.normal | (p - a.centroid)) > gap) continue;
            at_.near.push_back({s, t, sample});
        }
    }
}

/// Where b's sheet is near the crease: the place along it, and how far off its plane, for normals have
/// errors. Returns the least of the latter.
double PatchNeighborhood::find_places_of_other(std::size_t j, const Crease& crease) {
    const auto& [a, b, along, sine, outward, here, far, least, most, half_window] = crease;
    const double height = a.normal | a.centroid, wide = far + 2 * half_window; // what is looked up
    double lowest = Box::inf;
    at_.places.clear();
    for (const std::uint32_t k : sheet_of(j)) {
        if (!passes(k, a.normal, height, far) || !passes(k, along, here, wide)) continue;
        for (const Vec3& q : samples(k)) {
            const double s = along | q;
            if (!(std::abs(a.normal | (q - a.centroid)) < far) || !(std::abs(s - here) < wide)) continue;
            at_.places.emplace_back(s, outward * (b.normal | (q - b.centroid)));
            lowest = std::min(lowest, at_.places.back().second);
        }
    }
    return lowest;
}

/// How far beyond its plane b's sheet lies at a place along the crease, at least and at most; the wrong way
/// round where it is not. Its places must ascend.
std::pair<double, double> PatchNeighborhood::other_beside(double along, const Crease& crease) const {
    double lowest = crease.most, highest = -crease.most;
    auto place = std::lower_bound(at_.places.begin(), at_.places.end(),
                                  std::pair(along - crease.half_window, -crease.most));
    for (; place != at_.places.end() && place->first <= along + crease.half_window; ++place) {
        lowest = std::min(lowest, place->second);
        highest = std::max(highest, place->second);
    }
    return {lowest, highest};
}

bool PatchNeighborhood::goes_on(std::size_t i, std::size_t j, Relation relation) {
    const NormalSet &a = set(i), &b = set(j);
    const double step = spacing(i);
    if (step == 0) return false;
    take_samples();
    const Vec3 cross = a.normal % b.normal;
    const double sine = cross.norm();
    const Vec3 along = cross / sine;
    const Crease crease{a,
                        b,
                        along,
                        sine,
                        (relation == Relation::convex ? 1 : -1) / sine,
                        along | b.centroid,
                        sheets::beside * level_.voxel_size,
                        patches::goes_on_from * step,
                        patches::goes_on_within * step,
                        0.5 * step};
    find_near_crease(i, crease);
    if (at_.near.size() < points_of_plane) return false;
    // Enough of them must lie beyond all of the other sheet: at a crease none do.
    const auto enough_beyond = [&](double lowest) {
        return std::ranges::count_if(at_.near,
                                     [&](const auto& p) { return p.beyond > lowest + crease.least; })
               >= std::ptrdiff_t{points_of_plane};
    };
    const auto [low, high] = heights(j);
    if (!enough_beyond(crease.outward * (crease.outward > 0 ? low : high))) return false;
    if (!enough_beyond(find_places_of_other(j, crease))) return false;
    std::sort(at_.places.begin(), at_.places.end());
    const std::size_t middle = at_.first_sample.back() + i; // the centroid
    unsigned beyond = 0, before = 0;
    for (const auto& [s, t, sample] : at_.near) {
        const auto [lowest, highest] = other_beside(s, crease);
        if (lowest > highest) continue; // the other sheet is not there
        before += t < lowest - crease.least;
        if (!(t > highest + crease.least)) continue;
        Box way;
        way.add(at_.samples[middle]);
        way.add(at_.samples[sample]);
        beyond += !at_.discs.look_at(std::array{surface(i)}, way) || !at_.discs.part(middle, sample);
    }
    return beyond >= points_of_plane && 2 * beyond >= before;
}

} // namespace hsdm
