#pragma once
// Section 3.4.2, local sheets: at each grid point, the sets of its up to eight voxels grouped into smooth
// sheets, and one signed distance per grid point and sheet. See docs/sheets.md.

#include "hsdm/contour/set_relation.hh"

namespace hsdm {

/// The grid points at the corners of the occupied voxels of a level, in Morton order; behind them, also in
/// Morton order, those that extend_lattice added.
struct CornerLattice {
    std::vector<MortonCode> codes;
    /// Per corner, the voxel in each octant or no_index: bit k of the octant's number is set on the upper
    /// side of axis k.
    std::vector<std::array<Index, 8>> voxels;
    /// Per corner, the next corner up each axis, or no_index.
    std::vector<std::array<Index, 3>> next;

    MortonIndex index; ///< code -> corner

    std::size_t size() const { return codes.size(); }
    /// In voxels; -1 and 2^depth + 1 are the margin around the bounding cube.
    VoxelCoord coord(Index corner) const {
        const VoxelCoord c = morton_decode(codes[corner]);
        return {c[0] - 1, c[1] - 1, c[2] - 1};
    }
    static MortonCode code(const VoxelCoord& c) {
        return morton_encode(VoxelCoord{c[0] + 1, c[1] + 1, c[2] + 1});
    }
};
CornerLattice build_corner_lattice(const OctreeLevel& level);
/// Per corner, the next corner down each axis, or no_index: the inverse of `next`.
std::vector<std::array<Index, 3>> corners_below(const CornerLattice& lattice);

/// A set seen from a corner: where it lies and which of the corner's sheets it belongs to.
struct SheetMember {
    Index set;
    std::uint8_t octant;
    std::uint8_t sheet;
};

/// A smooth sheet seen from a corner. Sums over its sets, weighted by count and nearness.
struct LocalSheet {
    double weight = 0;
    double distance = 0;                   ///< weight times the corner's signed distance, positive outside
    Vec3 normal{0, 0, 0};                  ///< weight times the unit normals
    double points = 0, points_squared = 0; ///< over its sets: how dense the sampling is here
};

/// Members and sheets of every corner: those of corner c are members[first_member[c]] .. [first_member[c +
/// 1]], alike for sheets.
struct LocalSheets {
    std::vector<SheetMember> members;
    std::vector<LocalSheet> sheets;
    std::vector<Index> first_member{0};
    std::vector<Index> first_sheet{0};

    std::span<const SheetMember> members_at(Index c) const {
        return {members.data() + first_member[c], members.data() + first_member[c + 1]};
    }
    std::span<const LocalSheet> sheets_at(Index c) const {
        return {sheets.data() + first_sheet[c], sheets.data() + first_sheet[c + 1]};
    }
};

/// Groups the sets around each corner into connected components of the smooth relation. O(corners), parallel.
LocalSheets group_local_sheets(const CornerLattice& lattice, const NormalSets& sets,
                               const RelationTest& related, double voxel_size);

/// Adds the grid points that a sheet needs where it bulges, by less than the sampling shows, out of the
/// occupied voxels: the ends of the edges it crosses there and the other corners of the faces beside those
/// edges. The new corners have no members. Returns how many were added.
std::size_t extend_lattice(CornerLattice& lattice, LocalSheets& sheets, const OctreeLevel& level);

} // namespace hsdm
