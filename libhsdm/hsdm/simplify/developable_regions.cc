#include "hsdm/simplify/developable_regions.hh"

#include "hsdm/core/chunks.hh"
#include "hsdm/core/constants.hh"
#include "hsdm/core/parallel_sort.hh"
#include "hsdm/simplify/constants.hh"

#include <algorithm>
#include <cmath>
#include <utility>

namespace hsdm {
namespace {

Axis cylinder_axis(const NormalSum& normals) {
    const Variation variation = normals.about_zero();
    return {variation.direction[0], 0, variation.deviation[0]};
}

Axis cone_axis(const NormalSum& normals) {
    const Variation variation = normals.about_mean();
    const Vec3& direction = variation.direction[0];
    return {direction, direction | normals.mean(), variation.deviation[0]};
}

/// A cone's axis only if a cylinder's does not fit: the normals of a narrow arc are at one angle to many
/// directions.
Axis axis_of(const NormalSum& normals) {
    const Axis cylinder = cylinder_axis(normals);
    if (cylinder.deviation <= developable::most_deviation) return cylinder;
    const Axis cone = cone_axis(normals);
    return cone.deviation < developable::cone_share * cylinder.deviation ? cone : cylinder;
}

/// Removes facets at the margins that bend away, and fits the axis to the rest. Returns those removed.
std::vector<Index> trim(const FacetField& field, DevelopableRegion& region) {
    NormalSum normals;
    std::vector<Index> trimmed;
    std::erase_if(region.facets, [&](Index f) {
        const double cosine = region.axis.direction | field.mean_normal[f];
        if (std::abs(cosine - region.axis.cosine) > developable::most_off_trimmed) {
            trimmed.push_back(f);
            return true;
        }
        normals.add(field.mean_normal[f], field.area[f].norm());
        return false;
    });
    region.axis = axis_of(normals);
    return trimmed;
}

DevelopableRegion grow(const FacetField& field, Index seed, const std::vector<Index>& taken,
                       std::vector<std::uint8_t>& seen) {
    DevelopableRegion region{{seed}, cylinder_axis(field.around[seed]), field.convex[seed] != 0};
    region.axis.cosine = region.axis.direction | field.mean_normal[seed];
    seen[seed] = 1;
    NormalSum normals;
    std::size_t refit = developable::first_refit;
    for (std::size_t next = 0; next < region.facets.size(); ++next) {
        if (next % chunks::quick == 0) Interruption::poll();
        const Index f = region.facets[next];
        normals.add(field.mean_normal[f], field.area[f].norm());
        if (next + 1 == refit) {
            region.axis = axis_of(normals);
            refit *= 2;
        }
        field.for_beside(f, [&](Index g) {
            if (taken[g] != no_index || seen[g] || (field.convex[g] != 0) != region.convex) return;
            const double cosine = region.axis.direction | field.mean_normal[g];
            if (std::abs(cosine - region.axis.cosine) > developable::most_off) return;
            seen[g] = 1;
            region.facets.push_back(g);
        });
    }
    region.axis = axis_of(normals);
    return region;
}

} // namespace

std::vector<DevelopableRegion> find_developable_regions(const FacetField& field,
                                                        const std::vector<Index>& taken) {
    using Seed = std::pair<double, Index>;
    const auto add_bent = [&](std::size_t begin, std::size_t end, std::vector<Seed>& part) {
        for (auto f = static_cast<Index>(begin); f < end; ++f)
            if (taken[f] == no_index && field.next_spread[f] <= developable::most_ratio * field.spread[f])
                part.emplace_back(field.next_spread[f] / std::max(field.spread[f], 1e-12), f);
    };
    std::vector<Seed> seeds = collected<Seed>(field.size(), chunks::light, add_bent);
    parallel_sort(seeds);
    std::vector<DevelopableRegion> regions;
    std::vector<std::uint8_t> seen(field.size(), 0), trims(field.size(), 0);
    for_each_in_order(seeds.size(), [&](std::size_t s) {
        const Index seed = seeds[s].second;
        if (seen[seed]) return;
        DevelopableRegion region = grow(field, seed, taken, seen);
        const std::vector<Index> trimmed = trim(field, region);
        // a strip on a fillet of a few rows at least
        if (region.facets.size() < 2 * flat_ground::least_facets
            || region.axis.deviation > developable::most_deviation)
            return;
        regions.push_back(std::move(region));
        for (Index f : trimmed)
            if (++trims[f] <= repeats::twice) seen[f] = 0; // free for another region
    });
    return regions;
}

} // namespace hsdm
