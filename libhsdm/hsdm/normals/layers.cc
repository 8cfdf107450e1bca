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
};

/// What differs of a component.
struct Question {
    Views all;
    std::size_t clear = 0; ///< points of regions that are clearly layers

    bool shows_layers() const { return 2 * clear > all.points; }
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

} // namespace

SkyReading take_layers(const Patches& patches, const LayerReading& layers, Signs& walls) {
    const Signs& other = layers.signs;
    const std::vector<std::int8_t> out = outward_signs(patches, layers.sky, walls),
                                   other_out = outward_signs(patches, layers.sky, other);
    std::vector<std::uint8_t> differ = large_vector<std::uint8_t>(patches.size(), 0);
    for_each_index(patches.size(), chunks::light, [&](Index p) {
        differ[p] =
            out[walls.component[p]] * walls.sign[p] * other_out[other.component[p]] * other.sign[p] < 0;
    });
    DisjointSets regions(patches.size());
    for_each_in_order(layers.edges.size(), [&](std::size_t e) {
        const SignedEdge& edge = layers.edges[e];
        if (edge.weight != 0 && differ[edge.a] != 0 && differ[edge.b] != 0) regions.join(edge.a, edge.b);
    });
    std::vector<Views> of_region = large_vector<Views>(patches.size());
    std::vector<Question> of_component(walls.components);
    const auto for_differing = [&](const auto& work) {
        for_each_in_order(patches.size(), [&](std::size_t p) {
            if (differ[p] != 0)
                work(p, regions.find(static_cast<Index>(p)), of_component[walls.component[p]]);
        });
    };
    for_differing([&](std::size_t p, Index region, Question& question) {
        const int faces = layers.sky[p] * other.sign[p] * other_out[other.component[p]];
        of_region[region].add(patches.counts[p], faces);
        question.all.add(patches.counts[p], faces);
    });
    for_differing([&](std::size_t p, Index region, Question& question) {
        if (of_region[region].are_clear()) question.clear += patches.counts[p];
    });
    SkyReading result;
    std::vector<std::uint8_t> turned(walls.components, 0);
    for_differing([&](std::size_t p, Index region, const Question& question) {
        const Views& views = of_region[region];
        if (question.all.facing <= 0) return;
        if (!views.are_clear() && (!question.shows_layers() || views.facing < 0)) return;
        walls.sign[p] = static_cast<std::int8_t>(-walls.sign[p]);
        turned[walls.component[p]] = 1;
        result.points += patches.counts[p];
    });
    result.outward = outward_signs(patches, layers.sky, walls);
    for (std::size_t c = 0; c < turned.size(); ++c)
        if (turned[c] == 0) result.outward[c] = 0;
    return result;
}

} // namespace hsdm
