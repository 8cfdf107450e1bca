#include "hsdm/normals/layers.hh"

#include "hsdm/core/chunks.hh"
#include "hsdm/core/disjoint_sets.hh"
#include "hsdm/core/interruption.hh"
#include "hsdm/core/large_vector.hh"
#include "hsdm/normals/constants.hh"

#include <algorithm>

namespace hsdm {
namespace {

/// Of some patches: points, those that see the sky, and of these the ones that face it less the others.
struct Views {
    std::size_t points = 0, seeing = 0;
    std::ptrdiff_t facing = 0;

    void add(std::size_t count, int faces) {
        points += count;
        seeing += faces != 0 ? count : 0;
        facing += faces * static_cast<std::ptrdiff_t>(count);
    }
    /// Do most face it, and more than see it at a rim?
    bool are_clear() const {
        const auto net = static_cast<double>(facing);
        return net > turning::clear_views * static_cast<double>(seeing)
               && net > turning::least_seeing * static_cast<double>(points);
    }
    /// Do three of four of those that see it, however few, turn away from it?
    bool turn_away() const {
        return static_cast<double>(facing) < -turning::clear_views * static_cast<double>(seeing);
    }
};

/// +1 for components whose patches face the sky more than they turn away from it, -1 for the others, 0
/// without a view.
std::vector<std::int8_t> outward_signs(const Patches& patches, const std::vector<std::int8_t>& sky,
                                       const Signs& signs) {
    std::vector<Views> views(signs.components);
    for_each_in_order(patches.size(), [&](std::size_t p) {
        views[signs.component[p]].add(patches.counts[p], sky[p] * signs.sign[p]);
    });
    std::vector<std::int8_t> outward(signs.components);
    for (std::size_t c = 0; c < outward.size(); ++c)
        outward[c] = static_cast<std::int8_t>((views[c].facing > 0) - (views[c].facing < 0));
    return outward;
}

/// Where signs of walls differ from those of layers, and what these see of the sky there.
class Differences {
public:
    Differences(const Patches& patches, const std::vector<std::int8_t>& sky, const Signs& walls,
                const Signs& layers)
        : patches_(patches), sign_(large_vector<std::int8_t>(patches.size())), differ_(sign_.size()) {
        const std::vector<std::int8_t> out = outward_signs(patches, sky, walls),
                                       layers_out = outward_signs(patches, sky, layers);
        for_each_index(patches.size(), chunks::light, [&](Index p) {
            const int sign = layers.sign[p] * layers_out[layers.component[p]];
            differ_[p] = out[walls.component[p]] * walls.sign[p] * sign < 0;
            sign_[p] = static_cast<std::int8_t>(sign);
        });
    }

    bool at(std::size_t patch) const { return differ_[patch] != 0; }
    /// Those of another reading where `takes(patch)`.
    template <class Takes>
    void take(const Differences& other, const Takes& takes) {
        for_each_index(patches_.size(), chunks::light, [&](Index p) {
            if (takes(p)) sign_[p] = other.sign_[p], differ_[p] = other.differ_[p];
        });
    }
    /// What those of each group see; group_of(patch) is its number.
    template <class GroupOf>
    std::vector<Views> views(const std::vector<std::int8_t>& sky, std::size_t groups,
                             const GroupOf& group_of) const {
        std::vector<Views> result = large_vector<Views>(groups);
        for_each_in_order(patches_.size(), [&](std::size_t p) {
            if (at(p)) result[group_of(p)].add(patches_.counts[p], sky[p] * sign_[p]);
        });
        return result;
    }

private:
    const Patches& patches_;
    std::vector<std::int8_t> sign_; // of layers
    std::vector<std::uint8_t> differ_;
};

} // namespace

SkyReading take_layers(const Patches& patches, const LayerReading& layers, Signs& walls) {
    const auto component_of = [&](std::size_t p) { return walls.component[p]; };
    const std::vector<std::int8_t>& sky = layers.clear_sky;
    Differences differences(patches, sky, walls, layers.signs);
    const std::vector<Views> unbiased = differences.views(sky, walls.components, component_of);
    const Differences skyward(patches, sky, walls, layers.skyward);
    const std::vector<Views> with_sky = skyward.views(sky, walls.components, component_of);
    // The sky corrects what is known without it; where it turns half as much again, it made that up.
    differences.take(skyward, [&](std::size_t p) {
        return 3 * unbiased[component_of(p)].points > 2 * with_sky[component_of(p)].points;
    });
    DisjointSets joined(patches.size());
    for_each_in_order(layers.edges.size(), [&](std::size_t e) {
        const SignedEdge& edge = layers.edges[e];
        if (edge.weight != 0 && differences.at(edge.a) && differences.at(edge.b)) joined.join(edge.a, edge.b);
    });
    const auto region_of = [&](std::size_t p) { return joined.find(static_cast<Index>(p)); };
    const std::vector<Views> of_region = differences.views(sky, patches.size(), region_of),
                             all_of_region = differences.views(layers.sky, patches.size(), region_of),
                             of_component = differences.views(sky, walls.components, component_of);
    const auto for_differing = [&](const auto& work) {
        for_each_in_order(patches.size(), [&](std::size_t p) {
            if (differences.at(p)) work(p, region_of(p), component_of(p));
        });
    };
    std::vector<std::size_t> clear(walls.components, 0); // points
    for_differing([&](std::size_t p, Index region, Index component) {
        if (of_region[region].are_clear()) clear[component] += patches.counts[p];
    });
    SkyReading result;
    std::vector<std::uint8_t> turned(walls.components, 0);
    for_differing([&](std::size_t p, Index region, Index component) {
        if (unbiased[component].facing <= 0) return;
        const bool most_are_clear = 2 * clear[component] > of_component[component].points;
        if (!of_region[region].are_clear() && (all_of_region[region].turn_away() || !most_are_clear)) return;
        walls.sign[p] = static_cast<std::int8_t>(-walls.sign[p]);
        turned[component] = 1;
        result.points += patches.counts[p];
    });
    result.outward = outward_signs(patches, sky, walls);
    for (std::size_t c = 0; c < turned.size(); ++c)
        if (turned[c] == 0) result.outward[c] = 0;
    return result;
}

} // namespace hsdm
