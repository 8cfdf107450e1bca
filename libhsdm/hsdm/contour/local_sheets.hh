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

/// A smooth sheet seen from a grid point. Sums over its sets, weighted by count and nearness.
struct LocalSheet {
    double weight = 0;
    /// weight times the grid point's signed distance, positive outside; to one face at a blunt crease
    double distance = 0;
    Vec3 normal{0, 0, 0}; ///< weight times the unit normals
    /// sums over its sets, of counts and their squares: the sampling density
    double points = 0, points_squared = 0;
};

/// The say of a set about a place that lies `d` from its centroid.
inline double sheet_weight(const NormalSet& set, const Vec3& d, double voxel_size) {
    const double falloff = 1 / (sheets::nearness * sheets::nearness * voxel_size * voxel_size);
    return std::min<double>(set.count, spacings::points_per_voxel) * std::exp(-d.sqrnorm() * falloff);
}

/// Members and sheets of every grid point: those of grid point c are members[first_member[c]] ..
/// [first_member[c + 1]], alike for sheets.
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

/// Groups the sets around each grid point into connected components of the smooth relation. O(grid points),
/// parallel.
LocalSheets group_local_sheets(const GridPoints& grid, const NormalSets& sets, const RelationTest& related,
                               double voxel_size);

/// Adds the grid points that a sheet needs where it bulges out of the occupied voxels by less than the
/// sampling resolves: the far ends of the grid edges it crosses there, and the other corners of the faces
/// beside those edges. The new grid points have no members. Returns how many were added.
std::size_t extend_grid_points(GridPoints& grid, LocalSheets& sheets, const OctreeLevel& level);

} // namespace hsdm
