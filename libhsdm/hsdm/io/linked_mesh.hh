#pragma once
// A mesh in flat arrays whose sides know their twins: what the formats that tell of edges are written from
// where a half-edge mesh would be too large.

#include "hsdm/io/write_mesh.hh"
#include "hsdm/mesh/facet_links.hh"

namespace hsdm {

/// One fan of facets round each vertex, none without; no facet is rejected. All must outlive it.
struct LinkedMesh {
    const PolygonMesh& facets; ///< positions and facets alone
    const FacetLinks& links;   ///< of which facet, twin, side_out and open_in are read
    /// Per side whether its edge is sharp, for both sides of an edge alike; or empty.
    std::span<const std::uint8_t> sharp;
    const VertexRows& rows; ///< the nine numbers of `hsdm_normals` in a row, if there are such

    bool is_sharp(std::size_t side) const { return !sharp.empty() && sharp[side] != 0; }
    /// Calls visit(side) for the sides that start at a vertex, from the one behind the border if there is
    /// one.
    template <class Visit>
    void for_sides_from(Index vertex, const Visit& visit) const {
        hsdm::for_sides_from(facets, links, vertex, visit);
    }
};

/// Writes what write_mesh() writes of that mesh with the normals, the properties and the sharp edges, to the
/// same bytes, in any format; of PLY, OFF, STL and OBJ the facets and rows alone are read. Beside the mesh it
/// holds some megabytes, and for GLB a number a vertex, for .om a fifth of a byte a side; to recentre,
/// another copy of the facets; of 3MF that goes into a pipe, the whole archive. Throws Error, as
/// write_mesh(), and for .om of more half-edges or bytes of a property than that format can number.
WrittenMesh write_mesh(const std::string& path, const LinkedMesh& mesh, MeshFormat format,
                       const WriteOptions& options = {});

} // namespace hsdm
