#pragma once
// A half-edge mesh as flat arrays: what is computed on meshes of any kind is compiled once.

#include "hsdm/types.hh"

#include <vector>

namespace hsdm {

/// Whether a vertex has to stay where it is, whatever its edges say.
enum class Pin : unsigned char {
    none,
    unless_on_curve, ///< a marked vertex: stays if neither a sharp edge nor the boundary leads through it
    always,          ///< a corner by its class, or locked
};

/// Half-edges 2e and 2e + 1 are those of edge e, as OpenMesh numbers them. Deleted elements keep their
/// numbers: no half-edge leads to them.
struct HalfEdges {
    std::vector<Vec3> positions; ///< per vertex
    std::vector<Pin> pins;       ///< per vertex
    std::vector<Index> out;      ///< per vertex: a half-edge that leaves it; no_index: isolated, deleted
    std::vector<Index> to;       ///< per half-edge: its end; no_index: deleted
    std::vector<Index> next;     ///< per half-edge: the one after it round its facet or boundary
    std::vector<Index> facet;    ///< per half-edge: its facet; no_index on the boundary
    std::vector<Index> side;     ///< per facet: one of its half-edges; no_index: deleted
    std::vector<unsigned char> marked; ///< per edge: whether it is sharp

    std::size_t vertex_count() const { return positions.size(); }
    std::size_t edge_count() const { return marked.size(); }
    std::size_t facet_count() const { return side.size(); }
    Index from(Index h) const { return to[h ^ 1]; }
    bool is_open(Index e) const { return facet[2 * e] == no_index || facet[2 * e + 1] == no_index; }
    /// Whether an edge that is there is sharp or on the boundary.
    bool is_curve(Index e) const { return marked[e] || is_open(e); }

    /// Calls f(h) for the half-edges that leave a vertex, clockwise: the facet between h and the one that
    /// follows is that of h ^ 1.
    template <class F>
    void for_each_spoke(Index v, const F& f) const {
        const Index first = out[v];
        if (first == no_index) return;
        Index h = first;
        do {
            f(h);
            h = next[h ^ 1];
        } while (h != first);
    }

    /// Calls f(h) for the sides of a facet that is there, in order.
    template <class F>
    void for_each_side(Index facet_index, const F& f) const {
        const Index first = side[facet_index];
        Index h = first;
        do {
            f(h);
            h = next[h];
        } while (h != first);
    }
};

/// What a vertex is to the curves of a mesh, which are its sharp edges and its boundary.
enum class CurveRole : unsigned char {
    smooth, ///< on none
    dart,   ///< a crease ends here
    crease, ///< two edges of a curve meet
    corner, ///< more do, or the curve turns by more than `corner_angle` (radians), or the vertex is pinned
};

/// Per vertex; smooth where there is no edge. O(half-edges), parallel.
std::vector<CurveRole> curve_roles(const HalfEdges& mesh, double corner_angle);

} // namespace hsdm
