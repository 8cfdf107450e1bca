#include "hsdm/pipeline/attributes.hh"

#include "hsdm/cloud/point_attributes.hh"
#include "hsdm/core/chunks.hh"
#include "hsdm/core/groups.hh"

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

} // namespace hsdm
