#pragma once
// What new vertices have of those that they lie between: properties of an OpenMesh mesh, of any type.

#include "hsdm/types.hh"

#include <OpenMesh/Core/Utils/BaseProperty.hh>

#include <functional>
#include <span>
#include <vector>

namespace hsdm {

/// The properties of a mesh's vertices, to be set where vertices are new. Holds until properties are added or
/// removed.
class InheritedValues {
public:
    /// `begin`, `end`: the mesh's vprops_begin() and vprops_end().
    template <class Iterator>
    InheritedValues(Iterator begin, Iterator end) {
        for (; begin != end; ++begin)
            if (*begin) add(**begin);
    }

    /// The mean of the parents' values for numbers that are not whole, vectors of them, and colours, rounded
    /// to the nearest where they are bytes; the first parent's value for every other type. O(parents).
    void set(Index vertex, std::span<const Index> parents) const {
        for (const auto& rule : rules_) rule(vertex, parents);
    }

private:
    using Rule = std::function<void(Index, std::span<const Index>)>;

    void add(OpenMesh::BaseProperty& property);

    std::vector<Rule> rules_;
};

} // namespace hsdm
