#pragma once
// Phase 1, section 3.1: the Hierarchical Space Decomposition Model (HSDM), a linear octree.

#include "hsdm/core/morton_index.hh"
#include "hsdm/core/occurrences.hh"
#include "hsdm/point_view.hh"

#include <optional>
#include <span>

namespace hsdm {

/// Where the bounding cube lies around a cloud that does not fill it.
enum class CubePlacement {
    least_corner, ///< its least corner is that of the cloud's box
    centred,      ///< its centre is that of the cloud's box: gives the voxel counts that the paper reports
};

/// The deepest level on which a surface is made: voxels of 2^-16 of the cube.
constexpr int deepest_level = 16;

struct OctreeOptions {
    bool merge_duplicates = true; ///< points equal in position and normal count once
    bool tell_duplicates = false; ///< keep who was merged, though the cloud has no colours and scalars
    bool use_normals = true;      ///< false: the octree has none, whether the cloud has or not
    bool skip_nonfinite = false;  ///< leave out points with a coordinate that is not finite
    double cube_extent = 0; ///< edge of the bounding cube, at least the cloud's longest side; 0: that side
    /// Every length of the octree, cube_extent too, is in multiples of this many of the cloud's units; a
    /// power of two, for clouds whose own numbers are extreme (CloudFrame).
    double unit = 1;
    CubePlacement placement = CubePlacement::least_corner;
    /// Least corner of the cube, in place of `placement`; the cube of `cube_extent` must hold the cloud.
    std::optional<Vec3> origin{};
    /// Box of the cloud's finite points if it is known, or that of a larger cloud that this one is part of:
    /// `bounds` and the cube are those of the whole.
    std::optional<Box> whole{};
};

/// In place of the number of a point in the cloud: a point made between sparse ones. (no_index: a completed
/// one.)
inline constexpr Index between_points = no_index - 1;
inline bool is_measured(Index source) {
    return source < between_points;
}

/// What these numbers tell.
enum class PointKind : std::uint8_t { measured, between, completed };
inline PointKind kind_of(Index source) {
    if (is_measured(source)) return PointKind::measured;
    return source == between_points ? PointKind::between : PointKind::completed;
}
/// And back; `number`: of a measured one.
inline Index source_of(PointKind kind, Index number) {
    if (kind == PointKind::measured) return number;
    return kind == PointKind::between ? between_points : no_index;
}

/// A normal as an octree has it: the unit vector, or (0, 0, 0) if it has no direction.
Vec3 normal_in_octree(const Vec3& given);

/// The cloud in Morton order inside its bounding cube (Fig. 3b). One sort serves every level, 0 to 21: the
/// voxels of a level are the runs of points whose codes agree in their first 3 * level bits.
struct Octree {
    Vec3 origin{0, 0, 0}; ///< least corner of the bounding cube; positions below are relative to it
    double extent = 0; ///< edge of the bounding cube: the cloud's longest side, not padded, unless asked for
    Box bounds;        ///< box of the cloud, as the cloud has it but for the unit
    /// Per point, level 21, ascending. May be freed once the last level is extracted, neighbours are found
    /// and voxels counted: all of these ask for them.
    std::vector<MortonCode> codes;
    std::vector<Vec3> positions; ///< per point, relative to origin
    std::vector<Vec3> normals;   ///< per point, unit or (0, 0, 0); empty if the cloud has none
    /// Per point, its index in the cloud (the first of merged duplicates); may be freed once nobody asks what
    /// else the cloud has: then all points count as measured.
    std::vector<Index> source;
    std::size_t merged_duplicates = 0;
    /// A merged point and the first one equal to it, which represents it; sorted by the latter, as indices in
    /// the cloud. None if the cloud has no colours and scalars, for which alone they matter.
    struct Duplicate {
        Index first, other;
    };
    std::vector<Duplicate> duplicates;

