#include "hsdm/pipeline/piece_store.hh"

#include "hsdm/core/large_vector.hh"

namespace hsdm {
namespace {

constexpr const char* the_pieces = "the pieces of the mesh";

} // namespace

void PieceStore::put(Piece& piece) {
    Place place;
    const auto keep = [&](auto& values, std::size_t& count, std::size_t& at) {
        count = values.size();
        at = file_.append(the_pieces, values);
        release(values);
    };
    std::size_t firsts = 0, codes = 0;
    keep(piece.positions, place.vertices, place.positions_at);
    keep(piece.codes, codes, place.codes_at);
    keep(piece.attributes, place.attributes, place.attributes_at);
    keep(piece.first, firsts, place.first_at);
    keep(piece.corners, place.corners, place.corners_at);
    keep(piece.sides, place.sides, place.sides_at);
    keep(piece.foreign, place.foreign, place.foreign_at);
    place.facets = firsts - 1;
    places_[piece.range.begin] = place;
}

void PieceStore::take_vertices(Piece& piece) const {
    const Place& place = place_of(piece);
    file_.read(place.positions_at, place.vertices, piece.positions);
    file_.read(place.codes_at, place.vertices, piece.codes);
    file_.read(place.attributes_at, place.attributes, piece.attributes);
}

void PieceStore::take_foreign(Piece& piece) const {
    const Place& place = place_of(piece);
    file_.read(place.foreign_at, place.foreign, piece.foreign);
}

void PieceStore::take_facets(Piece& piece) const {
    const Place& place = place_of(piece);
    file_.read(place.first_at, place.facets + 1, piece.first);
    file_.read(place.corners_at, place.corners, piece.corners);
    file_.read(place.sides_at, place.sides, piece.sides);
}

void PieceStore::put_record(const Piece& piece, Ranks::Bytes& bytes) const {
    hsdm::put(piece.range, bytes);
    hsdm::put(place_of(piece), bytes);
    hsdm::put(piece.counts, bytes);
    put_vector(piece.border, bytes), put_vector(piece.beyond, bytes);
    for (const PartComponents& part : piece.components) {
        hsdm::put(part.largest, bytes);
        put_vector(part.sizes, bytes), put_vector(part.shared, bytes);
    }
}

Piece PieceStore::take_record(ByteReader& record) {
    Piece piece;
    piece.first.clear(); // is on disk
    piece.range = record.take<VoxelRange>();
    places_[piece.range.begin] = record.take<Place>();
    piece.counts = record.take<FacetCounts>();
    piece.border = record.take_vector<Piece::Digest>();
    piece.beyond = record.take_vector<Piece::Digest>();
    for (PartComponents& part : piece.components) {
        part.largest = record.take<std::size_t>();
        part.sizes = record.take_vector<std::size_t>();
        part.shared = record.take_vector<PartComponents::Shared>();
    }
    return piece;
}

} // namespace hsdm
