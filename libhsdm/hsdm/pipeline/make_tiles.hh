#pragma once
// All tiles of a cloud on disk, each with as much around it as it takes for neighbours to agree.

#include "hsdm/pipeline/cloud_survey.hh"
#include "hsdm/pipeline/kept_passes.hh"
#include "hsdm/pipeline/piece_store.hh"
#include "hsdm/pipeline/tile_piece.hh"

#include <optional>

namespace hsdm {

/// What tiles are made of.
struct TilesInput {
    ScratchCloud& cloud; ///< points are left out of it if some are found to be outliers
    CloudSurvey& survey; ///< is taken again then
    const ReconstructOptions& options;
    const Phases& phases;
    std::size_t group_points = 0;        ///< at once, for a survey
    int ghost_voxels = 0;                ///< round a tile at first
    PieceStore* store = nullptr;         ///< finished pieces are put there; null: they stay in memory
    KeptPasses* kept = nullptr;          ///< where there is a store: keeps them, and has some of them
    std::function<void()> on_outliers{}; ///< called once they have been looked for
    CompletedRound completed = CompletedRound::none; ///< as in PartOfLevel
    std::uint64_t added = 0; ///< tells clouds apart by the points that were added to them
};

/// What making tiles finds out of the whole, so that tiles must be made again; it holds for those made
/// later, too.
struct TilesKnown {
    bool has_layers = false;               ///< did points take the sides of layers of one surface?
    std::optional<Occurrences> outliers{}; ///< once they have been looked for; in the cloud's coordinates
    bool go_back = false;                  ///< as in PartOfLevel
    TanglePlan tangles{};                  ///< as in PartOfLevel
    LargestOfWhole largest{SplinterOptions().enough(), SplinterOptions().enough()}; ///< the same
};

/// The piece of every range that is this rank's, all of all ranks in agreement; none of the others. No range
/// may be of two ranks. `turned`: as in PartOfLevel. Nothing if outliers are left out without which the cloud
/// lies in another cube: its cells are others then. Throws Error if they cannot agree, or if what they leave
/// to the whole would change them; Cancelled.
std::optional<std::vector<Piece>> make_tiles(const TilesInput& in, const std::vector<VoxelRange>& ranges,
                                             bool turned, TilesKnown& known, TileReport& how);

} // namespace hsdm
