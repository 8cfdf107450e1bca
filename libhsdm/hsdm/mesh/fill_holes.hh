#pragma once
// Hole elimination (sections 3.2.2 and 3.4.2): short boundary loops are closed by facets over their own
// vertices.

#include "hsdm/mesh/constants.hh"
#include "hsdm/mesh/facet_links.hh"

#include <functional>

namespace hsdm {

struct FillHolesOptions {
    int max_edges = 8;              ///< longer loops stay open, >= 3; no_limit closes loops of any length
    double max_diameter = Box::inf; ///< loops whose box has a longer diagonal stay open, in the mesh's units
    /// Greatest bend between a new facet and its neighbours, in radians, (0, pi]; a loop that cannot be
    /// closed with less is left open. pi is a facet folded back onto its neighbour.
    double max_bend = quad_splitting::most_bend;
    bool quads = true; ///< join triangles to quads where these come out convex
    /// Also closes loops that cannot be closed otherwise, by a vertex at the middle and triangles around it,
    /// whatever their shape. Only loops of two edges stay open.
    bool insist = false;
    /// Of loops within the limits, those that stay open all the same; none if it is empty.
    std::function<bool(std::span<const Index> loop)> stays_open{};

    static constexpr int no_limit = std::numeric_limits<int>::max();
};

/// Throws OptionError naming the option, its value and its range.
void validate(const FillHolesOptions& options);

struct FillHolesCounts {
    std::size_t loops = 0;  ///< boundary loops before
    std::size_t closed = 0; ///< of these, closed
    /// within the limits, but impossible to close without folding or using an edge twice
    std::size_t refused = 0;
    std::size_t facets = 0;   ///< added, at the end of the mesh
    std::size_t vertices = 0; ///< added, at the end of the mesh: middles of loops
};

/// Boundary loops as flat arrays: the vertices of loop i are vertices[begin[i]] .. vertices[begin[i + 1]],
/// in the direction in which a facet that closes the loop runs. No loop visits a vertex twice.
struct BoundaryLoops {
    std::vector<Index> vertices;
    std::vector<Index> facets; ///< beside each vertex, the facet at the side from it to the next one
    std::vector<Index> begin{0};

    std::size_t size() const { return begin.size() - 1; }
    std::span<const Index> operator[](std::size_t i) const {
        return {vertices.data() + begin[i], vertices.data() + begin[i + 1]};
    }
};

/// The length of a closed row of vertices.
inline double length_of(const PolygonMesh& mesh, std::span<const Index> loop) {
    double length = 0;
    for (std::size_t i = 0; i < loop.size(); ++i)
        length += (mesh.positions[loop[(i + 1) % loop.size()]] - mesh.positions[loop[i]]).norm();
    return length;
}

/// The diagonal of its box.
double diameter_of(const PolygonMesh& mesh, std::span<const Index> loop);

/// visit(position) along the sides of loops, at their ends and no farther apart than `step`.
template <class Visit>
void for_each_sample(const PolygonMesh& mesh, const BoundaryLoops& loops, double step, const Visit& visit) {
    for (std::size_t l = 0; l < loops.size(); ++l)
        for (std::size_t i = 0; i < loops[l].size(); ++i) {
            const Vec3 &p = mesh.positions[loops[l][i]],
                       &q = mesh.positions[loops[l][(i + 1) % loops[l].size()]];
            const double steps = std::max(1.0, std::ceil((q - p).norm() / step));
            for (double s = 0; s <= steps; ++s) visit(p + (q - p) * (s / steps));
        }
}

/// The boundary loops of a mesh of which no two facets run along an edge the same way. At a vertex with
/// several fans each loop stays in the gap between two fans that are next to each other, so that closing the
/// loops joins the fans; fans that face different ways keep their gaps to themselves. O(facets).
BoundaryLoops boundary_loops(const PolygonMesh& mesh);
/// The same by the mesh's links.
BoundaryLoops boundary_loops(const PolygonMesh& mesh, const FacetLinks& links);

/// Closes boundary loops, without adding vertices unless `insist` is set. Each loop is triangulated so that
/// edges are short and bends small (exactly, by dynamic programming, up to 128 edges; longer loops lose their
/// best ears first), then triangles are joined to quads. No two facets of the mesh may run along an edge the
/// same way, and none will: no existing edge is used again, no facet lies over the vertices of another. If
/// called before make_manifold it mends vertices with several fans where it can; make_manifold splits the
/// rest. O(facets + sum of loop length ^ 3, for lengths up to 128).
FillHolesCounts fill_holes(PolygonMesh& mesh, const FillHolesOptions& options = {});
/// The same by the mesh's links, which are those of the mesh before.
FillHolesCounts fill_holes(PolygonMesh& mesh, const FacetLinks& links, const FillHolesOptions& options);

} // namespace hsdm
