#pragma once
// What is known of a whole cloud that is not in memory, by passes over its parts; the same numbers as by
// PreparedCloud.

#include "hsdm/contour/outlier_sets.hh"
#include "hsdm/core/ranks.hh"
#include "hsdm/normals/mend_normals.hh"
#include "hsdm/normals/neighbors.hh"
#include "hsdm/normals/outliers.hh"
#include "hsdm/octree/spacing.hh"

namespace hsdm {

/// Adds up parts in Morton order, each all points of some cells of level `cell_depth`; sorted and without
/// duplicates, in the octree of the whole.
class Survey {
public:
    /// `expected`: points that there are in all, if none is a duplicate; `before`: of these, how many come
    /// before the first part.
    Survey(int depth, int cell_depth, std::size_t expected, std::size_t before = 0);

    /// What put_state() has told.
    explicit Survey(ByteReader& bytes);
    void put_state(Ranks::Bytes& bytes) const;

    void add(const Octree& part);
    /// Becomes that of all ranks, each of which has added parts that come before those of the next one.
    void join(Ranks& ranks);

    /// The points that are not duplicates; unless these are as many as expected, the samples are wrong, and
    /// all has to be done again.
    std::size_t points() const { return points_; }
    std::size_t voxels() const { return counts().voxels[static_cast<std::size_t>(depth_)]; }
    VoxelCounts counts() const;
    SparseLevel sparse() const;
    SetSizes set_sizes() const { return sets_; }
    std::size_t leaves() const; ///< that neighbours are sought by, as count_leaves()
    int finest_leaves() const;  ///< as in NeighborOptions
    /// The number in the whole of a cell's first point.
    struct FirstPoint {
        MortonCode cell;
        std::size_t number;
    };
    std::vector<FirstPoint> first_points() const; ///< of cells that have some, ascending
    const NormalSample& normals() const { return normals_; }
    /// The position of one of so many points in the cloud, less that of the cube.
    const std::vector<Vec3>& places() const { return places_; }
    static std::size_t place_stride(std::size_t points); ///< as drop_far_outliers() has it

private:
    /// A cell, which is of one part alone.
    struct Cell {
        MortonCode code;
        double points;
    };
    void count_squares(const Octree& part);
    void sample(const Octree& part);
    bool is_split(MortonCode cell, MortonCode next, int level) const;
    std::size_t coarse_leaves() const;
    double squares_at(int level) const;
    void put_sums(Ranks::Bytes& bytes) const;
    void add_next(ByteReader& rank);

    int depth_, cell_depth_;
    std::size_t expected_, before_, points_ = 0;
    VoxelCounts deep_;                                    // from the cells' level on
    std::array<double, morton_levels + 1> squares_{};     // the same: whole numbers
    std::array<std::size_t, morton_levels + 1> leaves_{}; // within cells
    std::vector<Cell> cells_;                             // what is above follows from
    SetSizes sets_;
    NormalSample normals_;
    std::vector<Vec3> places_;
};

} // namespace hsdm
