#pragma once
// Pieces -> one mesh.

#include "hsdm/pipeline/piece_store.hh"
#include "hsdm/polygon_mesh.hh"

namespace hsdm {

/// What pieces are together.
struct JoinedPieces {
    PolygonMesh mesh;
    std::vector<EdgeHint> sides;  ///< hints
    std::vector<char> attributes; ///< AttributeRows of its vertices
};

/// Pieces that cover a level, in Morton order, as one. All must agree. Takes their memory, or reads them one
/// at a time from the store that they were put into. Throws Error if a foreign vertex is not where its own
/// tile has it.
JoinedPieces joined_pieces(std::vector<Piece>&& pieces, const PieceStore* store = nullptr);

/// Throws Error for a mesh of more vertices, or corners of facets, than indices tell apart.
void check_mesh_size(std::size_t vertices, std::size_t corners);

} // namespace hsdm
