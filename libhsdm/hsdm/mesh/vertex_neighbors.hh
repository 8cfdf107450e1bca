#pragma once
// The vertices beside each vertex of a polygon mesh, as flat arrays.

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

} // namespace hsdm
