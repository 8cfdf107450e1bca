#include "hsdm/cloud/point_attributes.hh"

#include "hsdm/cloud/strided.hh"

#include <algorithm>
#include <cmath>
#include <limits>

namespace hsdm {

using Type = VertexProperty::Type;

double PointAttribute::operator()(Index point) const {
    constexpr double opaque = 255;
    if (is_constant) return opaque;
    return type == Type::uint8 ? channel_at(rows, point, place) : number_at(rows, point, 0);
}

std::vector<PointAttribute> attributes_of(const PointView& cloud) {
    std::vector<PointAttribute> attributes;
    if (cloud.colors.count > 0) {
        const auto channels = static_cast<std::size_t>(cloud.color_channels);
        for (std::size_t k = 0; k < color_properties.size(); ++k)
            attributes.push_back({color_properties[k], Type::uint8, cloud.colors, k, k >= channels});
    }
    for (std::size_t s = 0; s < cloud.scalars.size(); ++s) {
        const ScalarView& scalar = cloud.scalars[s];
        const auto has_name = [&](const PointAttribute& a) { return a.name == scalar.name; };
        if (scalar.name.starts_with("hsdm_") || std::any_of(attributes.begin(), attributes.end(), has_name))
            continue;
        attributes.push_back(
            {scalar.name, scalar.is_label ? Type::int32 : Type::float64, scalar.values, s, false});
    }
    return attributes;
}

double mean_of(std::span<const WeightedValue> values) {
    double sum = 0, weight = 0;
    for (const WeightedValue& v : values)
        if (std::isfinite(v.value)) sum += v.weight * v.value, weight += v.weight;
    if (!(weight > 0)) return std::numeric_limits<double>::quiet_NaN();
    if (std::isfinite(sum)) return sum / weight;
    sum = 0;
    for (const WeightedValue& v : values)
        if (std::isfinite(v.value)) sum += v.weight * v.value / weight;
    return sum;
}

double majority_of(std::vector<WeightedValue>& values) {
    std::erase_if(values, [](const WeightedValue& v) { return !std::isfinite(v.value); }); // NaN has no order
    if (values.empty()) return 0;
    std::sort(values.begin(), values.end(), [](const WeightedValue& a, const WeightedValue& b) {
        return a.value != b.value ? a.value < b.value : a.weight < b.weight;
    });
    double best = values.front().value, most = -1;
    for (std::size_t begin = 0, end = 0; begin < values.size(); begin = end) {
        double weight = 0;
        for (; end < values.size() && values[end].value == values[begin].value; ++end)
            weight += values[end].weight;
        if (weight > most) most = weight, best = values[begin].value;
    }
    return best;
}

double average_of(Type type, std::vector<WeightedValue>& values) {
    if (type == Type::int32) return majority_of(values);
    const double mean = mean_of(values);
    if (type != Type::uint8) return mean;
    return std::isfinite(mean) ? std::round(mean) : 0; // no value at all: a byte has no other word for it
}

double average_of_equal(Type type, std::vector<WeightedValue>& values) {
    const double majority = majority_of(values); // sorts them: sums depend on their order
    return type == Type::int32 ? majority : average_of(type, values);
}

} // namespace hsdm
