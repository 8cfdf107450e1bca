#pragma once
// The pieces of all tiles -> the mesh of the whole.

#include "hsdm/pipeline/cloud_survey.hh"
#include "hsdm/pipeline/piece_store.hh"
#include "hsdm/pipeline/tile_piece.hh"

namespace hsdm {

/// The facets of the whole, relative to the cube, and what pieces tell of them.
struct WholeFacets {
    PolygonMesh mesh;
    AttributeRows rows;           ///< of the cloud's vertices
    std::vector<char> attributes; ///< these rows
    FacetKnowledge known;
    FacetCounts counts;
};

/// Takes the memory of the pieces, or reads them from the store that they are in. They must cover the level
/// and agree.
WholeFacets join_tiles(std::vector<Piece>&& pieces, const PieceStore* store = nullptr);

/// What the whole is made of, beside its facets.
struct WholeInput {
    const ScratchCloud& cloud;
    const ScratchCloud* as_read; ///< where its points were, if they have been moved; else null
    const CloudSurvey& survey;
    const ReconstructOptions& options;
    const Phases& phases;
    std::size_t group_points = 0; ///< at once, for the error
    /// Where arrays of the mesh wait while nothing reads them; null: in memory.
    const ScratchPlace* parking = nullptr;
};

/// On all ranks but the first, each time that this one measures the error.
void assist_error(const WholeInput& in);

/// What is left once there are facets: what is unsound, the error, features. Throws Error if something
/// was taken for granted of the whole that is not so; Cancelled.
Reconstruction finish_whole(const WholeInput& in, WholeFacets&& facets, Report&& report);
/// Of these facets, what the next one has in memory at most without parking: some 165 bytes a vertex.
std::size_t bytes_of_flat_finish(const PolygonMesh& mesh);
/// The same in flat arrays; with parking at most 120 bytes a vertex are in memory at once.
FlatReconstruction finish_whole_flat(const WholeInput& in, WholeFacets&& facets, Report&& report);

} // namespace hsdm
