#pragma once
// A function that is negative inside and positive outside, also where a mesh has holes.

#include "hsdm/completion/lattice.hh"

#include <cmath>

namespace hsdm {

/// On the finest level, a band around the surface that is missing.
struct CompletionField {
    Lattice lattice;
    std::vector<double> value; ///< per grid point, about the signed distance where the mesh is near
    std::vector<std::uint8_t>
        known; ///< per grid point: 0 solved for, 1 beside the mesh, 2 taken from the coarser level

    /// Does the missing surface pass this edge (3 * lower grid point + axis)?
    bool is_open(std::size_t edge) const {
        const Index a = static_cast<Index>(edge / 3), b = lattice.next[a][edge % 3];
        return b != no_index && (value[a] < 0) != (value[b] < 0) && (known[a] != 2 || known[b] != 2)
               && lattice.on_edge(edge).empty();
    }
};

/// visit(position) along edges of a mesh, at their ends and no farther apart than `step`.
template <class Visit>
void for_each_sample(const PolygonMesh& mesh, std::span<const std::array<Index, 2>> edges, double step,
                     const Visit& visit) {
    for (const auto& [a, b] : edges) {
        const Vec3 &p = mesh.positions[a], way = mesh.positions[b] - p;
        const double steps = std::max(1.0, std::ceil(way.norm() / step));
        for (double s = 0; s <= steps; ++s) visit(p + way * (s / steps));
    }
}

/// Diffuses inside and outside from a mesh with a border (oriented, facets outward; its boundary edges as
/// pairs of vertices) into the volume: harmonic between its two sides and the outside around it, level by
/// level, each in a band around the zero level of the coarser one (after Davis, Marschner, Garr, Levoy,
/// Filling holes in complex surfaces using volumetric diffusion, 2002). O(facets + missing area), `spacing`
/// being the finest grid's.
CompletionField completion_field(const PolygonMesh& mesh, std::span<const std::array<Index, 2>> border,
                                 double spacing);

} // namespace hsdm
