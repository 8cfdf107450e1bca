#pragma once
// Where the space lies that opens if what is straight at a mesh's border goes on straight.

#include "hsdm/completion/lattice.hh"
#include "hsdm/mesh/fill_holes.hh"

namespace hsdm {

/// Of all surfaces that close a mesh the least one, if walls that go on from two borders towards each other
/// cost next to nothing (after Schnabel, Degener, Klein, Completion and reconstruction with primitive shapes,
/// 2009). What is outside of that one and inside of the least surface without such walls is continued space:
/// bores, slots and channels of which the ends alone were seen, also where they cross.
class ContinuedSpace {
public:
    /// None.
    ContinuedSpace() = default;
    /// `mesh`: facets outward. Two minimum cuts on a grid of at most 48 cells along the mesh.
    ContinuedSpace(const PolygonMesh& mesh, const BoundaryLoops& border, double voxel_size);

    bool empty() const { return outside_.empty(); }
    /// Does a place lie in it, a cell away from what bounds it?
    bool holds(const Vec3& place) const;

private:
    void take_cells(const Lattice& lattice, const std::vector<std::uint8_t>& open,
                    const std::vector<std::uint8_t>& closed);

    LatticePlace place_;
    std::vector<std::uint8_t> outside_; ///< per cell, x fastest: are all corners outside, and no mesh in it?
    std::vector<std::uint8_t> continued_; ///< per cell: does a corner lie in continued space?
};

} // namespace hsdm
