#pragma once
// Normals of sheets that are rounder than planes can follow: bores, rods and fillets of few spacings.

#include "hsdm/normals/estimate_normals.hh"

namespace hsdm {

/// Turns the normals of bent points, which have their sides, where an arc through point and neighbour
/// explains clearly more neighbours than any plane does. On a circular arc (n_i + n_j) . d is 0 for the chord
/// d, whatever its radius, on a cylinder for any two points. So each point takes, of its normal and those
/// that arcs carry over from its neighbours, the one by which most neighbours lie on arcs with it, and goes
/// half of the way to what they say by least squares; all at once, from the old ones, until none turns. A
/// point keeps its normal if most of the neighbours that its arcs explain are on none themselves: a face's,
/// bent up to a point beyond its end. Clouds whose normals are averaged for noise stay as they are: their
/// tolerance would take creases for arcs. O(n), parallel.
void bend_to_arcs(const Octree& octree, const Neighbors& neighbors, EstimatedNormals& estimate);

} // namespace hsdm
