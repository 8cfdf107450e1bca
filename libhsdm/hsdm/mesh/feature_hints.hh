#pragma once
// What is known about the edges of a mesh beside its facets.

#include <cstdint>
#include <vector>

namespace hsdm {

/// none: the dihedral test decides.
enum class EdgeHint : std::uint8_t { none, smooth, sharp };

struct FeatureHints {
    /// Empty, or one per side of every facet, in the facets' order, a facet's first side running from its
    /// first vertex to its second; the two sides of an edge agree.
    std::vector<EdgeHint> sides;
};

} // namespace hsdm
