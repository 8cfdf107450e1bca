#pragma once
// A function that is negative inside and positive outside, also where a mesh has holes.

#include "hsdm/completion/lattice.hh"
#include "hsdm/mesh/fill_holes.hh"

#include <functional>
#include <limits>

namespace hsdm {

/// Places that are known to lie on one side of the surface.
struct KnownSpace {
    std::function<bool(const Vec3&)> holds; ///< is a place of the mesh's coordinates one? None: no place is
    bool outside = true;                    ///< where the facets face
};

/// How the value of a grid point is known.
enum class Known : std::uint8_t {
    solved,      ///< it is the mean of those around
    beside_mesh, ///< the mesh passes an edge of it
    seen,        ///< it lies in known space, which the solution had on the wrong side
    given,       ///< at the end of the grid: outside, or taken from the coarser level
};

/// On the finest level, a band around the surface that is missing.
struct CompletionField {
    Lattice lattice;
    std::vector<double> value; ///< per grid point, about the signed distance where the mesh is near
    std::vector<Known> known;  ///< per grid point

    /// Does the missing surface pass this edge (3 * lower grid point + axis)?
    bool is_open(std::size_t edge) const {
        const Index a = static_cast<Index>(edge / 3), b = lattice.next[a][edge % 3];
        return b != no_index && (value[a] < 0) != (value[b] < 0)
               && (known[a] != Known::given || known[b] != Known::given) && lattice.on_edge(edge).empty();
    }
};

/// Diffuses inside and outside from a mesh with a border (oriented, facets outward) into the volume: harmonic
/// between its two sides and the outside around it, level by level, each in a band around the zero level of
/// the coarser one (after Davis, Marschner, Garr, Levoy, Filling holes in complex surfaces using volumetric
/// diffusion, 2002). Grid points in known space that come out on the other side are held on its own in a
/// second solution, unless the mesh is beside them. O(levels * facets + missing area), `spacing` being the
/// finest grid's; with known space, + its border's area. Throws Error if grids take more bytes than this,
/// reckoned with 200 a grid point (190 to 200 were measured, docs/tiles.md).
CompletionField completion_field(const PolygonMesh& mesh, const BoundaryLoops& border, double spacing,
                                 const KnownSpace& known_space = {},
                                 std::size_t most_bytes = std::numeric_limits<std::size_t>::max());

} // namespace hsdm
