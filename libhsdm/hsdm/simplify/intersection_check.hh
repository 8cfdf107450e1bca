#pragma once
// Self-intersections of one coarse mesh after the other.

#include "hsdm/simplify/content_keys.hh"

#include <array>

namespace hsdm {

/// Finds self-intersections of one mesh after the other, testing only facets that have changed and those near
/// them: two facets that were in the mesh before and did not intersect do not now.
class IntersectionCheck {
public:
    /// The facet_pairs of find_self_intersections. O(n), but for the facets looked at; parallel.
    std::vector<std::array<Index, 2>> find(const PolygonMesh& mesh);

private:
    std::vector<std::uint8_t> changed(std::span<const Key> keys) const;

    KeySet clear_; // keys of the facets of the mesh before that intersected no other
};

} // namespace hsdm
