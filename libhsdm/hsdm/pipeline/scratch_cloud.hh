#pragma once
// A whole cloud on disk, sorted by cells of its octree, and the parts of it that are looked at one at a time.

#include "hsdm/cloud/cloud_frame.hh"
#include "hsdm/io/scratch_points.hh"
#include "hsdm/octree/octree.hh"
#include "hsdm/pipeline/cloud_extent.hh"
#include "hsdm/pipeline/reconstruct_in_tiles.hh"
#include "hsdm/pipeline/voxel_range.hh"

#include <algorithm>
#include <memory>

namespace hsdm {

struct CompletedPoints;
class KeptScratch;
class PointExchange;

/// The finite points of a cloud, on disk but for those left out. Each rank has those of a range of cells, in
/// Morton order, and about as many as each other; what it is asked for of other cells it fetches from theirs.
class ScratchCloud {
public:
    /// One more pass over the points. `memory` and `scratch` of the options. Throws Error as ScratchPoints,
    /// and if there are other points than were measured.
    /// `use_normals`: false: it has none until they are made, whether the points have or not.
    ScratchCloud(const PointParts& parts, const CloudExtent& extent, int depth, const TileOptions& options,
                 Ranks& ranks, bool use_normals = true);
    /// What put_state() of a cloud of these options has told.
    ScratchCloud(ByteReader& bytes, const TileOptions& options, Ranks& ranks);
    /// All but the points, which stay in the file.
    void put_state(Ranks::Bytes& bytes) const;
    const std::string& file_name() const { return place_.name; } ///< empty: it has none
    void flush_to_disk() const { scratch_->flush_to_disk(); }
    /// The file is of a pass that is kept: it stays when the points go to another one.
    void note_kept() { is_of_pass_ = true; }
    const std::string& scratch_folder() const { return place_.folder; }
    std::size_t version() const { return version_; } ///< another one each time that points change

    const CloudExtent& extent() const { return extent_; } ///< as it was measured
    bool has_normals() const { return has_normals_; }
    const Box& bounds() const { return none_.bounds; }
    const CloudFrame& frame() const { return frame_; }
    Ranks& ranks() const { return ranks_; }
    const std::vector<ScratchPoints::Cell>& cells() const { return cells_; } ///< of all ranks
    int owner(MortonCode cell) const;                                        ///< its rank
    /// What lies beside its points: none if it does not take those of the cloud along.
    const AttributeRows& attributes() const { return attributes_; }
    /// Replaces `rows` by those of a cell's points.
    void read_attributes(MortonCode cell, std::vector<char>& rows) const {
        scratch_->read_beside(cell, rows);
    }
    /// The cell with the point of a number: those on disk are numbered cell by cell, those left out too.
    struct NumberedCell {
        MortonCode code;
        std::size_t first, points; ///< number of its first point, and how many it has
    };
    NumberedCell cell_with(Index number) const;
    int owner_of(const VoxelRange& range) const { return owner(cells_of(range).begin); }
    /// Where ranks begin that have cells, but for the first of them; ascending.
    std::vector<MortonCode> borders() const;
    /// Of ranks before this one, those left out too, and duplicates until they are sorted.
    std::size_t points_before() const;
    std::size_t points_here() const; ///< the same of this rank
    int depth() const { return depth_; }
    int cell_depth() const { return cell_depth_; }
    double cube_extent() const { return none_.extent; }
    const Vec3& origin() const { return none_.origin; } ///< of the cube, in the cloud's coordinates
    double voxel_size() const { return none_.voxel_size(depth_); }
    std::size_t bytes() const { return scratch_->bytes(); } ///< on disk

    /// The octree of the whole without its points, and the level of all facets without its voxels.
    const Octree& no_points() const { return none_; }
    OctreeLevel no_voxels() const;

