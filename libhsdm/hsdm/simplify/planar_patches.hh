#pragma once
// What of a surface may become one plane: flat ground, and strips of what bends one way only.

#include "hsdm/simplify/quadric.hh"

namespace hsdm {

struct PlanarPatches {
    std::vector<Index> patch; ///< per facet, or no_index
    std::vector<Plane> planes;
};

/// Patches of a 2-manifold that keep within `tolerance` of their planes (the mesh's units, > 0), but for
/// facets at their margins. First flat ground, then regions, cut to strips of even width (cut_to_strips).
/// What is neither, or too small, has none. In the spirit of Cohen-Steiner, Alliez, Desbrun, Variational
/// Shape Approximation (2004), whose proxies on a cylinder are strips too, but where each is sure to go from
/// end to end. O(n log n) where facets are even, parallel in parts, the same bits for any number of threads.
PlanarPatches find_planar_patches(const PolygonMesh& mesh, double tolerance);

/// Per vertex the planes of its facets, each by its share of their area, and the vertex itself.
std::vector<Quadric> vertex_planes(const PolygonMesh& mesh);

/// Per vertex the planes of its facets: of patches those that meet near it, each once, of other facets their
/// own by their share of the area; and the vertex itself. Where patches are a facet wide a vertex may touch
/// three planes that do not meet within `tolerance`: then those farthest from it are left out. `patches` must
/// outlive the result.
std::vector<Quadric> vertex_planes(const PolygonMesh& mesh, const PlanarPatches& patches, double tolerance);
std::vector<Quadric> vertex_planes(const PolygonMesh&, PlanarPatches&&, double) = delete;

} // namespace hsdm
