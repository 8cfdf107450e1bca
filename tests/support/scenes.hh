#pragma once
// Things on a floor, which a scanner looks under and through.

#include "support/solid.hh"

namespace hsdm::support {

struct Scene {
    const char* name;
    Solid solid;   ///< one piece, about the origin
    double radius; ///< of a ball about the origin that holds it
    long euler;    ///< Euler characteristic of its surface
};

/// A table, an arch, a shelf, a mug with a handle, or a wall with windows (by the seed's remainder), on a
/// slab; with sizes and a turn by the seed.
Scene scene(std::uint64_t seed);

} // namespace hsdm::support