    /// A range and so many voxels around it.
    struct Surroundings {
        VoxelRange range;
        int ghost;
    };
    /// Fetches what other ranks have of these, so that octree_around() knows it. For all ranks at the same
    /// time.
    void fetch(const std::vector<Surroundings>& wanted);
    /// The points of a range of this rank and of what was fetched around it; their `source` is their number.
    Octree octree_around(const VoxelRange& range, int ghost) const;
    /// Voxels along an edge of a cell.
    int cell_side() const { return 1 << (depth_ - cell_depth_); }
    /// All points of the cells that a range has and of those within so many voxels; `missing` become the
    /// other cells, ascending.
    Octree octree_of_cells(const VoxelRange& range, int ghost, std::vector<MortonCode>& missing) const;
    /// visit(octree) of this rank's points, `most` or a cell's at a time, in Morton order.
    void for_groups(std::size_t most, const std::function<void(const Octree&)>& visit) const;
    /// The same; points that do not come in the order of octrees go to a new file in which they do, so that
    /// nothing has to sort them again. For all ranks at the same time.
    void sort_in_cells(std::size_t most, const std::function<void(const Octree&)>& visit);
    /// visit(octree, range) of those of the ranges that are this rank's, with so many voxels around each; of
    /// ranges that have points. None may be of two ranks. For all ranks at the same time.
    void for_tiles(std::span<const VoxelRange> ranges, int ghost,
                   const std::function<void(const Octree&, const VoxelRange&)>& visit);
    /// Leaves points out from now on, as the octrees have them.
    void leave_out(std::vector<PointRow> rows);
    /// As rearrange() of an octree with this box, but in voxels of this depth: all points go to a new file,
    /// `most` or a cell's at a time. For all ranks at the same time.
    void rearrange(const Box& bounds, double extent, int depth, std::size_t most);
    /// The box of the points that are not left out, relative to the cube, and in the cloud's coordinates. For
    /// all ranks at the same time.
    Box box_in_cube(std::size_t most) const;
    Box box_of_points(std::size_t most) const;
    static PointRow row_at(const Octree& octree, std::size_t point);
    /// The same points in the same cube, but in voxels of this depth, without attributes. For all ranks at
    /// the same time.
    ScratchCloud in_voxels_of(int depth, std::size_t most) const;
    /// As complete_cloud() of the whole with points between sparse ones, which lie in the same cube and have
    /// no attributes, in voxels of this depth; rows tell their kind. For all ranks at the same time.
    ScratchCloud with_points(const ScratchCloud& between, int depth, std::size_t most) const;
    /// The same with completed points, which only the first rank has, in voxels moved by `shift`.
    ScratchCloud with_points(const CompletedPoints& completed, double shift, std::size_t most) const;
    /// The same cube and ranks without points: each rank gives those of its own cells, of a cell in the order
    /// of octrees, by add() and finish_sorted(), or any by fill(). `carries`: with their attributes. For all
    /// ranks at the same time.
    ScratchCloud emptied(bool has_normals, bool carries) const;
    /// The same for points with normals alone that no pass keeps.
    ScratchCloud emptied_aside() const;
    /// `beside`: the point's attributes, if it carries them.
    void add(const Octree& octree, std::size_t point, const char* beside = nullptr);
    void add(MortonCode code, const PointRow& row, const char* beside); ///< the same; `code`: of level 21
    void finish_sorted();
    /// work(put_row) calls put_row(row, beside) for points relative to the cube, each of which goes to the
    /// rank that has its cell.
    using PutRow = std::function<void(const PointRow& row, const char* beside)>;
    void fill(const std::function<void(const PutRow& put_row)>& work);
    /// Has the points of that one from now on.
    void take(ScratchCloud&& next);

private:
    struct Cube {
        Box bounds;
        Vec3 origin;
        double extent;
        int depth;
    };
    Cube cube() const { return {none_.bounds, none_.origin, none_.extent, depth_}; }
    /// Without points yet: those of another one, in another cube. `kept`: null: its file has no name.
    ScratchCloud(const ScratchCloud& before, const Cube& cube, const AttributeRows& attributes,
                 KeptScratch* kept);
    /// This one and what add_points(next, put_row) puts into the larger one, which has this box.
    using AddPoints = std::function<void(const ScratchCloud& next, const PutRow& put_row)>;
    ScratchCloud with_points(const Box& added, int depth, double shift, std::size_t most,
                             const AddPoints& add_points) const;
    void move_points(const ScratchCloud& from, PointKind kind, std::size_t most, const PutRow& put_row) const;
    PointRow row_of(const Vec3& position, const Vec3& normal, const Vec3& from) const;
    std::vector<char> row_of_added(PointKind kind) const;
    /// The cell of a position relative to the cube.
    MortonCode cell_of(const Vec3& relative) const;
    template <class Place>
    std::vector<Index> cells_of(std::size_t count, const Place& place) const;
    Vec3 relative_place(const PointRow& row) const;
    /// What an octree is to have of a cell: all of its points, or these.
    struct CellRows {
        MortonCode cell;
        bool is_whole;
        std::vector<PointRow> rows{};
        std::vector<Index> places{};       // of these in the cell
        std::size_t first = 0, number = 0; // of its first point: place, as far as cells come in order
        Index number_of(std::size_t row) const {
            return static_cast<Index>(number + (is_whole ? row : places[row]));
        }
    };
    void number_points(const std::vector<CellRows>& parts, Octree& octree) const;
    Octree first_octree(const std::vector<CellRows>& parts, std::size_t points) const;
    Octree arranged_octree(const std::vector<CellRows>& parts, std::size_t points) const;
    Octree octree_of(std::vector<CellRows> parts) const;
    std::size_t place_of(MortonCode cell) const {
        return static_cast<std::size_t>(std::ranges::lower_bound(cells_, cell, {}, &ScratchPoints::Cell::code)
                                        - cells_.begin());
    }
    void read_near(const VoxelRange& range, int ghost, CellRows& part) const;
    /// By one of so many of this rank's points.
    void divide(std::span<const Vec3> sample, std::size_t stride);
    void divide(const ScratchCloud& before, const Vec3& shift, std::size_t most);
    void put_row(const PointRow& row, const char* beside, MortonCode cell, PointExchange& exchange);
    static PointExchange exchange_into(ScratchCloud& next);
    void sort_points(const PointParts& parts);
    void gather_cells();
    void count_cells();
    int cells_within(int ghost) const;
    VoxelRange cells_of(const VoxelRange& range) const;
    std::vector<MortonCode> missing_cells(const std::vector<Surroundings>& wanted) const;

    CloudExtent extent_;
    CloudFrame frame_;
    AttributeRows attributes_;
    OctreeOptions options_;
    Octree none_;
    int depth_, cell_depth_;
    std::size_t most_waiting_; // points
    KeptScratch* kept_;        // null: files have no names
    ScratchPlace place_;       // of this one's file
    bool is_of_pass_ = false;  // that file
    std::size_t buffered_;     // bytes
    Ranks& ranks_;
    std::unique_ptr<ScratchPoints> scratch_;
    bool has_normals_ = true;
    bool arranged_ = false;          // rows are those of octrees, not as the points came
    bool in_order_ = false;          // and those of a cell come in the order of octrees
    std::vector<MortonCode> begins_; // of the ranks' cells
    std::vector<ScratchPoints::Cell> cells_;
    std::vector<Index> first_of_cell_; // numbers of their first points
    std::vector<MortonCode> fetched_;  // cells of others, ascending
    std::vector<PointRow> left_out_;
    std::size_t version_ = 0;
};

} // namespace hsdm
