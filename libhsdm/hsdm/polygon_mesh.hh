#pragma once
// Facets before OpenMesh sees them: what the facet stage makes and what the writers write.

#include "hsdm/types.hh"

#include <span>
#include <string>
#include <vector>

namespace hsdm {

/// A value per vertex under the name it is written with (e.g. `hsdm_vertex_class`).
struct VertexProperty {
    enum class Type { uint8, int32, float32, float64 };
    std::string name;
    Type type = Type::float64;
    std::vector<double> values;
};

/// Polygons over shared vertices, as flat arrays: facet f is corners[first[f]] .. corners[first[f + 1]].
struct PolygonMesh {
    std::vector<Vec3> positions;
    std::vector<Vec3> normals; ///< empty or one unit normal per vertex
    std::vector<Index> corners;
    std::vector<Index> first{0};
    std::vector<VertexProperty> properties;
    std::vector<Index>
        origin; ///< empty, or per vertex the number its maker gave it, which copies of it keep: what else
                ///< is known of vertices need not travel with them. Nothing writes it

    std::size_t vertex_count() const { return positions.size(); }
    std::size_t facet_count() const { return first.size() - 1; }
    std::span<const Index> facet(std::size_t f) const {
        return {corners.data() + first[f], corners.data() + first[f + 1]};
    }
    void add_facet(std::span<const Index> vertices) {
        corners.insert(corners.end(), vertices.begin(), vertices.end());
        first.push_back(static_cast<Index>(corners.size()));
    }
};

/// Of the positions of a facet's corners.
inline Box box_of(const PolygonMesh& mesh, std::size_t facet) {
    Box box;
    for (Index v : mesh.facet(facet)) box.add(mesh.positions[v]);
    return box;
}

} // namespace hsdm
