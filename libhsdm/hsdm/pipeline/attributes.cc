#include "hsdm/pipeline/attributes.hh"

#include "hsdm/cloud/point_attributes.hh"
#include "hsdm/core/chunks.hh"
#include "hsdm/core/groups.hh"
#include "hsdm/mesh/vertex_neighbors.hh"
#include "hsdm/mesh/vertex_normals.hh"

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
                    if (is_measured(octree_.source[p]))
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
        const std::span<const Octree::Duplicate> others = duplicates_of(octree_, point);
        if (others.empty()) return attribute(point);
        std::vector<WeightedValue> values{{attribute(point), 1}};
        for (const Octree::Duplicate& equal : others) values.push_back({attribute(equal.other), 1});
        return average_of_equal(attribute.type, values);
    }

    const Octree& octree_;
    const OctreeLevel& level_;
    std::span<const Index> voxel_;
};

} // namespace

std::span<const Octree::Duplicate> duplicates_of(const Octree& octree, Index point) {
    const auto [begin, end] =
        std::equal_range(octree.duplicates.begin(), octree.duplicates.end(), Octree::Duplicate{point, 0},
                         [](const auto& a, const auto& b) { return a.first < b.first; });
    return {begin, end};
}

std::vector<VertexProperty> average_attributes(const PointView& cloud, const Octree& octree,
                                               const OctreeLevel& level, std::span<const Index> voxel) {
    const VoxelAverages averages(octree, level, voxel);
    std::vector<VertexProperty> properties;
    for (const PointAttribute& attribute : attributes_of(cloud)) properties.push_back(averages(attribute));
    properties.push_back({level_property, VertexProperty::Type::uint8,
                          std::vector<double>(voxel.size(), static_cast<double>(level.depth))});
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
    std::vector<std::uint8_t> unknown(known.size());
    for (std::size_t v = 0; v < known.size(); ++v) unknown[v] = known[v] == 0;
    const VertexNeighbors beside(mesh, unknown);
    const auto is_known = [&](Index v) { return known[v] != 0; };
    // Round by round: those beside a known one get their values from those that had some before the round.
    std::vector<Index> front = indices_where(mesh.vertex_count(), chunks::light, [&](Index v) {
        return !is_known(v) && std::ranges::any_of(beside.of(v), is_known);
    });
    std::vector<WeightedValue> values;
    while (!front.empty()) {
        Interruption::poll();
        std::vector<Index> next;
        for (const Index v : front)
            for (VertexProperty* property : properties) {
                values.clear();
                for (const Index k : beside.of(v))
                    if (is_known(k)) values.push_back({property->values[k], 1});
                property->values[v] = average_of(property->type, values);
            }
        for (const Index v : front) known[v] = 1;
        for (const Index v : front)
            for (const Index k : beside.of(v))
                if (!is_known(k)) next.push_back(k);
        sort_unique(next);
        front.swap(next);
    }
}

} // namespace hsdm
