#pragma once
// Vertices that hold nothing open: only two facets of the coarse mesh meet there.

#include "hsdm/polygon_mesh.hh"

namespace hsdm {

/// Takes out inner vertices with only two facets: the two become one, or go altogether if they are triangles
/// back to back. Sides go in opposite pairs, so closedness, orientation and Euler characteristic of what is
/// left stay as they are; an edge that only such triangles made one of four facets becomes one of two. Left
/// alone: vertices whose two facets share more, as in a component of two facets. Returns per vertex the one
/// that stands for it now: itself, or a neighbour if it was taken out (it is isolated then). O(facets) in
/// each of a few rounds.
std::vector<Index> dissolve_doublets(PolygonMesh& mesh);

/// The values of the vertices that are kept.
template <class T>
std::vector<T> picked(const std::vector<T>& values, const std::vector<Index>& kept) {
    std::vector<T> result;
    result.reserve(kept.size());
    for (Index v : kept) result.push_back(values[v]);
    return result;
}

/// Renumbers vertices away for which others stand; `stands_for` has the new numbers afterwards. Returns per
/// vertex that is left its old number.
std::vector<Index> drop_replaced(PolygonMesh& mesh, std::vector<Index>& stands_for);

} // namespace hsdm
