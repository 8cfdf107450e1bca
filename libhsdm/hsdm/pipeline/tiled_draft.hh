#pragma once
// Facets of a cloud on disk, with points added to it where it takes them, as extended_method() makes them.

#include "hsdm/io/scratch_bytes.hh"
#include "hsdm/pipeline/cloud_noise.hh"
#include "hsdm/pipeline/make_tiles.hh"
#include "hsdm/pipeline/whole_of_tiles.hh"

#include <functional>
#include <memory>
#include <optional>

namespace hsdm {

/// A cloud and what comes of it.
struct TiledDraft {
    std::unique_ptr<ScratchCloud> cloud{};           ///< null: the measured points alone
    std::optional<CloudSurvey> survey{};             ///< of that cloud
    TilesKnown known{};                              ///< likewise
    CompletedRound completed = CompletedRound::none; ///< likewise
    std::uint64_t added = 0;                         ///< as in TilesInput
    WholeFacets facets{};                            ///< of the first rank
    bool has_new_cavities = false;                   ///< as extended_method() has it; likewise
};

struct DraftsInput {
    ScratchCloud& cloud; ///< the measured points
    CloudSurvey& survey;
    const TilesKnown& known;
    const ReconstructOptions& options;
    const Phases& phases;
    CloudPasses passes;
    ScratchPlace parking;   ///< where facets wait while others are tried
    std::size_t memory = 0; ///< bytes left for what is not of tiles
    int levels = 0;         ///< coarser ones that help out where points are sparse
    /// Makes the facets of a draft in tiles; `turned`: as in PartOfLevel.
    std::function<void(TiledDraft& draft, bool turned)> make{};
};

/// The last draft, relative to the cube of the measured points. Of these and no others the report tells. For
/// all ranks at the same time.
WholeFacets facets_of_drafts(const DraftsInput& in, Report& report);

} // namespace hsdm
