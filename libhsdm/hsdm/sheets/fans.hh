#pragma once
// Crossings round each voxel form closed or open chains; each chain is one mesh vertex. See docs/sheets.md.

#include "hsdm/sheets/pairing.hh"

namespace hsdm {

/// A crossing seen from the voxel at one position of its ring: 4 * crossing + position. One corner of one
/// facet.
using Node = std::uint32_t;

/// The vertices: fan v is nodes[first[v]] .. nodes[first[v + 1]], in order around the vertex.
struct Fans {
    std::vector<Node> nodes;
    std::vector<Index> first{0};
    std::vector<Index> of_node; ///< per node, its fan
    /// Voxels where the two sides of a thin part and its rims leave a polygon between three or more fans.
    std::vector<std::vector<Index>> caps;
    std::vector<Index> after_cut; ///< fans that were cut off the fan before them, in the same voxel
    std::size_t cut = 0;          ///< chains cut at rims into two or more vertices

    std::size_t size() const { return first.size() - 1; }
    std::span<const Node> fan(Index v) const {
        return {nodes.data() + first[v], nodes.data() + first[v + 1]};
    }
};

/// Walks the chains. A closed chain that goes round the rim of a thin part twice or more is cut there: its
/// sides keep vertices of their own and the rim gets its own facets. O(crossings), parallel.
Fans build_fans(const Crossings& crossings, const Links& links);

} // namespace hsdm
