#pragma once
// Self-intersections of one coarse mesh after the other.

#include "hsdm/simplify/unchanged.hh"

#include <array>
#include <cstdint>

namespace hsdm {

/// Finds self-intersections of one mesh after the other, testing only facets that have changed and those near
/// them: two facets that were in the mesh before and did not intersect do not now.
class IntersectionCheck {
public:
    /// The facet_pairs of find_self_intersections. `same`: what the mesh has of the one before. O(n), but for
    /// the facets looked at; parallel.
    std::vector<std::array<Index, 2>> find(const PolygonMesh& mesh, const Unchanged& same);

private:
    std::vector<std::uint8_t> is_clear_; // per facet of the mesh before, did it intersect no other?
};

} // namespace hsdm
