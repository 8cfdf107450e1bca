#include "hsdm/pipeline/attributes.hh"

#include "hsdm/cloud/point_attributes.hh"
#include "hsdm/core/chunks.hh"
#include "hsdm/core/groups.hh"
#include "hsdm/core/parallel_sort.hh"

#include <algorithm>

namespace hsdm {
namespace {

class VoxelAverages {
public:
    VoxelAverages(const Octree& octree, const OctreeLevel& level, std::span<const Index> voxel)
        : octree_(octree), level_(level), voxel_(voxel) {}

    VertexProperty operator()(const PointAttribute& attribute) const {
        VertexProperty property{attribute.name, attribute.type, std::vector<double>(voxel_.size())};
        for_chunks(voxel_.size(), chunks::slow, [&](std::size_t begin, std::size_t end, std::size_t) {
            std::vector<WeightedValue> values;
            for (std::size_t v = begin; v != end; ++v) {
                values.clear();
                for (Index p = level_.first_point[voxel_[v]]; p < level_.first_point[voxel_[v] + 1]; ++p)
                    if (octree_.source[p] != no_index)
                        values.push_back({value_at(octree_.source[p], attribute), 1});
                property.values[v] = average_of(attribute.type, values);
            }
        });
        return property;
    }

private:
    /// The value at a place where the cloud has one point or several equal ones, which give one value in any
    /// order.
    double value_at(Index point, const PointAttribute& attribute) const {
        if (octree_.duplicates.empty()) return attribute(point);
        const auto [begin, end] = std::equal_range(
            octree_.duplicates.begin(), octree_.duplicates.end(), Octree::Duplicate{point, 0},
            [](const auto& a, const auto& b) { return a.first < b.first; });
        if (begin == end) return attribute(point);
        std::vector<WeightedValue> values{{attribute(point), 1}};
        for (auto it = begin; it != end; ++it) values.push_back({attribute(it->other), 1});
        const double majority = majority_of(values); // sorts them: sums depend on their order
        return attribute.type == VertexProperty::Type::int32 ? majority : mean_of(values);
    }

    const Octree& octree_;
    const OctreeLevel& level_;
    std::span<const Index> voxel_;
};

} // namespace

std::vector<VertexProperty> average_attributes(const PointView& cloud, const Octree& octree,
                                               const OctreeLevel& level, std::span<const Index> voxel) {
    using Type = VertexProperty::Type;
    const VoxelAverages averages(octree, level, voxel);
    std::vector<VertexProperty> properties;
    for (const PointAttribute& attribute : attributes_of(cloud)) properties.push_back(averages(attribute));
    properties.push_back(
        {"hsdm_level", Type::uint8, std::vector<double>(voxel.size(), static_cast<double>(level.depth))});
    return properties;
}

std::vector<VertexProperty> merge_attributes(std::span<const VertexProperty> properties,
                                             std::span<const Index> into, std::size_t count) {
    const Groups members(into, count);
    std::vector<VertexProperty> result;
    for (const VertexProperty& property : properties) {
        VertexProperty merged{property.name, property.type, std::vector<double>(count)};
        for_chunks(count, chunks::slow, [&](std::size_t begin, std::size_t end, std::size_t) {
            std::vector<WeightedValue> values;
            for (std::size_t v = begin; v != end; ++v) {
                values.clear();
                for (Index member : members.of(v)) values.push_back({property.values[member], 1});
                merged.values[v] = average_of(property.type, values);
            }
        });
        result.push_back(std::move(merged));
    }
    return result;
}

void spread_attributes(PolygonMesh& mesh, std::vector<std::uint8_t> known) {
    std::vector<VertexProperty*> properties;
    for (VertexProperty& property : mesh.properties)
        if (!property.name.starts_with("hsdm_")) properties.push_back(&property);
    if (properties.empty()) return;
    std::vector<std::array<Index, 2>> sides; // from an unknown vertex to one beside it
    for_each_in_order(mesh.facet_count(), [&](std::size_t f) {
        const auto corners = mesh.facet(f);
        for (std::size_t c = 0; c < corners.size(); ++c) {
            const Index a = corners[c], b = corners[(c + 1) % corners.size()];
            if (known[a] == 0) sides.push_back({a, b});
            if (known[b] == 0) sides.push_back({b, a});
        }
    });
    parallel_sort_unique(sides);
    std::vector<Index> first(mesh.vertex_count() + 1, 0);
    for (const auto& side : sides) ++first[side[0] + 1];
    counts_to_first(first);
    const auto beside = [&](Index v) {
        return std::span(sides.data() + first[v], sides.data() + first[v + 1]);
    };
    const auto is_known = [&](const std::array<Index, 2>& side) { return known[side[1]] != 0; };
    // Round by round: those beside a known one get their values from those that had some before the round.
    std::vector<Index> front = indices_where(mesh.vertex_count(), chunks::light, [&](Index v) {
        return known[v] == 0 && std::ranges::any_of(beside(v), is_known);
    });
    std::vector<WeightedValue> values;
    while (!front.empty()) {
        Interruption::poll();
        std::vector<Index> next;
        for (const Index v : front)
            for (VertexProperty* property : properties) {
                values.clear();
                for (const auto& side : beside(v))
                    if (is_known(side)) values.push_back({property->values[side[1]], 1});
                property->values[v] = average_of(property->type, values);
            }
        for (const Index v : front) known[v] = 1;
        for (const Index v : front)
            for (const auto& side : beside(v))
                if (!is_known(side)) next.push_back(side[1]);
        sort_unique(next);
        front.swap(next);
    }
}

} // namespace hsdm
