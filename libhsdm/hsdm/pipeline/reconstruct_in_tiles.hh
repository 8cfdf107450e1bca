#pragma once
// A reconstruction in bounded memory: the points lie sorted on disk and are worked through tile by tile. The
// mesh is that of the run in one piece, bit for bit (docs/tiles.md).

#include "hsdm/errors.hh"
#include "hsdm/features/facet_features.hh"
#include "hsdm/io/write_mesh.hh"
#include "hsdm/pipeline/attribute_rows.hh"
#include "hsdm/point_view.hh"
#include "hsdm/reconstruct.hh"

namespace hsdm {

class KeptScratch;
class Ranks;

/// Of a cloud that is not reconstructed in tiles whatever the memory, but can be in one piece.
class RefusedInTiles : public Error {
public:
    using Error::Error;
};

struct TileOptions {
    static constexpr std::size_t no_bound = std::size_t{1} << 60;
    /// Bytes that the process is to use at most, those it uses already included.
    std::size_t memory = 0;
    std::string scratch{};       ///< folder for the points on disk; empty: that for temporary files
    int ghost_voxels = 16;       ///< voxels round a tile that its points are known of, >= 4
    std::size_t most_points = 0; ///< of a tile and what is round it; 0: as the memory allows
    /// Where each pass stays once it is done, for a run after one that has ended before its time; the same
    /// cloud and options must have made what is there. Null: nothing stays. Not removed by the run.
    KeptScratch* kept = nullptr;
};

/// Calls visit(part) for parts of a cloud, in the order of its points; the same each time it is called.
using PointParts = std::function<void(const std::function<void(const PointView&)>& visit)>;

/// How it was done.
struct TileReport {
    std::size_t tiles = 0, widened = 0; ///< and those made again with more around them
    std::size_t own_tiles = 0;          ///< of all, this rank's
    std::size_t points_read = 0;        ///< by this rank's tiles, what is round them too
    bool parks = false;                 ///< arrays of the mesh waited on scratch while nothing read them
    bool went_on = false;               ///< with passes that were kept
    std::size_t kept_tiles = 0;         ///< of own_tiles, those that were in the end
    std::vector<Report::Rank> ranks{};  ///< what each did
};

/// Throws OptionError for options that no cloud can be reconstructed with in tiles.
void check_options(const ReconstructOptions& options, const TileOptions& tiles);

/// Is a cloud of so many points certain to be done in one piece within the memory? Then nothing is gained by
/// tiles.
bool fits_in_one_piece(std::size_t points, const ReconstructOptions& options, std::size_t memory);

/// As reconstruct() of the whole cloud, but that the report's `rejected` tells of the whole mesh alone.
/// Throws RefusedInTiles for a cloud of which not all that is needed is local, Error also if the memory does
/// not suffice; OptionError, Cancelled.
Reconstruction reconstruct_in_tiles(const PointParts& parts, const ReconstructOptions& options,
                                    const TileOptions& tiles, TileReport* how = nullptr);
/// The same by several ranks, all at the same time; `parts` are those of this rank's part of the points, in
/// any division. The first rank gets what one alone would, the others a mesh without facets.
Reconstruction reconstruct_in_tiles(const PointParts& parts, const ReconstructOptions& options,
                                    const TileOptions& tiles, Ranks& ranks, TileReport* how = nullptr);
/// The same of a cloud in memory.
Reconstruction reconstruct_in_tiles(const PointView& cloud, const ReconstructOptions& options,
                                    const TileOptions& tiles, TileReport* how = nullptr);

/// A reconstruction in flat arrays, much smaller than a half-edge mesh with its properties: classes and
/// normals of vertices are made from it when they are written.
struct FlatReconstruction {
    PolygonMesh mesh; ///< one fan round each vertex
    FacetLinks links; ///< as find_facet_features() reads them
    FacetFeatures features;
    AttributeRows rows;           ///< of the cloud's colours and scalars
    std::vector<char> attributes; ///< per vertex
    int depth = 0;
    Report report;
};

/// The same of a mesh that is to be written, in a quarter of the memory a voxel.
FlatReconstruction reconstruct_flat_in_tiles(const PointParts& parts, const ReconstructOptions& options,
                                             const TileOptions& tiles, TileReport* how = nullptr);
/// The same by several ranks, as reconstruct_in_tiles().
FlatReconstruction reconstruct_flat_in_tiles(const PointParts& parts, const ReconstructOptions& options,
                                             const TileOptions& tiles, Ranks& ranks,
                                             TileReport* how = nullptr);

/// Writes what write_mesh() writes of the Reconstruction. `plain`: positions and facets only. Throws Error.
WrittenMesh write_flat(const std::string& path, const FlatReconstruction& flat, MeshFormat format, bool plain,
                       const WriteOptions& options = {});
/// The same by all ranks, each a part of it (write_mesh_by_ranks()); only the first has the reconstruction.
WrittenMesh write_flat(const std::string& path, const FlatReconstruction& flat, MeshFormat format, bool plain,
                       const WriteOptions& options, Ranks& ranks);

} // namespace hsdm
