#pragma once
// Drops crossings that, given what they are joined to, lie beyond the end of the surface.

#include "hsdm/contour/crossing_pairs.hh"

namespace hsdm {

/// Drops the crossings beyond the end of the data: patches of unsupported crossings that a border touches. A
/// boundary loop of up to 16 sides is a defect rather than a border if it has at most 20 without the patches
/// beside it; there a patch is dropped only if that shortens the boundary. A closed surface loses none.
/// With `all_round` the data are known to go round the whole solid: every loop is a defect then. Returns the
/// number of crossings dropped; if it is not 0 the crossings must be paired again. O(crossings).
std::size_t trim_unsupported(Crossings& crossings, const Links& links, bool all_round = false);

/// Drops the two crossings of an edge through which only the tip of a corner or the end of a crease pokes:
/// two that are joined to each other on three or four sides and are not the two sides of a thin part. Their
/// facets would lie back to back, between vertices of which two have no other facet. Returns the number of
/// pairs; if it is not 0 the crossings must be paired again. O(crossings).
std::size_t drop_tips(const NormalSets& sets, const RelationTest& related, const Links& links,
                      Crossings& crossings);

} // namespace hsdm
