#pragma once
// Unions of facets: round vertices that have no other facet, and across their sides.

#include "hsdm/core/large_vector.hh"
#include "hsdm/polygon_mesh.hh"

#include <array>
#include <span>

namespace hsdm {

/// The facets at each vertex with one or two of them, and how many there are.
struct VertexFacets {
    std::vector<std::array<Index, 2>> facets;
    std::vector<std::uint8_t> count; ///< 3: more than two
};
VertexFacets facets_at_vertices(const PolygonMesh& mesh);

/// Two facets as one.
struct UnitedFacets {
    std::vector<Index> ring;
    /// The vertices that lie between the two: the sides that they share are one path, these its inner
    /// vertices.
    std::vector<Index> between;
};

/// Unites the two facets at a vertex that has no third (`at`), along all such vertices in a row. The ring has
/// two vertices if the facets lie back to back. It is empty if the vertex lies on a border, if the facets
/// share all their sides, or if the union has a vertex twice.
UnitedFacets united(const PolygonMesh& mesh, const VertexFacets& at, Index between);

/// The union of facets f and g, from vertex `to`: f runs along their side from `from` to `to`, g back. Empty
/// if it has a vertex twice.
std::vector<Index> united_across(std::span<const Index> f, std::span<const Index> g, Index from, Index to);

/// Facets to be replaced a few at a time, each once.
class FacetUnions {
public:
    explicit FacetUnions(const PolygonMesh& mesh)
        : fate_(large_vector<Index>(mesh.facet_count(), Index{stays})) {}

    bool is_free(Index f, Index g) const { return f != g && fate_[f] == stays && fate_[g] == stays; }
    /// Replaces facets f and g by one with this ring, or by none if it has fewer than three vertices.
    void unite(Index f, Index g, std::vector<Index> ring);
    /// Replaces the facets by these, in the place of the first.
    void replace(std::span<const Index> facets, std::vector<std::vector<Index>> by);
    /// What replaces facets stands where the lowest of them was; positions stay. Returns how often it was
    /// done.
    std::size_t apply(PolygonMesh& mesh) const;

private:
    static constexpr Index stays = no_index, goes = no_index - 1;
    std::vector<Index> fate_; // per facet: stays, goes, or what takes its place
    std::vector<std::vector<std::vector<Index>>> by_;
};

/// Makes one facet of each of these (ascending) and the one across its longest side, if that is none of them:
/// what lies in one line with that side leaves the other as it is but for more
/// corners on it. Not where that side is on a border, nor where a corner would be there twice; each facet
/// takes part once. The same whichever way round facets are. Vertices stay. Returns how many were united.
/// O(facets) if there are any.
std::size_t unite_across_longest(std::span<const Index> facets, PolygonMesh& mesh);

} // namespace hsdm
