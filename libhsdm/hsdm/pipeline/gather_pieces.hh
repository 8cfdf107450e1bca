#pragma once
// The pieces of all ranks, for the one that joins them.

#include "hsdm/core/ranks.hh"
#include "hsdm/pipeline/piece_store.hh"

namespace hsdm {

/// Sends the pieces of other ranks to the first, into its store; pieces[k] is of rank owner(k) before and of
/// the first one afterwards, the others have none. For all ranks at the same time.
void gather_pieces(std::vector<Piece>& pieces, PieceStore& store,
                   const std::function<int(std::size_t)>& owner, Ranks& ranks);

} // namespace hsdm
