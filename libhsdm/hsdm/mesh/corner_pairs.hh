#pragma once
// Which facets have two vertices for corners: along their sides, and across them, where they may be cut.

#include "hsdm/polygon_mesh.hh"

#include <array>
#include <span>

namespace hsdm {

/// Two vertices, the lower one first.
using VertexPair = std::array<Index, 2>;

inline VertexPair pair_of(Index a, Index b) {
    return a < b ? VertexPair{a, b} : VertexPair{b, a};
}

/// The pairs of corners of all facets, between given vertices.
class CornerPairs {
public:
    /// O(facets), parallel; sorts the pairs between these vertices.
    CornerPairs(const PolygonMesh& mesh, std::span<const Index> vertices);

    /// Are both corners of a facet that is none of these?
    bool are_together(const VertexPair& pair, std::span<const Index> but) const;

private:
    struct Pair {
        VertexPair vertices;
        Index facet;
        auto operator<=>(const Pair&) const = default;
    };
    std::vector<Pair> pairs_;
};

} // namespace hsdm
