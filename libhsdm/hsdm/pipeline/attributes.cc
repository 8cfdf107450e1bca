#include "hsdm/pipeline/attributes.hh"

#include "hsdm/core/chunks.hh"
#include "hsdm/core/groups.hh"

#include <algorithm>
#include <cmath>
#include <limits>

namespace hsdm {
namespace {

/// The most frequent finite value, the least of several; leaves these, sorted.
double majority(std::vector<double>& values) {
    std::erase_if(values, [](double value) { return !std::isfinite(value); }); // NaN has no order
    if (values.empty()) return 0;
    std::sort(values.begin(), values.end());
    double best = values.front();
    std::size_t most = 0;
    for (std::size_t begin = 0, end = 0; begin < values.size(); begin = end) {
        while (end < values.size() && values[end] == values[begin]) ++end;
        if (end - begin > most) most = end - begin, best = values[begin];
    }
    return best;
}

/// Over the finite values, in their own order; a scanner's "no value" is often NaN.
double mean(const std::vector<double>& values) {
    double sum = 0;
    std::size_t count = 0;
    for (double value : values)
        if (std::isfinite(value)) sum += value, ++count;
    if (count == 0) return std::numeric_limits<double>::quiet_NaN();
    const auto n = static_cast<double>(count);
    if (std::isfinite(sum)) return sum / n;
    sum = 0;
    for (double value : values)
        if (std::isfinite(value)) sum += value / n;
    return sum;
}

class VoxelAverages {
public:
    VoxelAverages(const Octree& octree, const OctreeLevel& level, std::span<const Index> voxel)
        : octree_(octree), level_(level), voxel_(voxel) {}

    /// value_of(point) is a point's value by its index in the cloud.
    template <class ValueOf>
    VertexProperty operator()(const std::string& name, VertexProperty::Type type, bool is_label,
                              const ValueOf& value_of) const {
        VertexProperty property{name, type, std::vector<double>(voxel_.size())};
        for_chunks(voxel_.size(), 1 << 10, [&](std::size_t begin, std::size_t end, std::size_t) {
            std::vector<double> values;
            for (std::size_t v = begin; v != end; ++v) {
                values.clear();
                for (Index p = level_.first_point[voxel_[v]]; p < level_.first_point[voxel_[v] + 1]; ++p)
                    values.push_back(value_at(octree_.source[p], is_label, value_of));
                property.values[v] = is_label ? majority(values) : mean(values);
            }
        });
        return property;
    }

private:
    /// The value at a place where the cloud has one point or several equal ones, which give one value in any
    /// order.
    template <class ValueOf>
    double value_at(Index point, bool is_label, const ValueOf& value_of) const {
        if (octree_.duplicates.empty()) return value_of(point);
        const auto [begin, end] = std::equal_range(
            octree_.duplicates.begin(), octree_.duplicates.end(), Octree::Duplicate{point, 0},
            [](const auto& a, const auto& b) { return a.first < b.first; });
        if (begin == end) return value_of(point);
        std::vector<double> values{value_of(point)};
        for (auto it = begin; it != end; ++it) values.push_back(value_of(it->other));
        if (is_label) return majority(values);
        std::erase_if(values, [](double value) { return !std::isfinite(value); });
        std::sort(values.begin(), values.end()); // sums depend on their order
        return mean(values);
    }

    const Octree& octree_;
    const OctreeLevel& level_;
    std::span<const Index> voxel_;
};

} // namespace

std::vector<VertexProperty> average_attributes(const PointCloud& cloud, const Octree& octree,
                                               const OctreeLevel& level, std::span<const Index> voxel) {
    using Type = VertexProperty::Type;
    const VoxelAverages averages(octree, level, voxel);
    std::vector<VertexProperty> properties;
    if (!cloud.colors.empty()) {
        constexpr std::array<const char*, 4> names{"red", "green", "blue", "alpha"};
        for (std::size_t k = 0; k < names.size(); ++k) {
            VertexProperty channel = averages(names[k], Type::uint8, false, [&](Index p) {
                return static_cast<double>(cloud.colors[p][k]);
            });
            for (double& value : channel.values) value = std::round(value);
            properties.push_back(std::move(channel));
        }
    }
    for (const Scalar& scalar : cloud.scalars) {
        const auto has_name = [&](const VertexProperty& p) { return p.name == scalar.name; };
        if (scalar.name.starts_with("hsdm_") || std::any_of(properties.begin(), properties.end(), has_name))
            continue; // results of another reconstruction, whose names are those of this one's
        properties.push_back(averages(scalar.name, scalar.is_label ? Type::int32 : Type::float64,
                                      scalar.is_label, [&](Index p) { return scalar.values[p]; }));
    }
    properties.push_back(
        {"hsdm_level", Type::uint8, std::vector<double>(voxel.size(), static_cast<double>(level.depth))});
    return properties;
}

std::vector<VertexProperty> merge_attributes(std::span<const VertexProperty> properties,
                                             std::span<const Index> into, std::size_t count) {
    using Type = VertexProperty::Type;
    const Groups members(into, count);
    std::vector<VertexProperty> result;
    for (const VertexProperty& property : properties) {
        VertexProperty merged{property.name, property.type, std::vector<double>(count)};
        for_chunks(count, 1 << 10, [&](std::size_t begin, std::size_t end, std::size_t) {
            std::vector<double> values;
            for (std::size_t v = begin; v != end; ++v) {
                values.clear();
                for (Index member : members.of(v)) values.push_back(property.values[member]);
                double& value = merged.values[v];
                value = property.type == Type::int32 ? majority(values) : mean(values);
                if (property.type == Type::uint8) value = std::round(value);
            }
        });
        result.push_back(std::move(merged));
    }
    return result;
}

} // namespace hsdm
