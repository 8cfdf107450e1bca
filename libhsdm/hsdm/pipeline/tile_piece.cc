#include "hsdm/pipeline/tile_piece.hh"

#include "hsdm/core/chunks.hh"
#include "hsdm/core/hash.hh"
#include "hsdm/core/large_vector.hh"
#include "hsdm/errors.hh"
#include "hsdm/pipeline/attributes.hh"

#include <algorithm>
#include <tuple>

namespace hsdm {
namespace {

/// A tile's mesh, in the order of voxels, and its level.
class TileMesh {
public:
    TileMesh(const MethodInput& in, const PartFacets& part, const VoxelRange& range)
        : level_(in.level), part_(part), mesh_(part.mesh), range_(range) {
        first_of_ = large_vector<Index>(level_.size() + 1, 0);
        for (const Index v : part.voxel) ++first_of_[v + 1];
        counts_to_first(first_of_);
        own_ = own_vertices();
        facets_ = own_facets();
    }

    Piece piece() const {
        Piece piece;
        piece.range = range_;
        const auto vertex = [&](Index v) { return mesh_.positions.begin() + static_cast<std::ptrdiff_t>(v); };
        piece.positions.assign(vertex(own_[0]), vertex(own_[1]));
        resize_large(piece.codes, piece.positions.size());
        for_each_index(piece.codes.size(), chunks::light,
                       [&](Index v) { piece.codes[v] = code_of(own_[0] + v); });
        add_facets(piece);
        add_digests(piece);
        return piece;
    }

    /// As extended_method() has them: of the points of each vertex's voxel, which is its own.
    std::vector<char> attributes(const MethodInput& in, const AttributeRows& rows) const {
        if (rows.bytes() == 0) return {};
        const std::span<const Index> own = std::span(part_.voxel).subspan(own_[0], own_[1] - own_[0]);
        std::vector<char> of_own =
            rows.rows_of(average_attributes(in.cloud, in.octree, level_, own), own.size());
        for_each_index(rows.has_kinds() ? own.size() : 0, chunks::usual, [&](Index v) {
            rows.set_kind(of_own.data() + v * rows.bytes(), kind_in(in.octree, own[v]));
        });
        return of_own;
    }

private:
    using Range = std::array<Index, 2>;

    /// Of the points of a voxel, the kind nearest to being measured.
    PointKind kind_in(const Octree& octree, Index voxel) const {
        PointKind least = PointKind::completed;
        for (Index p = level_.first_point[voxel]; p < level_.first_point[voxel + 1]; ++p)
            least = std::min(least, kind_of(octree.source[p]));
        return least;
    }

    MortonCode code_of(Index vertex) const { return level_.codes[part_.voxel[vertex]]; }
    Index rank_of(Index vertex) const { return vertex - first_of_[part_.voxel[vertex]]; }
    Index least_of(std::size_t facet) const { return std::ranges::min(mesh_.facet(facet)); }
    bool is_own(Index vertex) const { return vertex >= own_[0] && vertex < own_[1]; }

    /// Vertices are in the order of their voxels' codes, and so are those of a range of codes.
    Range own_vertices() const {
        const auto first = [&](MortonCode code) {
            const auto voxel = std::ranges::lower_bound(level_.codes, code) - level_.codes.begin();
            return first_of_[static_cast<std::size_t>(voxel)];
        };
        return {first(range_.begin), first(range_.end)};
    }

    /// Facets are in the order of their least vertices.
    Range own_facets() const {
        const auto first = [&](Index vertex) {
            std::size_t lo = 0, hi = mesh_.facet_count();
            while (lo < hi) {
                const std::size_t middle = (lo + hi) / 2;
                if (least_of(middle) < vertex)
                    lo = middle + 1;
                else
                    hi = middle;
            }
            return static_cast<Index>(lo);
        };
        return {first(own_[0]), first(own_[1])};
    }

    void add_facets(Piece& piece) const {
        std::vector<Index> others;
        const Index begin = mesh_.first[facets_[0]], end = mesh_.first[facets_[1]];
        for (Index c = begin; c < end; ++c)
            if (!is_own(mesh_.corners[c])) others.push_back(mesh_.corners[c]);
        sort_unique(others);
        for (const Index v : others) piece.foreign.push_back({code_of(v), rank_of(v), mesh_.positions[v]});
        const auto own = static_cast<Index>(piece.positions.size());
        resize_large(piece.corners, end - begin);
        for_each_index(piece.corners.size(), chunks::light, [&](Index c) {
            const Index v = mesh_.corners[begin + c];
            piece.corners[c] =
                is_own(v) ? v - own_[0]
                          : own + static_cast<Index>(std::ranges::lower_bound(others, v) - others.begin());
        });
        for (Index f = facets_[0]; f < facets_[1]; ++f) piece.first.push_back(mesh_.first[f + 1] - begin);
        const auto& sides = part_.known.hints.sides;
        if (!sides.empty())
            piece.sides.assign(sides.begin() + static_cast<std::ptrdiff_t>(begin),
                               sides.begin() + static_cast<std::ptrdiff_t>(end));
    }

    /// Of the vertices of a voxel and the facets that these are the least ones of.
    std::uint64_t hash_of(Index voxel, std::size_t& facet) const {
        OrderedHash hash;
        const auto& sides = part_.known.hints.sides;
        for (Index v = first_of_[voxel]; v < first_of_[voxel + 1]; ++v)
            for (std::size_t k = 0; k < 3; ++k) hash.add(mesh_.positions[v][k]);
        for (; facet < mesh_.facet_count() && least_of(facet) < first_of_[voxel + 1]; ++facet) {
            hash.add(std::uint64_t{mesh_.facet(facet).size()});
            for (Index c = mesh_.first[facet]; c < mesh_.first[facet + 1]; ++c) {
                hash.add(std::uint64_t{code_of(mesh_.corners[c])});
                hash.add(std::uint64_t{rank_of(mesh_.corners[c])});
                if (!sides.empty()) hash.add(static_cast<std::uint64_t>(sides[c]));
            }
        }
        return hash.value();
    }

    void add_digests(Piece& piece) const {
        std::size_t facet = 0;
        for_each_in_order(level_.size(), [&](std::size_t i) {
            const auto voxel = static_cast<Index>(i);
            const std::uint64_t hash = hash_of(voxel, facet);
            const MortonCode code = level_.codes[voxel];
            const VoxelCoord at = level_.coord(voxel);
            if (!range_.holds(code)) {
                if (range_.is_near(at, compared_voxels)) piece.beyond.push_back({code, hash});
            } else if (!range_.holds_around(at, compared_voxels)) {
                piece.border.push_back({code, hash});
            }
        });
    }

    const OctreeLevel& level_;
    const PartFacets& part_;
    const PolygonMesh& mesh_;
    const VoxelRange& range_;
    std::vector<Index> first_of_; // per voxel, its first vertex
    Range own_{}, facets_{};
};

} // namespace

Piece make_piece(const MethodInput& in, const PartOfLevel& part, const VoxelRange& range,
                 const AttributeRows& attributes) {
    PartFacets facets = facets_of_part(in, part);
    const TileMesh tile(in, facets, range);
    Piece piece = tile.piece();
    piece.attributes = tile.attributes(in, attributes);
    piece.counts = facets.counts;
    piece.components = std::move(facets.components);
    return piece;
}

} // namespace hsdm
