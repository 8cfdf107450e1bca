#pragma once
// What kind of surface a polygon mesh is, found from its facets alone.

#include "hsdm/mesh/facet_links.hh"

#include <span>

namespace hsdm {

/// Counts of a polygon mesh. Those of edges, components, boundary, manifoldness and euler leave out corners
/// that repeat the one before them, and facets that have fewer than three corners without those.
struct Topology {
    std::size_t vertices = 0;             ///< used by a facet
    std::size_t isolated_vertices = 0;    ///< used by none
    std::size_t edges = 0,                ///< each counted once
        faces = 0;                        ///< facets
    std::size_t triangles = 0,            ///< facets of three corners
        quads = 0,                        ///< facets of four corners
        larger = 0;                       ///< facets of five or more corners
    std::size_t components = 0;           ///< facets connected across edges
    std::size_t boundary_edges = 0,       ///< with one facet
        boundary_loops = 0;               ///< closed rows of boundary edges
    std::size_t nonmanifold_edges = 0;    ///< with three or more facets
    std::size_t nonmanifold_vertices = 0; ///< whose facets form more than one fan
    std::size_t misoriented_edges = 0;    ///< whose two facets run along it the same way
    std::size_t degenerate_facets = 0; ///< fewer than three different vertices, a repeated index, or no area
    std::size_t duplicate_facets = 0;  ///< over the same vertices as an earlier one
    long euler = 0;                    ///< V - E + F
    double signed_volume = 0;          ///< positive if closed and outward

    /// Whether no edge has three or more facets and each vertex has one fan.
    bool manifold() const { return nonmanifold_edges == 0 && nonmanifold_vertices == 0; }
    /// Whether there is a facet and no boundary.
    bool closed() const { return faces > 0 && boundary_edges == 0; }
    /// Sum over components of the closed surface each becomes when its boundary loops are capped.
    long genus() const {
        return static_cast<long>(components) - (euler + static_cast<long>(boundary_loops)) / 2;
    }
};

/// O(facets), flat arrays and one sort.
Topology measure_topology(const PolygonMesh& mesh);
/// All of it but degenerate_facets, duplicate_facets and signed_volume, which are left 0.
Topology measure_connectivity(const PolygonMesh& mesh);
/// The same of facets of which none was rejected, by their links: 5 bytes a corner instead of 30.
Topology measure_connectivity(const PolygonMesh& mesh, const FacetLinks& links);

/// Volume enclosed by a closed mesh, negative if its facets face inwards; of an open one that of the cone
/// over it from the centre of its box. O(facets), parallel; the same bits for any number of threads.
double signed_volume(const PolygonMesh& mesh);

/// Whether a polygon, by its corners, counts as degenerate: the triangles of its fan have less than 10^-12 of
/// the square of its longest side together. The same for any scale, however small or large.
bool has_no_area(std::span<const Vec3> ring);

/// Shape of the facets (0 worst, 1 a square).
struct FacetShape {
    double quad_share = 0; ///< quads / facets
    double scaled_jacobian_median =
        0; ///< of quads: the least over its corners of |e1 x e2| / (|e1| |e2|), signed
    double scaled_jacobian_min = 0; ///< the least of any quad
    double edge_length_mean = 0;    ///< over the sides of all facets, in the mesh's units
};
/// Measures the facets of a mesh; all but the edge length is 0 where there are no quads. O(corners).
FacetShape measure_shape(const PolygonMesh& mesh);

} // namespace hsdm
