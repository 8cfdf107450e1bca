#include "hsdm/pipeline/gather_pieces.hh"

#include "hsdm/core/interruption.hh"
#include "hsdm/core/large_vector.hh"

#include <utility>

namespace hsdm {
namespace {

/// What join_tiles() needs of a piece.
void put_piece(Piece&& piece, const PieceStore& store, Ranks::Bytes& bytes) {
    put(piece.range, bytes);
    put(piece.counts, bytes);
    store.take_vertices(piece);
    put_vector(std::exchange(piece.positions, {}), bytes);
    put_vector(std::exchange(piece.codes, {}), bytes);
    put_vector(std::exchange(piece.attributes, {}), bytes);
    store.take_facets(piece);
    put_vector(std::exchange(piece.first, {}), bytes);
    put_vector(std::exchange(piece.corners, {}), bytes);
    put_vector(std::exchange(piece.sides, {}), bytes);
    store.take_foreign(piece);
    put_vector(piece.foreign, bytes);
}

Piece taken_piece(ByteReader& reader) {
    Piece piece;
    piece.range = reader.take<VoxelRange>();
    piece.counts = reader.take<FacetCounts>();
    piece.positions = reader.take_vector<Vec3>();
    piece.codes = reader.take_vector<MortonCode>();
    piece.attributes = reader.take_vector<char>();
    piece.first = reader.take_vector<Index>();
    piece.corners = reader.take_vector<Index>();
    piece.sides = reader.take_vector<EdgeHint>();
    piece.foreign = reader.take_vector<Piece::Foreign>();
    return piece;
}

} // namespace

void gather_pieces(std::vector<Piece>& pieces, PieceStore& store,
                   const std::function<int(std::size_t)>& owner, Ranks& ranks) {
    if (ranks.size() == 1) return;
    std::size_t next = 0;
    for (;;) { // a piece of each rank at a time
        Interruption::poll();
        while (next < pieces.size() && (ranks.is_first() || owner(next) != ranks.rank())) ++next;
        const bool sends = next < pieces.size();
        if (!ranks.any(sends)) break;
        std::vector<Ranks::Bytes> out(static_cast<std::size_t>(ranks.size()));
        if (sends) {
            put(next, out.front());
            put_piece(std::move(pieces[next++]), store, out.front());
        }
        for (Ranks::Bytes& got : ranks.exchange(std::move(out))) {
            if (got.empty()) continue;
            ByteReader reader(got);
            Piece& piece = pieces[reader.take<std::size_t>()];
            piece = taken_piece(reader);
            release(got);
            store.put(piece);
        }
    }
    if (!ranks.is_first()) pieces.clear();
}

} // namespace hsdm
