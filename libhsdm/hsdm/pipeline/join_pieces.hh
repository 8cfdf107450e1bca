#pragma once
// Pieces -> one mesh.

#include "hsdm/pipeline/piece_store.hh"
#include "hsdm/polygon_mesh.hh"

namespace hsdm {

/// Pieces that cover a level, in Morton order, as one mesh with the hints of its sides. All must agree. Takes
/// their memory, or reads them one at a time from the store that they were put into. Throws Error if a
/// foreign vertex is not where its own tile has it.
PolygonMesh joined_pieces(std::vector<Piece>&& pieces, std::vector<EdgeHint>& sides,
                          const PieceStore* store = nullptr);

/// Throws Error for a mesh of more vertices, or corners of facets, than indices tell apart.
void check_mesh_size(std::size_t vertices, std::size_t corners);

} // namespace hsdm
