#pragma once
// Polygons before they become an OpenMesh mesh: what the facet stages make and the writers write.

#include "hsdm/types.hh"

#include <array>
#include <span>
#include <string>
#include <vector>

namespace hsdm {

/// A value per vertex under the name it is written with (e.g. `hsdm_vertex_class`).
struct VertexProperty {
    /// How values are stored in a file and on an OpenMesh mesh.
    enum class Type {
        uint8,   ///< unsigned, 8 bits
        int32,   ///< signed, 32 bits
        float32, ///< float
        float64, ///< double
    };
    std::string name;           ///< in files and on OpenMesh meshes
    Type type = Type::float64;  ///< all values must fit it
    std::vector<double> values; ///< one per vertex
};

/// The names of the properties that hold colours, each a Type::uint8.
inline constexpr std::array<const char*, 4> color_properties{"red", "green", "blue", "alpha"};

/// Polygons over shared vertices, as flat arrays: facet f is corners[first[f]] .. corners[first[f + 1]].
struct PolygonMesh {
    std::vector<Vec3> positions;            ///< per vertex
    std::vector<Vec3> normals;              ///< empty or one unit normal per vertex
    std::vector<Index> corners;             ///< vertices of all facets, one facet after the other
    std::vector<Index> first{0};            ///< per facet, where its corners begin; at the end their number
    std::vector<VertexProperty> properties; ///< each with one value per vertex
    /// The sharp edges that are known, each by its two vertices, the lower first: what the status bit
    /// `feature` says of the edges of an OpenMesh mesh. Of the writers only that of .om writes them.
    std::vector<std::array<Index, 2>> sharp_edges;
    /// Empty, or per vertex a number given by the stage that made it, which copies of the vertex keep, so
    /// that other data of vertices can be looked up by it. No writer writes it.
    std::vector<Index> origin;

    /// Number of vertices, isolated ones too.
    std::size_t vertex_count() const { return positions.size(); }
    /// Number of facets.
    std::size_t facet_count() const { return first.size() - 1; }
    /// Vertices of facet f < facet_count(), in its order; valid until facets are added.
    std::span<const Index> facet(std::size_t f) const {
        return {corners.data() + first[f], corners.data() + first[f + 1]};
    }
    /// Appends a facet; nothing is checked.
    void add_facet(std::span<const Index> vertices) {
        corners.insert(corners.end(), vertices.begin(), vertices.end());
        first.push_back(static_cast<Index>(corners.size()));
    }
};

/// Box of the positions of a facet's corners.
inline Box box_of(const PolygonMesh& mesh, std::size_t facet) {
    Box box;
    for (Index v : mesh.facet(facet)) box.add(mesh.positions[v]);
    return box;
}

} // namespace hsdm
