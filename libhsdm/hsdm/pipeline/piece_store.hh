#pragma once
// Finished pieces on disk, until all are joined.

#include "hsdm/core/ranks.hh"
#include "hsdm/io/scratch_bytes.hh"
#include "hsdm/pipeline/tile_piece.hh"

#include <map>

namespace hsdm {

/// Keeps the large arrays of pieces: all but what neighbours are compared by. A piece made again takes the
/// room of another time on disk. Not for several threads.
class PieceStore {
public:
    /// Throws Error as ScratchBytes.
    explicit PieceStore(const ScratchPlace& place) : file_(place) {}

    /// Writes a piece and takes its arrays; the range says which it is. Throws Error if the disk is full.
    void put(Piece& piece);
    /// Vertices of a piece that was put, and corners and facets.
    std::size_t vertices(const Piece& piece) const { return place_of(piece).vertices; }
    std::size_t corners(const Piece& piece) const { return place_of(piece).corners; }
    std::size_t facets(const Piece& piece) const { return place_of(piece).facets; }
    bool has_sides(const Piece& piece) const { return place_of(piece).sides > 0; }
    /// Reads arrays of a piece into it again.
    void take_vertices(Piece& piece) const; ///< positions, codes and attributes
    void take_foreign(Piece& piece) const;
    void take_facets(Piece& piece) const; ///< first, corners, sides

    std::size_t bytes() const { return file_.size(); } ///< on disk
    void flush_to_disk() const { file_.flush_to_disk(); }

    /// What is in memory of a piece that was put, and where on disk the rest is.
    void put_record(const Piece& piece, Ranks::Bytes& bytes) const;
    /// The piece of a record, with the rest in this store's file.
    Piece take_record(ByteReader& record);

private:
    struct Place {
        std::size_t vertices = 0, facets = 0, corners = 0, sides = 0, foreign = 0, attributes = 0;
        std::size_t positions_at = 0, codes_at = 0, first_at = 0, corners_at = 0, sides_at = 0,
                    foreign_at = 0, attributes_at = 0;
    };
    const Place& place_of(const Piece& piece) const { return places_.at(piece.range.begin); }

    ScratchBytes file_;
    std::map<MortonCode, Place> places_; // by where the range begins
};

} // namespace hsdm
