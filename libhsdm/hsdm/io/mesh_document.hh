#pragma once
// Files that are rows of vertices and a row of facets: each element's bytes follow from that element alone,
// so that any stretch can be made by itself, by any process.

#include "hsdm/io/atomic_file.hh"
#include "hsdm/io/write_mesh.hh"

namespace hsdm {

/// What a file's head tells of the mesh, and what decides how its elements are written.
struct MeshCounts {
    std::size_t vertices = 0, facets = 0, triangles = 0;
    std::size_t largest_facet = 0; ///< corners
};
MeshCounts counts_of(const PolygonMesh& mesh);

struct MeshDocument {
    /// A row of all vertices.
    struct OfVertices {
        /// Appends vertices begin .. end - 1.
        std::function<void(std::string& out, const PolygonMesh&, const VertexRows&, std::size_t begin,
                           std::size_t end)>
            append;
        bool reads_rows = true; ///< not positions alone
    };
    std::string head{}, tail{};
    std::vector<OfVertices> vertices{}; ///< one row after the other
    /// Appends facets begin .. end - 1.
    std::function<void(std::string& out, const PolygonMesh&, std::size_t begin, std::size_t end)> facets{};
    bool facets_have_places = false; ///< made of positions, and not of the numbers of vertices
};

MeshDocument off_document(const MeshCounts& counts);
/// Of `rows` only what there is.
MeshDocument ply_document(const MeshCounts& counts, const VertexRows& rows, bool ascii);
MeshDocument stl_document(const MeshCounts& counts, bool ascii);
MeshDocument obj_document(bool normals);

bool is_document(MeshFormat format);
/// What of the rows a file of the format holds.
VertexRows rows_held(MeshFormat format, const VertexRows& rows);
/// One of these four.
MeshDocument document_of(MeshFormat format, const MeshCounts& counts, const VertexRows& rows, bool ascii);

/// All of it.
void write_document(AtomicFile& file, MeshFormat format, const PolygonMesh& mesh, const VertexRows& rows,
                    bool ascii);

/// Calls put(value) with the value in the property's own type.
template <class Put>
void with_type(VertexProperty::Type type, double value, const Put& put) {
    switch (type) {
    case VertexProperty::Type::uint8:
        return put(static_cast<std::uint8_t>(value));
    case VertexProperty::Type::int32:
        return put(static_cast<std::int32_t>(value));
    case VertexProperty::Type::float32:
        return put(static_cast<float>(value));
    case VertexProperty::Type::float64:
        return put(value);
    }
}

} // namespace hsdm
