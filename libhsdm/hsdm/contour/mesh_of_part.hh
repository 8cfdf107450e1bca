#pragma once
// A mesh that was made for part of a whole, and which of it is that part's own.

#include "hsdm/polygon_mesh.hh"

#include <functional>

namespace hsdm {

/// Which voxels of a level are the part's own, and which lie near those: what is made there is that of the
/// whole, too.
struct PartVoxels {
    std::function<bool(Index)> owns{};    ///< none: the level is a whole
    std::function<bool(Index)> is_near{}; ///< false for what lies farther off

    bool is_part() const { return static_cast<bool>(owns); }
};

/// A mesh that was made for part of a whole. Facets, alone or several, are the part's that owns the least
/// voxel of their vertices.
struct MeshOfPart {
    const PolygonMesh& mesh;
    std::function<Index(Index)> voxel; ///< of a vertex; ascending as in the whole
    const PartVoxels& voxels;
};

} // namespace hsdm
