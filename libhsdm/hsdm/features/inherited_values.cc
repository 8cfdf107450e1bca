#include "hsdm/features/inherited_values.hh"

#include "hsdm/polygon_mesh.hh"

#include <OpenMesh/Core/Geometry/VectorT.hh>
#include <OpenMesh/Core/Utils/Property.hh>

#include <algorithm>
#include <array>
#include <type_traits>

namespace hsdm {
namespace {

template <class Number>
Number rounded(double value) {
    if constexpr (std::is_integral_v<Number>) return static_cast<Number>(value + 0.5);
    return static_cast<Number>(value);
}

/// Differences from the first are averaged: equal values stay as they are.
template <class Number>
Number mean_of(const std::vector<Number>& values, std::span<const Index> parents) {
    const double first = static_cast<double>(values[parents[0]]);
    double sum = 0;
    for (const Index p : parents) sum += static_cast<double>(values[p]) - first;
    return rounded<Number>(first + sum / static_cast<double>(parents.size()));
}

template <class Number, int n>
OpenMesh::VectorT<Number, n> mean_of(const std::vector<OpenMesh::VectorT<Number, n>>& values,
                                     std::span<const Index> parents) {
    OpenMesh::VectorT<Number, n> mean = values[parents[0]];
    for (std::size_t k = 0; k < n; ++k) {
        const double first = static_cast<double>(mean[k]);
        double sum = 0;
        for (const Index p : parents) sum += static_cast<double>(values[p][k]) - first;
        mean[k] = rounded<Number>(first + sum / static_cast<double>(parents.size()));
    }
    return mean;
}

/// A rule that takes the mean, if the property is of the type T.
template <class T, class Rule>
bool try_mean(OpenMesh::BaseProperty& property, Rule& rule) {
    auto* const typed = dynamic_cast<OpenMesh::PropertyT<T>*>(&property);
    if (!typed) return false;
    rule = [&values = typed->data_vector()](Index v, std::span<const Index> parents) {
        values[v] = mean_of(values, parents);
    };
    return true;
}

template <class... Types, class Rule>
bool try_means(OpenMesh::BaseProperty& property, Rule& rule) {
    return (try_mean<Types>(property, rule) || ...);
}

bool is_color(const OpenMesh::BaseProperty& property) {
    const auto& names = color_properties;
    return property.name() == "v:colors"
           || std::find(names.begin(), names.end(), property.name()) != names.end();
}

} // namespace

void InheritedValues::add(OpenMesh::BaseProperty& property) {
    using namespace OpenMesh;
    Rule rule = [&property](Index v, std::span<const Index> parents) { property.copy(parents[0], v); };
    const bool has_mean = try_means<float, double, Vec2f, Vec3f, Vec4f, Vec2d, Vec3d, Vec4d>(property, rule);
    if (!has_mean && is_color(property)) try_means<std::uint8_t, Vec3uc, Vec4uc>(property, rule);
    rules_.push_back(std::move(rule));
}

} // namespace hsdm
