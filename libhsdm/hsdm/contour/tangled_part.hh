#pragma once
// Facets of a mesh that intersect others, with those around them.

#include "hsdm/polygon_mesh.hh"

#include <array>

namespace hsdm {

/// The intersecting facets and those around them, as a mesh of its own. Facets outside cannot meet what moves
/// inside, because vertices move towards their neighbours and so stay within the neighbourhood's box.
class TangledPart {
public:
    /// Of pairs of facets, with all facets whose boxes come within `nearby` of theirs. O(facets).
    TangledPart(const PolygonMesh& mesh, const std::vector<std::array<Index, 2>>& pairs, double nearby);

    PolygonMesh part;

    /// Per vertex of the part: may it move? One that has facets outside must stay: not all of its neighbours
    /// are known here.
    bool inner(Index v) const { return inner_[v] != 0; }
    /// The part's facets in the mesh, ascending, and what its vertices are there.
    const std::vector<Index>& facets() const { return facets_; }
    std::vector<Index> vertices() const;

    void write_back(PolygonMesh& mesh) const;
    /// The same where the part's facets have changed too: they follow the mesh's others.
    void replace_facets(PolygonMesh& mesh) const;

private:
    std::vector<Index> facets_;    // of the part, in the mesh
    std::vector<Index> of_vertex_; // per vertex of the mesh, that of the part or no_index
    std::vector<std::uint8_t> inner_;
};

} // namespace hsdm
