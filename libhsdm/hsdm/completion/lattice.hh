#pragma once
// The corners of a part of a regular grid, and where a mesh passes between them.

#include "hsdm/core/morton_index.hh"
#include "hsdm/polygon_mesh.hh"

namespace hsdm {

/// Where grid points lie: whole multiples of the spacing from an origin.
struct LatticePlace {
    Vec3 origin{0, 0, 0};
    double spacing = 0;
    VoxelCoord last{0, 0, 0}; ///< greatest coordinates; the least are 0

    Vec3 position(const VoxelCoord& c) const { return origin + Vec3(c[0], c[1], c[2]) * spacing; }
    /// In grid coordinates.
    Vec3 local(const Vec3& p) const { return (p - origin) * (1 / spacing); }
    bool holds(const VoxelCoord& c) const {
        for (unsigned k = 0; k < 3; ++k)
            if (c[k] < 0 || c[k] > last[k]) return false;
        return true;
    }
};

/// A mesh passing the edge from a grid point to the next one up an axis.
struct LatticeHit {
    Index edge = 0;       ///< 3 * lower grid point + axis
    double t = 0;         ///< in [0, 1] along it
    Vec3 normal{0, 0, 0}; ///< unit, of the facet
};

/// Grid points in Morton order with their neighbours, and the hits of their edges.
struct Lattice {
    LatticePlace place;
    std::vector<MortonCode> codes;
    std::vector<std::array<Index, 6>> next; ///< per grid point, up each axis, then down each; or no_index
    std::vector<LatticeHit> hits;           ///< by edge, then t
    std::vector<Index> first_hit;           ///< per edge, and one more
    MortonIndex index;

    std::size_t size() const { return codes.size(); }
    VoxelCoord coord(Index point) const { return morton_decode(codes[point]); }
    Index find(const VoxelCoord& c) const { return place.holds(c) ? index.find(morton_encode(c)) : no_index; }
    std::span<const LatticeHit> on_edge(std::size_t edge) const {
        return {hits.data() + first_hit[edge], hits.data() + first_hit[edge + 1]};
    }
};

/// Adds the codes within `radius` steps along each axis, inside the lattice. Ascending, each once.
void dilate(const LatticePlace& place, int radius, std::vector<MortonCode>& codes);

/// All grid points of a lattice. Ascending.
std::vector<MortonCode> all_points(const LatticePlace& place);

/// The lattice of these grid points (ascending, each once) and where a mesh passes its edges. O(points +
/// facets), parallel; the same for any number of threads.
Lattice build_lattice(const LatticePlace& place, std::vector<MortonCode> codes, const PolygonMesh& mesh);

/// Where a mesh passes the edges of a lattice that was built with another, in no order that matters, and the
/// same for any number of threads. O(facets + hits), and for each facet the rows of the grid that it passes.
std::vector<LatticeHit> find_hits(const Lattice& lattice, const PolygonMesh& mesh);

/// Calls visit(grid point, distance) for the points next to where the mesh passes an edge: the distance from
/// the plane there, in grid steps, negative behind it. Of an edge that it passes more than once each end has
/// the hit next to it.
template <class Visit>
void for_each_beside(const Lattice& lattice, Visit&& visit) {
    for (std::size_t h = 0; h < lattice.hits.size(); ++h) {
        const LatticeHit& hit = lattice.hits[h];
        const double across = hit.normal[hit.edge % 3];
        const Index lower = hit.edge / 3, upper = lattice.next[lower][hit.edge % 3];
        if (h == 0 || lattice.hits[h - 1].edge != hit.edge) visit(lower, -hit.t * across);
        if (upper != no_index && (h + 1 == lattice.hits.size() || lattice.hits[h + 1].edge != hit.edge))
            visit(upper, (1 - hit.t) * across);
    }
}

} // namespace hsdm
