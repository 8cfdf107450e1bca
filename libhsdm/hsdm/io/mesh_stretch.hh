#pragma once
// Stretches of a mesh's rows of vertices and facets, as meshes that go from one process to another.

#include "hsdm/core/ranks.hh"
#include "hsdm/io/write_mesh.hh"

namespace hsdm {

/// Vertices begin .. end - 1, their positions less `shift`, with normals and properties as `rows` has them.
PolygonMesh stretch_of_vertices(const PolygonMesh& mesh, const VertexRows& rows, const Vec3& shift,
                                std::size_t begin, std::size_t end);

/// Facets begin .. end - 1, whose corners are vertices of the mesh still; no positions.
PolygonMesh stretch_of_facets(const PolygonMesh& mesh, std::size_t begin, std::size_t end);

/// The same over positions of their own, in memory of a number a vertex that is kept from one to the next.
class PlacedStretches {
public:
    /// The mesh must outlive it.
    PlacedStretches(const PolygonMesh& mesh, const Vec3& shift);
    PolygonMesh facets(std::size_t begin, std::size_t end);

private:
    const PolygonMesh& mesh_;
    const Vec3 shift_;
    std::vector<Index> number_; // of vertices in the stretch at hand
};

/// Properties in their own type.
Ranks::Bytes bytes_of_stretch(const PolygonMesh& stretch);
/// Properties have no names.
PolygonMesh stretch_from(const Ranks::Bytes& bytes);

} // namespace hsdm
