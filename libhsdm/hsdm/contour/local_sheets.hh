#pragma once
// Section 3.4.2, local sheets: at each grid point, the sets of its up to eight voxels grouped into smooth
// sheets, and one signed distance per grid point and sheet. See docs/sheets.md.

#include "hsdm/contour/constants.hh"
#include "hsdm/contour/grid_points.hh"
#include "hsdm/contour/set_relation.hh"
#include "hsdm/octree/constants.hh"

#include <algorithm>
#include <cmath>

namespace hsdm {

/// A set seen from a grid point: where it lies and which of the grid point's sheets it belongs to.
struct SheetMember {
    Index set;
    std::uint8_t octant;
    std::uint8_t sheet;
};

/// The sets of a grid point's voxels.
struct SheetMembers {
    static constexpr std::size_t most = 8 * NormalSets::most_per_voxel;
    std::array<SheetMember, most> all; // the first `count`
    std::size_t count = 0;

    const SheetMember* begin() const { return all.data(); }
    const SheetMember* end() const { return all.data() + count; }
    /// Those of all voxels, by octant, as if all were of one sheet.
    void gather(const std::array<Index, 8>& voxels, const NormalSets& sets) {
        count = 0;
        for (std::uint8_t octant = 0; octant < 8; ++octant)
            if (voxels[octant] != no_index)
                for (Index s = sets.first[voxels[octant]]; s < sets.first[voxels[octant] + 1]; ++s)
                    all[count++] = {s, octant, 0};
    }
};

/// A smooth sheet seen from a grid point. Sums over its sets, weighted by count and nearness.
struct LocalSheet {
    double weight = 0;
    /// weight times the grid point's signed distance, positive outside; to one face at a blunt crease
    double distance = 0;
    Vec3 normal{0, 0, 0}; ///< weight times the unit normals
};

/// The say of a set about a place that lies `d` from its centroid.
inline double sheet_weight(const NormalSet& set, const Vec3& d, double voxel_size) {
    const double falloff = 1 / (sheets::nearness * sheets::nearness * voxel_size * voxel_size);
    return std::min<double>(set.count, spacings::points_per_voxel) * std::exp(-d.sqrnorm() * falloff);
}

/// Sheets of every grid point, and which of them its members belong to: those of grid point c are
/// sheets[first_sheet[c]] .. [first_sheet[c + 1]], alike for members.
struct LocalSheets {
    std::vector<std::uint8_t> sheet_of; ///< per member, in the order of SheetMembers
    std::vector<LocalSheet> sheets;
    std::vector<Index> first_member{0};
    std::vector<Index> first_sheet{0};

    bool has_members(Index c) const { return first_member[c] < first_member[c + 1]; }
    std::span<std::uint8_t> sheets_of_members(Index c) {
        return {sheet_of.data() + first_member[c], sheet_of.data() + first_member[c + 1]};
    }
    std::span<const std::uint8_t> sheets_of_members(Index c) const {
        return {sheet_of.data() + first_member[c], sheet_of.data() + first_member[c + 1]};
    }
    void gather(const GridPoints& grid, const NormalSets& sets, Index c, SheetMembers& members) const {
        members.gather(grid.voxels[c], sets);
        const std::uint8_t* const of = sheet_of.data() + first_member[c];
        for (std::size_t i = 0; i < members.count; ++i) members.all[i].sheet = of[i];
    }
    std::span<const LocalSheet> sheets_at(Index c) const {
        return {sheets.data() + first_sheet[c], sheets.data() + first_sheet[c + 1]};
    }
};

/// Groups the sets around each grid point into connected components of the smooth relation. O(grid points),
/// parallel.
LocalSheets group_local_sheets(const GridPoints& grid, const NormalSets& sets, const RelationTest& related,
                               double voxel_size);

/// Adds the grid points that a sheet needs where it bulges out of the occupied voxels by less than the
/// sampling resolves: the far ends of the grid edges it crosses there, and the other corners of the faces
/// beside those edges. The new grid points have no members. Returns how many were added.
std::size_t extend_grid_points(GridPoints& grid, LocalSheets& sheets, const OctreeLevel& level);

} // namespace hsdm
