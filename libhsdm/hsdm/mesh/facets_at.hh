#pragma once
// The facets at vertices.

#include "hsdm/polygon_mesh.hh"

#include <span>

namespace hsdm {

/// The facets at some vertices of a mesh.
class FacetsAt {
public:
    /// `wanted`: per vertex, not 0 for these vertices. O(corners + k log k) for k corners at them; parallel
    /// until these are found.
    FacetsAt(const PolygonMesh& mesh, std::span<const std::uint8_t> wanted);

    /// Ascending; none at other vertices. O(log k).
    std::span<const Index> of(Index vertex) const;
    /// At any of some vertices, or at all of them: ascending, each once.
    std::vector<Index> of_any(std::span<const Index> vertices) const;
    std::vector<Index> all() const;

private:
    std::vector<Index> vertices_, facets_; // per corner, by vertices, then facets
};

} // namespace hsdm
