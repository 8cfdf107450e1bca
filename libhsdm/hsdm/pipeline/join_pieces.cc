#include "hsdm/pipeline/join_pieces.hh"

#include "hsdm/core/chunks.hh"
#include "hsdm/core/large_vector.hh"
#include "hsdm/errors.hh"

#include <algorithm>

namespace hsdm {
namespace {

class Joiner {
public:
    Joiner(std::vector<Piece>& pieces, const PieceStore* store) : pieces_(pieces), store_(store) {}

    PolygonMesh mesh(std::vector<EdgeHint>& sides) {
        PolygonMesh mesh;
        count();
        for (Piece& piece : pieces_) {
            if (store_) store_->take_foreign(piece);
            foreign_.emplace_back(piece.foreign.size());
        }
        reserve_large(mesh.positions, first_.back());
        for (std::size_t k = 0; k < pieces_.size(); ++k) add_vertices(k, mesh);
        reserve_large(mesh.corners, corners_);
        reserve_large(mesh.first, facets_ + 1);
        if (has_sides_) reserve_large(sides, corners_);
        for (std::size_t k = 0; k < pieces_.size(); ++k) add_facets(k, mesh, sides);
        return mesh;
    }

private:
    void count() {
        for (const Piece& piece : pieces_) {
            const std::size_t own = store_ ? store_->vertices(piece) : piece.positions.size();
            first_.push_back(first_.back() + static_cast<Index>(own));
            corners_ += store_ ? store_->corners(piece) : piece.corners.size();
            facets_ += store_ ? store_->facets(piece) : piece.first.size() - 1;
            has_sides_ |= store_ ? store_->has_sides(piece) : !piece.sides.empty();
        }
    }

    void add_vertices(std::size_t k, PolygonMesh& mesh) {
        Piece& piece = pieces_[k];
        if (store_) store_->take_vertices(piece);
        for (std::size_t i = 0; i < pieces_.size(); ++i) number_foreign(i, k);
        append_large(mesh.positions, piece.positions);
        piece.positions = {}, piece.codes = {};
    }

    /// Numbers the vertices of piece k among the foreign ones of piece i.
    void number_foreign(std::size_t i, std::size_t k) {
        const std::vector<Piece::Foreign>& foreign = pieces_[i].foreign;
        const auto from = [&](MortonCode code) {
            return std::ranges::lower_bound(foreign, code, {}, &Piece::Foreign::code) - foreign.begin();
        };
        const auto end = static_cast<std::size_t>(from(pieces_[k].range.end));
        for (auto f = static_cast<std::size_t>(from(pieces_[k].range.begin)); f < end; ++f)
            foreign_[i][f] = first_[k] + place_in(pieces_[k], foreign[f]);
    }

    static Index place_in(const Piece& owner, const Piece::Foreign& foreign) {
        const auto& codes = owner.codes;
        const auto place = std::ranges::lower_bound(codes, foreign.code) - codes.begin();
        const std::size_t v = static_cast<std::size_t>(place) + foreign.rank;
        if (v >= codes.size() || codes[v] != foreign.code || owner.positions[v] != foreign.position)
            throw Error("two tiles disagree about a vertex that both have; this is an error of the program");
        return static_cast<Index>(v);
    }

    void add_facets(std::size_t k, PolygonMesh& mesh, std::vector<EdgeHint>& sides) {
        Piece& piece = pieces_[k];
        if (store_) store_->take_facets(piece);
        const Index own = first_[k + 1] - first_[k], before = static_cast<Index>(mesh.corners.size());
        append_large(sides, piece.sides);
        for_each_in_order(piece.corners.size(), [&](std::size_t c) {
            const Index v = piece.corners[c];
            mesh.corners.push_back(v < own ? first_[k] + v : foreign_[k][v - own]);
        });
        for (std::size_t f = 1; f < piece.first.size(); ++f) mesh.first.push_back(before + piece.first[f]);
        piece = Piece();
    }

    std::vector<Piece>& pieces_;
    const PieceStore* store_;
    std::vector<Index> first_{0}; // vertex of each piece
    std::size_t corners_ = 0, facets_ = 0;
    bool has_sides_ = false;
    std::vector<std::vector<Index>> foreign_; // per piece, numbers of its foreign vertices
};

} // namespace

PolygonMesh joined_pieces(std::vector<Piece>&& pieces, std::vector<EdgeHint>& sides,
                          const PieceStore* store) {
    return Joiner(pieces, store).mesh(sides);
}

} // namespace hsdm
