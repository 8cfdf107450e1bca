#pragma once
// Splits polygons into well-shaped triangles and quads over their own vertices: to close holes, and for
// minimal loops of five edges and more.

#include "hsdm/mesh/constants.hh"
#include "hsdm/mesh/edge_set.hh"

namespace hsdm {

struct SplitPolygonOptions {
    /// greatest bend of an edge inside or on the polygon, in radians, (0, pi]
    double max_bend = quad_splitting::most_bend;
    bool quads = true; ///< join triangles to quads where these come out convex
};

/// The pieces of a polygon, as facets.
using Pieces = std::vector<std::vector<Index>>;

/// Splits a polygon over the mesh's vertices so that edges are short and bends small: exactly, by dynamic
/// programming, up to 128 corners; larger ones lose their best ears first. `side_normals` holds per side
/// (from corner i to i + 1) the unit normal of the facet beyond it, (0, 0, 0) if there is none. No diagonal
/// is one of `edges`. Empty if every way to split it bends too much, is flat or needs such an edge. O(corners
/// ^ 3) up to 128 corners.
Pieces split_polygon(const PolygonMesh& mesh, std::span<const Index> polygon,
                     std::span<const Vec3> side_normals, const EdgeSet& edges,
                     const SplitPolygonOptions& options = {});

/// Splits every facet of more than four corners into quads and triangles; a facet that cannot be split stays.
/// A 2-manifold remains one. Returns how many were split. O(facets), parallel.
std::size_t split_large_facets(PolygonMesh& mesh);

} // namespace hsdm
