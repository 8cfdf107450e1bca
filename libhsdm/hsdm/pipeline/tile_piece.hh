#pragma once
// The facets of one tile: a range of a level's voxels, of which all within some voxels is known.

#include "hsdm/mesh/feature_hints.hh"
#include "hsdm/pipeline/attribute_rows.hh"
#include "hsdm/pipeline/extended_method.hh"
#include "hsdm/pipeline/voxel_range.hh"

#include <span>

namespace hsdm {

/// What a tile has of its own: the vertices that stand for its voxels, and the facets whose least vertex is
/// one.
struct Piece {
    VoxelRange range;
    std::vector<Vec3> positions;   ///< of its vertices, relative to the cube
    std::vector<MortonCode> codes; ///< of their voxels, ascending
    std::vector<char> attributes;  ///< their AttributeRows
    std::vector<Index> first{0};   ///< of its facets, as in PolygonMesh
    std::vector<Index> corners;    ///< its vertices, and after these the foreign ones
    std::vector<EdgeHint> sides;   ///< per side of a facet, or none

    /// A vertex of another tile: so many others of its voxel come before.
    struct Foreign {
        MortonCode code;
        Index rank;
        Vec3 position;
    };
    std::vector<Foreign> foreign;

    /// A voxel and a hash of all its vertices and the facets that these are the least ones of.
    struct Digest {
        MortonCode code;
        std::uint64_t hash;
        friend bool operator==(const Digest&, const Digest&) = default;
    };
    std::vector<Digest> border; ///< its voxels that others see, ascending
    std::vector<Digest> beyond; ///< voxels of others that it sees, ascending

    FacetCounts counts;                       ///< of its facets
    std::array<PartComponents, 2> components; ///< as in DualContour
};

/// How far beyond a tile its neighbours' results are compared with its own, in voxels.
inline constexpr int compared_voxels = 2;

/// Reconstructs a tile. `in`: the points of the range and of all voxels within the ghost layer of it, and the
/// attributes of its own, which are of these columns.
Piece make_piece(const MethodInput& in, const PartOfLevel& part, const VoxelRange& range,
                 const AttributeRows& attributes);

} // namespace hsdm
