#pragma once
// Where coarse meshes pass through themselves.

#include "hsdm/simplify/content_keys.hh"

#include <array>

namespace hsdm {

/// Looks at one mesh after the other, and again only at facets that have changed and those beside them: two
/// that were in the mesh before and did not intersect do not now.
class IntersectionCheck {
public:
    /// The facet_pairs of find_self_intersections. O(n), but for the facets looked at; parallel.
    std::vector<std::array<Index, 2>> find(const PolygonMesh& mesh);

private:
    std::vector<std::uint8_t> changed(std::span<const Key> keys) const;

    KeySet clear_; // facets of the mesh before that intersected no other
};

} // namespace hsdm
