#pragma once
// Planar patches of a surface: flat ground, and strips of regions that bend one way only.

#include "hsdm/simplify/quadric.hh"

namespace hsdm {

struct PlanarPatches {
    std::vector<Index> patch; ///< per facet, or no_index
    std::vector<Plane> planes;
};

/// Finds patches of a 2-manifold that keep within `tolerance` of their planes (the mesh's units, > 0), except
/// for facets at their margins: first flat ground, then developable regions, cut to strips of even width
/// (cut_to_strips). Facets of neither kind, or of patches too small, have none. In the spirit of
/// Cohen-Steiner, Alliez, Desbrun, Variational Shape Approximation (2004), whose proxies on a cylinder are
/// strips too; here each is sure to go from end to end. O(n log n) where facets are even, parallel in parts,
/// the same bits for any number of threads.
PlanarPatches find_planar_patches(const PolygonMesh& mesh, double tolerance);

/// Per vertex, a quadric of the planes of its facets, each weighted by its share of their area, and of the
/// vertex's position.
std::vector<Quadric> vertex_planes(const PolygonMesh& mesh);

/// Per vertex, a quadric of its position and the planes of its facets: the planes of patches as shared ones,
/// each once, and the planes of facets without a patch, weighted by area. A vertex on a patch one facet wide
/// may touch three planes that do not meet within `tolerance`: then those farthest from it are dropped.
/// `patches` must outlive the result.
std::vector<Quadric> vertex_planes(const PolygonMesh& mesh, const PlanarPatches& patches, double tolerance);
std::vector<Quadric> vertex_planes(const PolygonMesh&, PlanarPatches&&, double) = delete;

} // namespace hsdm
