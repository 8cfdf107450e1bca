#pragma once
// Formats that hold floats, and meshes far from the origin, where floats are coarse.

#include "hsdm/types.hh"

#include <span>

namespace hsdm {

/// What floats may move a vertex by, of the mesh's diagonal.
inline constexpr double most_moved_by_floats = 1e-6;

/// The longest way that storing as floats moves one of the positions less `shift`, over the diagonal of their
/// box: 6e-8 at most near the origin. Infinite where a float cannot hold one. O(n).
double moved_by_floats(std::span<const Vec3> positions, const Vec3& shift = {0, 0, 0});

/// What can be taken off all positions so that they lie round the origin: a place within one diagonal of the
/// box's middle, in steps of a power of ten or, below 1, of two, which decimals and doubles both hold, so
/// that adding it again gives the positions back to a rounding of a double. Zero if the origin is as near
/// already.
Vec3 recentring_shift(std::span<const Vec3> positions);

} // namespace hsdm
