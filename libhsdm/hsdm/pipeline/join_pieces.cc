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

    JoinedPieces joined() {
        PolygonMesh& mesh = joined_.mesh;
        count();
        for (Piece& piece : pieces_) {
            if (store_) store_->take_foreign(piece);
            foreign_.emplace_back(piece.foreign.size());
        }
        find_runs();
        reserve_large(mesh.positions, first_.back());
        for (std::size_t k = 0; k < pieces_.size(); ++k) add_vertices(k);
        reserve_large(mesh.corners, corners_);
        reserve_large(mesh.first, facets_ + 1);
        if (has_sides_) reserve_large(joined_.sides, corners_);
        for (std::size_t k = 0; k < pieces_.size(); ++k) add_facets(k);
        return std::move(joined_);
    }

private:
    /// Vertices of a piece among the foreign ones of another.
    struct Run {
        std::size_t owner, of;  ///< pieces
        std::size_t begin, end; ///< of the foreign ones
    };

    void count() {
        std::size_t vertices = 0;
        for (const Piece& piece : pieces_) {
            vertices += store_ ? store_->vertices(piece) : piece.positions.size();
            first_.push_back(static_cast<Index>(vertices));
            corners_ += store_ ? store_->corners(piece) : piece.corners.size();
            facets_ += store_ ? store_->facets(piece) : piece.first.size() - 1;
            has_sides_ |= store_ ? store_->has_sides(piece) : !piece.sides.empty();
        }
        check_mesh_size(vertices, corners_);
    }

    /// By the pieces whose vertices they are.
    void find_runs() {
        for (std::size_t of = 0; of < pieces_.size(); ++of) {
            const std::vector<Piece::Foreign>& foreign = pieces_[of].foreign;
            for (std::size_t begin = 0; begin < foreign.size();) {
                const auto begins = [](const Piece& piece) { return piece.range.begin; };
                const auto next = std::ranges::upper_bound(pieces_, foreign[begin].code, {}, begins);
                const auto owner = static_cast<std::size_t>(next - pieces_.begin()) - 1;
                std::size_t end = begin;
                while (end < foreign.size() && foreign[end].code < pieces_[owner].range.end) ++end;
                runs_.push_back({owner, of, begin, end});
                begin = end;
            }
        }
        std::ranges::stable_sort(runs_, {}, &Run::owner);
    }

    void add_vertices(std::size_t k) {
        Piece& piece = pieces_[k];
        if (store_) store_->take_vertices(piece);
        for (; next_run_ < runs_.size() && runs_[next_run_].owner == k; ++next_run_)
            number_foreign(runs_[next_run_]);
        append_large(joined_.mesh.positions, piece.positions);
        append_large(joined_.attributes, piece.attributes);
        release(piece.positions, piece.codes, piece.attributes);
    }

    void number_foreign(const Run& run) {
        const std::vector<Piece::Foreign>& foreign = pieces_[run.of].foreign;
        for (std::size_t f = run.begin; f < run.end; ++f)
            foreign_[run.of][f] = first_[run.owner] + place_in(pieces_[run.owner], foreign[f]);
    }

    static Index place_in(const Piece& owner, const Piece::Foreign& foreign) {
        const auto& codes = owner.codes;
        const auto place = std::ranges::lower_bound(codes, foreign.code) - codes.begin();
        const std::size_t v = static_cast<std::size_t>(place) + foreign.rank;
        if (v >= codes.size() || codes[v] != foreign.code || owner.positions[v] != foreign.position)
            throw Error("two tiles disagree about a vertex that both have; this is an error of the program");
        return static_cast<Index>(v);
    }

    void add_facets(std::size_t k) {
        Piece& piece = pieces_[k];
        PolygonMesh& mesh = joined_.mesh;
        if (store_) store_->take_facets(piece);
        const Index own = first_[k + 1] - first_[k], before = static_cast<Index>(mesh.corners.size());
        append_large(joined_.sides, piece.sides);
        for_each_in_order(piece.corners.size(), [&](std::size_t c) {
            const Index v = piece.corners[c];
            mesh.corners.push_back(v < own ? first_[k] + v : foreign_[k][v - own]);
        });
        for (std::size_t f = 1; f < piece.first.size(); ++f) mesh.first.push_back(before + piece.first[f]);
        piece = Piece();
    }

    std::vector<Piece>& pieces_;
    const PieceStore* store_;
    JoinedPieces joined_;
    std::vector<Index> first_{0}; // vertex of each piece
    std::size_t corners_ = 0, facets_ = 0;
    bool has_sides_ = false;
    std::vector<Run> runs_;
    std::size_t next_run_ = 0;
    std::vector<std::vector<Index>> foreign_; // per piece, numbers of its foreign vertices
};

} // namespace

void check_mesh_size(std::size_t vertices, std::size_t corners) {
    if (std::max(vertices, corners) < no_index) return;
    throw Error(
        "the mesh would have " + std::to_string(vertices) + " vertices and " + std::to_string(corners)
        + " corners of facets; fewer than 2^32 - 1 of each can be told apart, give a smaller --depth");
}

JoinedPieces joined_pieces(std::vector<Piece>&& pieces, const PieceStore* store) {
    return Joiner(pieces, store).joined();
}

} // namespace hsdm
