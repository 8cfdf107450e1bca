#pragma once
// Subdivision surfaces with creases, on flat arrays.

#include "hsdm/features/half_edges.hh"

#include <string_view>

namespace hsdm {

enum class SubdivisionScheme {
    automatic,     ///< Loop's where all facets are triangles, else Catmull's and Clark's
    loop,          ///< Loop 1987: triangles, each to four
    catmull_clark, ///< Catmull, Clark 1978: facets of n corners, each to n quads
};

struct SubdivisionOptions {
    SubdivisionScheme scheme = SubdivisionScheme::automatic;
    int rounds = 1; ///< 0 to 10; each makes about four facets of one
    /// Radians, in (0, pi): a vertex where two edges of a crease or of the boundary meet is a corner, and
    /// stays, if the line they form turns by more. 60 degrees.
    double corner_angle = 1.05;
};

struct SubdivisionCounts {
    SubdivisionScheme scheme = SubdivisionScheme::automatic; ///< the one that was taken
    std::size_t facets_before = 0, facets_after = 0;
    std::size_t vertices = 0;    ///< after
    std::size_t sharp_edges = 0; ///< after
    std::size_t corners = 0;     ///< vertices of the mesh given that had to stay
    bool operator==(const SubdivisionCounts&) const = default;
};

/// Throws OptionError naming the option, its value and its range.
void validate(const SubdivisionOptions& options);

/// `loop` or `catmull-clark`; `auto`.
std::string_view name_of(SubdivisionScheme scheme);

/// The scheme that a mesh is to be divided by. Throws OptionError where Loop's meets a facet that is no
/// triangle.
SubdivisionScheme scheme_for(const HalfEdges& mesh, SubdivisionScheme asked);

/// Throws OptionError if so many rounds made more half-edges than OpenMesh can number. O(half-edges).
void check_numbers(const HalfEdges& mesh, int rounds);

/// A mesh after one round.
struct Refinement {
    HalfEdges mesh;
    std::vector<Index> parent; ///< per facet: the one that it is a part of
};

/// One round. With V vertices, E edges and F facets before: vertex v keeps its number, V + e is the point of
/// edge e, V + E + f the one of facet f (Catmull-Clark); edge e becomes e, from the end of half-edge 2e + 1,
/// and E + e; half-edges run as the one that they are a part of; facet f keeps its number for one part.
///
/// Weights by the roles of vertices: Hoppe et al. 1994 (Loop with creases), DeRose, Kass, Truong 1998
/// (Catmull-Clark). A dart moves as a smooth vertex; curves are uniform cubic B-splines that nothing beside
/// them moves, corners stay. Departs from Hoppe's table of edges, where the valences beside a crease shift
/// its points: a boundary then would not depend on itself alone (Biermann, Levin, Zorin 2000). Differences
/// are weighted, not places: what is flat along an axis stays so to the last bit.
///
/// The mesh must have no deleted elements. O(half-edges), parallel; the same bits for any number of threads.
Refinement refined(const HalfEdges& mesh, const std::vector<CurveRole>& roles, SubdivisionScheme scheme);

} // namespace hsdm