    std::size_t size() const { return positions.size(); }
    bool has_normals() const { return !normals.empty(); }
    /// Is a point one of the cloud, not one that was made?
    bool is_measured(Index point) const { return source.empty() || hsdm::is_measured(source[point]); }
    /// Was it made to complete the surface?
    bool is_completed(Index point) const { return !source.empty() && source[point] == no_index; }
    double voxel_size(int depth) const { return extent / static_cast<double>(1u << depth); }
};

/// Level-21 code of a position relative to a cube of this edge; what lies outside goes to its outermost
/// voxels.
MortonCode code_at(const Vec3& relative, double extent);

/// Least corner of the cube of this edge about the middle of a box whose longest side is no longer.
Vec3 centred_origin(const Box& bounds, double extent);

/// Sorts the cloud into its HSDM. O(n) time and space (radix sort of 63-bit codes), parallel; the result does
/// not depend on the order of the points, nor on the number of threads. Ties of the code are ordered by
/// position, then normal, so each voxel's points come in one canonical order; normals that are zero or not
/// finite are (0, 0, 0) from here on. Reads the arrays where they are. Throws Error if the cloud is empty,
/// holds a non-finite coordinate that is not to be skipped, all its points are equal, or its extent times
/// 2^21 over the unit is no number; OptionError if cube_extent is given but smaller than the cloud,
/// or origin but that cube does not hold the cloud.
Octree build_octree(const PointView& cloud, const OctreeOptions& options = {});
Octree build_octree(const PointCloud& cloud, const OctreeOptions& options = {});
/// The same in less memory: the cloud loses its normals, used or not, and keeps all else.
Octree build_octree_taking_normals(PointCloud& cloud, const OctreeOptions& options = {});

/// Replaces the points' positions (relative to the octree's origin, in its order; its own array may be moved
/// in) and sorts them in the Morton order of a cube of the given extent: the octree's own, or one about the
/// middle of the cloud's box. Points outside the cube go to its outermost voxels; none is merged, normals
/// stay with their points, `source` and `bounds` refer to the cloud as before. O(n), parallel.
void rearrange(Octree& octree, std::vector<Vec3> positions, double extent);

/// Removes the points that are marked, per point; the cube stays. Returns how many, and where in the
/// coordinates of `bounds`. O(n), parallel.
Occurrences remove_points(Octree& octree, std::span<const std::uint8_t> marked);

/// Can a cube as large as this box have voxels: are all coordinates finite and all edges of voxels positive
/// numbers?
bool has_voxels(const Box& bounds);

/// Does the box of the points that are left differ, beyond rounding, from the one before, and has it voxels?
bool is_other_box(const Box& left, const Box& before);

/// After points were removed: `bounds` becomes the box of those left, and they are rearranged in the cube of
/// its longest side about its middle. Leaves the octree as it is, and returns false, if the box has stayed
/// (but for rounding). O(n).
bool fit_to_points(Octree& octree);

/// The occupied voxels of one level, in Morton order. Voxel v holds points first_point[v] .. first_point[v +
/// 1].
class OctreeLevel {
public:
    int depth = 0;
    double voxel_size = 0;
    std::vector<MortonCode> codes;     ///< one per voxel, 3 * depth bits, ascending
    std::vector<Index> first_point{0}; ///< one more than voxels

    std::size_t size() const { return codes.size(); }
    VoxelCoord coord(Index voxel) const { return morton_decode(codes[voxel]); }
    /// The voxel at a coordinate, or no_index where none is occupied or the coordinate lies outside. O(1).
    Index find(const VoxelCoord& c) const;
    Index find(MortonCode code) const { return index_.find(code); }
    /// What the index knows of the 64 codes of this number, to look up several.
    const MortonIndex::Block& block_at(MortonCode number) const { return index_.block_at(number); }

    /// To be called once codes are final; find() needs it.
    void build_index() { index_.build(codes); }

private:
    MortonIndex index_;
};

/// The voxels of one level of the HSDM, depth in [0, 21]. O(n), parallel.
OctreeLevel extract_level(const Octree& octree, int depth);
/// The same from a deeper level, whose voxels alone are read. O(voxels), parallel.
OctreeLevel coarser_level(const OctreeLevel& finer, int depth);
/// `first_point` of extract_level, without the rest of the level. O(n), parallel.
std::vector<Index> first_points(const Octree& octree, int depth);

/// Offsets of the 6 face, 12 edge and 8 corner neighbours: 6-, 18- and 26-adjacency is the first 6, 18, 26.
extern const std::array<VoxelCoord, 26> neighbor_offsets;

/// The voxels round a place, given as a code of the level: blocks of the index, eight at most, are looked up
/// once.
class VoxelsAround {
public:
    VoxelsAround(const OctreeLevel& level, MortonCode code) : level_(level) {
        for (unsigned axis = 0; axis < 3; ++axis) {
            const MortonCode bits =
                morton_encode(axis == 0 ? ~0u : 0, axis == 1 ? ~0u : 0, axis == 2 ? ~0u : 0)
                & ((MortonCode{1} << 3 * level.depth) - 1);
            const MortonCode here = code & bits;
            along_[axis] = {here == 0 ? outside : morton_down(code, axis) & bits, here,
                            here == bits ? outside : morton_up(code, axis) & bits};
        }
    }
    /// The voxel at an offset of -1, 0 or 1 along each axis, or no_index.
    Index find(const VoxelCoord& offset) {
        MortonCode code = 0;
        for (std::size_t axis = 0; axis < 3; ++axis)
            code |= along_[axis][1 + static_cast<std::size_t>(offset[axis])];
        if (code >= outside) return no_index;
        const MortonCode number = code / MortonIndex::cells;
        const MortonIndex::Block*& block = blocks_[number % blocks_.size()];
        if (block == nullptr) block = &level_.block_at(number);
        return block->find(code);
    }

private:
    static constexpr MortonCode outside = MortonCode{1} << 63;

    const OctreeLevel& level_;
    std::array<std::array<MortonCode, 3>, 3> along_;    // of the code, the bits of each axis at each offset
    std::array<const MortonIndex::Block*, 8> blocks_{}; // by the last bit of each axis, in which those differ
};

/// visit(voxel) for the occupied ones of the 26 round a voxel, in the order of neighbor_offsets.
template <class Visit>
void for_neighbors(const OctreeLevel& level, Index voxel, const Visit& visit) {
    VoxelsAround around(level, level.codes[voxel]);
    for (const VoxelCoord& o : neighbor_offsets)
        if (const Index v = around.find(o); v != no_index) visit(v);
}

} // namespace hsdm
