#include "hsdm/normals/orient_normals.hh"

#include "hsdm/core/chunks.hh"
#include "hsdm/core/interruption.hh"
#include "hsdm/core/large_vector.hh"
#include "hsdm/normals/constants.hh"
#include "hsdm/normals/layers.hh"
#include "hsdm/octree/spacing.hh"

#include <algorithm>
#include <cmath>

namespace hsdm {
namespace {

/// Signs of the components that no view decided: those that most normals came with if these count, else by
/// the sensor, else by the signed volume about their own centre.
std::vector<std::int8_t> free_signs(const Patches& patches, const Signs& signs,
                                    const OrientOptions& options) {
    std::vector<Vec3> centre(signs.components, Vec3(0, 0, 0));
    std::vector<double> points(signs.components, 0), side(signs.components, 0);
    for_each_in_order(patches.size(), [&](std::size_t p) {
        centre[signs.component[p]] += patches.centroids[p] * patches.counts[p];
        points[signs.component[p]] += patches.counts[p];
    });
    for_each_in_order(options.signs_count ? 0 : patches.size(), [&](std::size_t p) {
        const Index c = signs.component[p];
        const Vec3 from = options.sensor ? *options.sensor - patches.centroids[p]
                                         : patches.centroids[p] - centre[c] / points[c];
        side[c] += (patches.normals[p] | from) * signs.sign[p] * patches.counts[p];
    });
    for_each_in_order(options.signs_count ? patches.size() : 0,
                      [&](std::size_t p) { side[signs.component[p]] += patches.sides[p] * signs.sign[p]; });
    std::vector<std::int8_t> sign(signs.components, 1);
    for (std::size_t c = 0; c < sign.size(); ++c)
        if (side[c] < 0) sign[c] = -1;
    return sign;
}

/// Do most views of patches agree with the signs found? The wall of a shell thinner than the space's voxels
/// is missed in places, from inside as often as from outside.
bool views_agree(const Patches& patches, const OutsideView& view, const Signs& signs) {
    const auto outside = static_cast<Index>(patches.size());
    double sum = 0, total = 0;
    for_each_in_order(patches.size(), [&](std::size_t p) {
        if (view.votes[p] == 0 || signs.component[p] != signs.component[outside]) return;
        sum += view.votes[p] * signs.sign[p] * signs.sign[outside] * static_cast<double>(patches.counts[p]);
        total += patches.counts[p];
    });
    return sum >= turning::clear_views * total;
}

/// That patches see the outside, which is the node after them: `votes` per patch, +1 in front, -1 behind.
void add_views(const std::vector<std::int8_t>& votes, const Patches& patches,
               std::vector<SignedEdge>& edges) {
    const auto outside = static_cast<Index>(patches.size());
    for_each_in_order(patches.size(), [&](std::size_t p) {
        if (votes[p] == 0) return;
        const auto weight = turning::view_weight * static_cast<float>(patches.counts[p]);
        push_large(edges,
                   SignedEdge{static_cast<Index>(p), outside, static_cast<float>(votes[p]) * weight, weight});
    });
}

/// The evidence of patches as of layers of one surface, and what they see of the sky.
LayerReading read_as_layers(const Octree& octree, const Neighbors& neighbors,
                            const EstimatedNormals& estimate, const Patches& patches) {
    LayerReading layers;
    layers.edges = layer_evidence(octree, neighbors, estimate, patches);
    const std::vector<std::uint8_t> beside = sheets_beside(octree, neighbors, estimate, patches);
    OutsideView view = view_outside(octree, patches, estimate_spacing(octree), {.beside = beside});
    layers.sky = std::move(view.sky), layers.clear_sky = std::move(view.clear_sky);
    return layers;
}

/// Reads the evidence alone and with the clear sky, which is outside. An edge counts by all that is said of
/// it, however that was divided.
SkyReading layers_taken(const Patches& patches, LayerReading&& layers, Signs& signs) {
    merge_edges(layers.edges, patches.size());
    layers.signs = agglomerate(patches.size(), layers.edges);
    std::vector<SignedEdge> edges;
    reserve_large(edges, layers.edges.size() + patches.size());
    append_large(edges, layers.edges);
    add_views(layers.clear_sky, patches, edges);
    layers.skyward = agglomerate(patches.size() + 1, edges, static_cast<Index>(patches.size()));
    return take_layers(patches, layers, signs);
}

} // namespace

const Vec3* Viewpoints::of(Index source) const {
    if (sensors.empty()) return nullptr;
    const double number = sensor_of.count == 0 ? 0 : number_at(sensor_of, source, 0);
    return number >= 0 && number < static_cast<double>(sensors.size())
               ? &sensors[static_cast<std::size_t>(number)]
               : nullptr;
}

std::vector<float> seen_by_sensors(const Octree& octree, const Patches& patches, const Viewpoints& viewpoints,
                                   std::span<const Index> source) {
    constexpr double grazing = 0.1; // a cosine: at such angles noise of the normal decides
    std::vector<float> votes = large_vector<float>(viewpoints.sensors.empty() ? 0 : patches.size(), 0);
    for_each_in_order(votes.empty() ? 0 : octree.size(), [&](std::size_t i) {
        const Index p = patches.of_point[i];
        const Vec3* sensor = p == no_index ? nullptr : viewpoints.of(source[i]);
        if (sensor == nullptr) return;
        const Vec3 way = *sensor - octree.positions[i];
        const double cosine = (patches.normals[p] | way) / way.norm();
        if (std::abs(cosine) > grazing) votes[p] += cosine > 0 ? 1 : -1;
    });
    return votes;
}

PatchSigns sign_patches(const Patches& patches, std::vector<SignedEdge> edges, const OutsideView& view,
                        const std::vector<float>& seen_by, const OrientOptions& options,
                        const std::function<LayerReading()>& evidence_of_layers) {
    const auto outside = static_cast<Index>(patches.size());
    reserve_large(edges, edges.size() + view.facing.size() + patches.size());
    append_large(edges, view.facing);
    PatchSigns result;
    OrientReport& report = result.report;
    add_views(view.votes, patches, edges);
    for_each_in_order(patches.size(), [&](std::size_t p) {
        if (view.votes[p] != 0) report.seen_from_outside += patches.counts[p];
    });
    for_each_in_order(seen_by.size(), [&](std::size_t p) {
        const float vote = turning::sensor_weight * seen_by[p];
        if (vote != 0) edges.push_back({static_cast<Index>(p), outside, vote, std::abs(vote)});
    });
    Signs signs = agglomerate(patches.size() + 1, edges, outside);
    const bool scanned = std::ranges::any_of(seen_by, [](float vote) { return vote != 0; });
    SkyReading sky;
    if (!scanned && signs.contradicted > turning::least_contradicted) {
        LayerReading layers = evidence_of_layers();
        // Normals that came with the points tell layers by themselves; what is open on both sides are walls.
        if (options.signs_count) layers.clear_sky = layers.sky;
        sky = layers_taken(patches, std::move(layers), signs);
    }
    std::vector<std::int8_t> turn = free_signs(patches, signs, options);
    std::vector<std::uint8_t> is_known(turn.size(), 0); // by views or by the sky
    const auto decide = [&](std::size_t component, std::int8_t sign) {
        turn[component] = sign;
        is_known[component] = 1;
    };
    if (scanned || views_agree(patches, view, signs)) decide(signs.component[outside], signs.sign[outside]);
    for (std::size_t c = 0; c < sky.outward.size(); ++c)
        if (sky.outward[c] != 0) decide(c, sky.outward[c]);
    report.patches = patches.size();
    report.of_layers = sky.points;
    report.components = signs.components; // the outside's node is a component too if no patch sees it
    for_each_in_order(patches.size(), [&](std::size_t p) {
        if (!is_known[signs.component[p]]) report.by_volume += patches.counts[p];
    });
    resize_large(result.sign, patches.size());
    for_each_index(patches.size(), chunks::light, [&](Index p) {
        result.sign[p] = static_cast<std::int8_t>(signs.sign[p] * turn[signs.component[p]]);
    });
    return result;
}

std::vector<std::uint8_t> turns_of(const Patches& patches, const std::vector<std::int8_t>& sign) {
    std::vector<std::uint8_t> turns = large_vector<std::uint8_t>(patches.of_point.size());
    for_each_index(turns.size(), chunks::light, [&](Index i) {
        const Index p = patches.of_point[i];
        turns[i] = p != no_index && patches.sign[i] * sign[p] < 0;
    });
    return turns;
}

Orientation orient_normals(const Octree& octree, const Neighbors& neighbors, const EstimatedNormals& estimate,
                           const OrientOptions& options, const std::function<void()>& meanwhile) {
    const Patches patches = build_patches(octree, neighbors, estimate);
    OutsideView view;
    std::vector<SignedEdge> edges;
    run_both([&] { view = view_outside(octree, patches, estimate_spacing(octree)); },
             [&] { edges = patch_evidence(octree, neighbors, estimate, patches); });
    const auto as_layers = [&] { return read_as_layers(octree, neighbors, estimate, patches); };
    PatchSigns signs;
    run_both(
        [&] {
            const std::vector<float> seen_by =
                seen_by_sensors(octree, patches, options.viewpoints, octree.source);
            signs = sign_patches(patches, std::move(edges), view, seen_by, options, as_layers);
        },
        meanwhile);
    return {turns_of(patches, signs.sign), signs.report};
}

void turn_normals(const Orientation& orientation, std::vector<Vec3>& normals) {
    for_each_index(normals.size(), chunks::light, [&](Index i) {
        if (orientation.turns[i]) normals[i] = -normals[i];
    });
}

} // namespace hsdm
