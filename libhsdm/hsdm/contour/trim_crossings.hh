#pragma once
// Crossings taken back once it is known what they are joined to: the surface has ended there.

#include "hsdm/contour/crossing_pairs.hh"

namespace hsdm {

/// Takes back the crossings beyond the end of the data: patches of those not supported that a border reaches.
/// A boundary loop of up to 16 sides is a defect and no border if it has at most 20 without the patches
/// beside it; there a patch goes only if that makes the boundary shorter. A closed surface loses none.
/// Returns the number removed; if it is not 0 the crossings must be paired again. O(crossings).
std::size_t trim_unsupported(Crossings& crossings, const Links& links);

/// Takes back the two crossings of an edge that only the tip of a corner or the end of a crease pokes
/// through: two that are joined to each other on three or four sides and not the two sides of a thin part.
/// Their facets would lie back to back, between vertices of which two have no other facet. Returns the number
/// of pairs; if it is not 0 the crossings must be paired again. O(crossings).
std::size_t drop_tips(const NormalSets& sets, const RelationTest& related, const Links& links,
                      Crossings& crossings);

} // namespace hsdm
