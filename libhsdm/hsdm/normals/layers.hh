#pragma once
// Sheets near each other: sides of a wall, or layers of one surface, as scans show that do not register.

#include "hsdm/normals/patches.hh"

namespace hsdm {

/// Signs as they are if sheets beside each other are layers of one surface.
struct LayerReading {
    std::vector<SignedEdge> edges;           ///< layer_evidence
    std::vector<std::int8_t> sky, clear_sky; ///< per patch, as of OutsideView
    Signs signs;                             ///< by the evidence alone, of the patches and maybe more nodes
    Signs skyward;                           ///< by that and the clear sky
};

/// Which way out is, by the sky.
struct SkyReading {
    std::size_t points = 0;           ///< that took the layers' signs
    std::vector<std::int8_t> outward; ///< per component of the signs, +1 if they point to the sky, -1 if
                                      ///< away; 0: that is unknown, or nothing of it was turned
};

/// Where signs that were read as those of walls differ from those read as layers, the sky decides. A wall has
/// open space on both sides or on neither: read as layers it has one of them turned away from the sky. Layers
/// have it in front of the outermost alone, and of two that cross now the one is outermost, now the other:
/// read as a wall one of them is turned away from the sky. Whether a component is of layers is asked of the
/// signs that know nothing of the sky; if so, those that do are taken, unless they turn more than half as
/// many points again. Regions of patches that differ are turned as a whole where that is clear. Without a
/// clear view they stay, unless most points in question of their component are turned and, of what they see
/// of the sky, clear or not, they do not turn away from three of four. `walls`: signs of the patches and
/// maybe more nodes, turned in place. O(edges).
SkyReading take_layers(const Patches& patches, const LayerReading& layers, Signs& walls);

} // namespace hsdm
