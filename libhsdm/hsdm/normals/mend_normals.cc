#include "hsdm/normals/mend_normals.hh"

#include "hsdm/core/chunks.hh"
#include "hsdm/core/constants.hh"
#include "hsdm/normals/constants.hh"
#include "hsdm/normals/estimate_normals.hh"
#include "hsdm/normals/orient_normals.hh"
#include "hsdm/octree/constants.hh"
#include "hsdm/octree/spacing.hh"

#include <algorithm>
#include <cmath>

namespace hsdm {
namespace {

/// How two points next to each other lie.
struct Pair {
    enum Kind { unclear, flat, creased, steep } kind = unclear;
    bool opposed = false;
    double rise = 0; ///< sine of the angle between the chord and the planes
};

/// Points far from each other, planes apart and unclear angles say nothing.
Pair compare(const NormalSample::Point& one, const NormalSample::Point& other, double farthest) {
    const Vec3 &n = one.normal, &m = other.normal;
    const Vec3 d = other.position - one.position;
    const double length = d.norm(), cosine = n | m;
    if (n.sqrnorm() == 0 || m.sqrnorm() == 0 || length == 0 || length > farthest) return {};
    const double rise_n = (n | d) / length, rise_m = (m | d) / length;
    const double rise = std::max(std::abs(rise_n), std::abs(rise_m));
    if (std::abs(cosine) > angles::smooth && rise < contradictions::flattest)
        return {Pair::flat, cosine < 0, rise};
    if (cosine > angles::smooth) return {Pair::steep, false, rise};
    const double mirrored = cosine - 2 * rise_n * rise_m; // see patch_evidence
    if (std::abs(cosine) < angles::facing && std::abs(mirrored) > angles::facing)
        return {Pair::creased, mirrored < 0, rise};
    return {};
}

/// Sums over pairs of each point with its two successors, in a fixed order; for large clouds over a sample.
/// point(i): of the cloud.
template <class Sum, class GetPoint, class F>
Sum sum_pairs(std::size_t size, const GetPoint& point, double farthest, const F& add) {
    std::vector<Sum> parts(chunk_count(size, chunks::light));
    const std::size_t stride = NormalSample::stride(size);
    for_chunks(size, chunks::light, [&](std::size_t begin, std::size_t end, std::size_t chunk) {
        for (std::size_t i = begin; i < end; i += stride)
            for (std::size_t j = i + 1; j < std::min(size, i + 3); ++j)
                add(compare(point(i), point(j), farthest), static_cast<Index>(i), parts[chunk]);
    });
    Sum sum;
    for (const Sum& part : parts) sum += part;
    return sum;
}

struct Rise {
    double sum = 0, pairs = 0;
    void operator+=(const Rise& other) { sum += other.sum, pairs += other.pairs; }
};

/// Mean rise of the flat pairs that agree: what curvature and noise make of points on one plane.
template <class GetPoint>
double mean_rise(std::size_t size, const GetPoint& point, double farthest) {
    const Rise rise = sum_pairs<Rise>(size, point, farthest, [](const Pair& pair, Index, Rise& sum) {
        if (pair.kind == Pair::flat && !pair.opposed) sum.sum += pair.rise, sum.pairs += 1;
    });
    return rise.pairs > 0 ? rise.sum / rise.pairs : 0;
}

template <class GetPoint>
NormalConsistency check_pairs(std::size_t size, const GetPoint& point, double spacing) {
    // Most successors are as near, and none of another sheet is.
    const double farthest = spacings::beside * spacing;
    // The sides of the thinnest plate are opposed, too, but lie off each other's planes.
    const double highest = noise::deviations * mean_rise(size, point, farthest) + contradictions::added_rise;
    const auto add = [&](const Pair& pair, Index at, NormalConsistency& sum) {
        if (pair.kind == Pair::flat && pair.rise < highest) {
            ++sum.flat, sum.flat_opposed += pair.opposed;
            if (pair.opposed) sum.first_opposed = std::min(sum.first_opposed, at);
        }
        if (pair.kind == Pair::steep) ++sum.steep;
        if (pair.kind == Pair::creased) ++sum.creased, sum.creased_opposed += pair.opposed;
    };
    return sum_pairs<NormalConsistency>(size, point, farthest, add);
}

/// The given normals, turned to the sides found for patches of points whose own normals agree.
std::vector<Vec3> turned_by_normals(const Octree& octree, const Neighbors& neighbors,
                                    const OrientOptions& options) {
    EstimatedNormals given = estimate_normals(octree, neighbors, {.rounds = 0}); // for its tolerances
    given.normals = octree.normals;
    turn_normals(orient_normals(octree, neighbors, given, options), given.normals);
    return std::move(given.normals);
}

/// The given normals, each turned to the side that the normals of its neighbours' positions have, those most
/// along it most. A patch of given normals that lie askew to the surface would take the wrong side as a
/// whole.
std::vector<Vec3> turned_by_positions(const Octree& octree, const Neighbors& neighbors,
                                      const OrientOptions& options) {
    EstimatedNormals told = estimate_normals(octree, neighbors);
    turn_along(octree.normals, told.normals);
    turn_normals(orient_normals(octree, neighbors, told, options), told.normals);
    std::vector<Vec3> turned = octree.normals;
    turn_to_neighbors(told.normals, neighbors, turned);
    return turned;
}

} // namespace

bool NormalConsistency::doubtful() const {
    return (flat_opposed >= contradictions::fewest && contradictions::flat_per_opposed * flat_opposed > flat)
           || (!askew() && creased_opposed >= contradictions::fewest
               && 100 * creased_opposed > contradictions::creased_percent * creased);
}

bool NormalConsistency::askew() const {
    return contradictions::flat_per_steep * steep > flat;
}

double NormalConsistency::contradiction(bool creases_count) const {
    const auto share = [](std::size_t part, std::size_t whole) {
        return whole > 0 ? static_cast<double>(part) / static_cast<double>(whole) : 0;
    };
    return share(flat_opposed, flat) + (creases_count ? share(creased_opposed, creased) : 0);
}

void NormalConsistency::operator+=(const NormalConsistency& other) {
    flat += other.flat, flat_opposed += other.flat_opposed;
    first_opposed = std::min(first_opposed, other.first_opposed);
    creased += other.creased, creased_opposed += other.creased_opposed;
    steep += other.steep;
}

Occurrences doubtful_sides(const Octree& octree, const NormalConsistency& consistency, bool estimated) {
    const bool in_doubt = estimated ? consistency.flat_opposed >= contradictions::fewest_of_estimated
                                    : consistency.flat_opposed > 0 && consistency.doubtful();
    if (!in_doubt) return {};
    return {consistency.flat_opposed, octree.positions[consistency.first_opposed]};
}

std::size_t NormalSample::stride(std::size_t size) {
    constexpr std::size_t samples = 1 << 17;
    return size / samples + 1;
}

namespace {

/// In a chunk the first of each stride is looked at, with its two successors; so the next chunk's first two
/// are, too.
constexpr std::size_t of_stride = 3;

/// So many of a chunk's first points are in a sample of this stride.
std::size_t held_of_first(std::size_t points, std::size_t stride) {
    return points / stride * std::min(stride, of_stride) + std::min(points % stride, of_stride);
}

} // namespace

bool NormalSample::holds(std::size_t i, std::size_t size) {
    return i % chunks::light % stride(size) < of_stride;
}

const NormalSample::Point& NormalSample::at(std::size_t i, std::size_t size) const {
    const std::size_t step = stride(size);
    return points[i / chunks::light * held_of_first(chunks::light, step)
                  + held_of_first(i % chunks::light, step)];
}

NormalConsistency check_normals(const Octree& octree) {
    return octree.has_normals() ? check_normals(octree, estimate_spacing(octree)) : NormalConsistency{};
}

NormalConsistency check_normals(const Octree& octree, double spacing) {
    if (!octree.has_normals()) return {};
    const auto point = [&](std::size_t i) {
        return NormalSample::Point{octree.positions[i], octree.normals[i]};
    };
    return check_pairs(octree.size(), point, spacing);
}

NormalConsistency check_normals(const NormalSample& sample, std::size_t size, double spacing) {
    return check_pairs(
        size, [&](std::size_t i) -> const NormalSample::Point& { return sample.at(i, size); }, spacing);
}

void turn_to_neighbors(const std::vector<Vec3>& told, const Neighbors& neighbors,
                       std::vector<Vec3>& normals) {
    for_each_index(normals.size(), chunks::light, [&](Index i) {
        double side = 0;
        for (const Index j : neighbors.of(i)) {
            const double cosine = told[j] | normals[i];
            side += cosine * cosine * cosine;
        }
        if (side < 0) normals[i] = -normals[i];
    });
}

bool came_of_noise(const NormalConsistency& before, const NormalConsistency& after) {
    const bool creases_count = !before.askew();
    if (2 * after.contradiction(creases_count) > before.contradiction(creases_count)) return true;
    return !creases_count && after.creased_opposed >= contradictions::fewest
           && after.creased_opposed > 2 * before.creased_opposed;
}

std::size_t mend_normals(Octree& octree, OrientOptions options) {
    if (!octree.has_normals() || octree.size() < 2) return 0;
    const Neighbors neighbors = find_neighbors(octree);
    options.signs_count = true;
    const NormalConsistency before = check_normals(octree);
    std::vector<Vec3> mended = before.askew() ? turned_by_positions(octree, neighbors, options)
                                              : turned_by_normals(octree, neighbors, options);
    octree.normals.swap(mended);
    if (came_of_noise(before, check_normals(octree))) {
        octree.normals.swap(mended);
        return 0;
    }
    std::size_t turned = 0;
    for (std::size_t i = 0; i < octree.size(); ++i) turned += (mended[i] | octree.normals[i]) < 0;
    return turned;
}

} // namespace hsdm
