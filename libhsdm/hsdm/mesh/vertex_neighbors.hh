#pragma once
// The vertices and the facets beside vertices of a polygon mesh, as flat arrays.

#include "hsdm/polygon_mesh.hh"

namespace hsdm {

/// Per vertex, those that a side of a facet leads to or comes from, each once, ascending.
class VertexNeighbors {
public:
    /// Of all vertices, or of those alone that are marked in `wanted`. O(corners log corners), parallel.
    explicit VertexNeighbors(const PolygonMesh& mesh, std::span<const std::uint8_t> wanted = {});

    std::span<const Index> of(Index vertex) const {
        return {beside_.data() + first_[vertex], beside_.data() + first_[vertex + 1]};
    }

private:
    std::vector<Index> first_, beside_;
};

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
