#pragma once
// The edges between a few vertices of a mesh, along which no new diagonal may be laid.

#include "hsdm/polygon_mesh.hh"

#include <unordered_set>

namespace hsdm {

/// A set of the edges between given vertices of a mesh.
class EdgeSet {
public:
    /// Holds the mesh's edges with both ends in `vertices`. A vertex listed more than once is one that
    /// several polygons share. O(facets).
    EdgeSet(const PolygonMesh& mesh, std::span<const Index> vertices);

    bool contains(Index a, Index b) const;
    /// Adds those edges of a new facet that other polygons might use too.
    void add(std::span<const Index> facet);

private:
    static std::uint64_t key(Index a, Index b);

    std::vector<std::uint64_t> edges_;
    std::unordered_set<std::uint64_t> added_;
    std::vector<std::uint8_t> shared_;
};

} // namespace hsdm
