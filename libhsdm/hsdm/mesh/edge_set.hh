#pragma once
// Which edges there are between a few vertices of a mesh: no second one may be laid there.

#include "hsdm/polygon_mesh.hh"

#include <unordered_set>

namespace hsdm {

/// Edges between marked vertices of a mesh, where no diagonal may be laid again.
class EdgeSet {
public:
    /// Of the mesh's edges those with both ends in `vertices`. A vertex that comes there more than once is
    /// one that several polygons share. O(facets).
    EdgeSet(const PolygonMesh& mesh, std::span<const Index> vertices);

    bool contains(Index a, Index b) const;
    /// Enters the edges of a new facet that other polygons might want too.
    void add(std::span<const Index> facet);

private:
    static std::uint64_t key(Index a, Index b);

    std::vector<std::uint64_t> edges_;
    std::unordered_set<std::uint64_t> added_;
    std::vector<std::uint8_t> shared_;
};

} // namespace hsdm
