#pragma once
// Facets without an area.

#include "hsdm/polygon_mesh.hh"

namespace hsdm {

/// Facets whose vertices lie at one place or in one line are left out when a mesh is handed over, and the
/// surface is open there. Collapses the shortest side of each before that; where collapse_edges refuses all
/// of these, sides whose ends lie at one place whatever the facets round them; else unites those in one line
/// with the facet across their longest side, if it is not on a border; else merges doublets that this left.
/// Again until nothing changes, so that doing it twice changes nothing. `origin`: what positions are relative
/// to, as different ones may be equal once it is added. Returns how many sides collapsed and facets were
/// united. O(facets) a round, parallel.
std::size_t collapse_flat_facets(const Vec3& origin, PolygonMesh& mesh);

/// Only unites them, so that vertices keep their numbers. Returns how many were united. O(facets) a round,
/// parallel.
std::size_t unite_flat_facets(const Vec3& origin, PolygonMesh& mesh);

} // namespace hsdm
