#include "hsdm/contour/flat_corners.hh"

#include "hsdm/core/chunks.hh"
#include "hsdm/quality/topology.hh"

#include <catch2/catch.hpp>

#include <algorithm>
#include <array>

using namespace hsdm;

namespace {

/// Ground, z = 0 where y > 0, and a wall below it, y = 0. Vertices 0 to 4 lie on their crease, at x = 0 to 4.
/// A quad of the ground has vertex 2 for a corner, where the crease goes straight on, and 11 opposite.
struct Fold {
    PolygonMesh mesh;
    std::vector<VertexClass> classes;

    Fold() {
        for (int x = 0; x < 5; ++x) mesh.positions.emplace_back(x, 0, 0);
        for (int x = 0; x < 5; ++x) mesh.positions.emplace_back(x, 0, -1);
        for (const Vec3& p :
             {Vec3(0, 1, 0), Vec3(2, 1, 0), Vec3(4, 1, 0), Vec3(1, 1, 0), Vec3(2, 2, 0), Vec3(3, 1, 0)})
            mesh.positions.push_back(p);
        for (Index x = 0; x < 4; ++x) mesh.add_facet(std::array<Index, 4>{x, x + 5, x + 6, x + 1});
        for (const std::array<Index, 4>& quad : {std::array<Index, 4>{0, 1, 13, 10},
                                                 {3, 4, 12, 15},
                                                 {1, 11, 14, 13},
                                                 {11, 3, 15, 14},
                                                 {1, 2, 3, 11}})
            mesh.add_facet(quad);
        mesh.origin = indices_below(mesh.vertex_count());
        classes.assign(mesh.vertex_count(), VertexClass::smooth);
        for (std::size_t v = 0; v < 5; ++v) classes[v] = VertexClass::edge;
    }

    /// The last quad as two triangles with an edge from the crease.
    void cut() {
        mesh.corners.resize(mesh.corners.size() - 4);
        mesh.first.pop_back();
        mesh.add_facet(std::array<Index, 3>{1, 2, 11});
        mesh.add_facet(std::array<Index, 3>{2, 3, 11});
    }
};

/// Quads alone, one vertex and the facets at it gone, those beside it at the crease; one disc as before.
void check_collapsed(const PolygonMesh& mesh) {
    const Topology t = measure_topology(mesh);
    CHECK(t.quads == 8);
    CHECK(t.faces == 8);
    CHECK(t.vertices == 15);
    CHECK(t.isolated_vertices == 0);
    CHECK(t.manifold());
    CHECK(t.misoriented_edges == 0);
    CHECK(t.boundary_loops == 1);
    CHECK(t.euler == 1);
    CHECK(std::ranges::count(mesh.positions, Vec3(2, 0, 0)) == 1);
    CHECK(std::ranges::count(mesh.positions, Vec3(2, 1, 0)) == 0);
}

} // namespace

TEST_CASE("a quad with a corner straight on a crease gives way to those around") {
    Fold fold;
    CHECK(collapse_flat_corners(0.1, fold.classes, fold.mesh) == 1);
    check_collapsed(fold.mesh);
}

TEST_CASE("two triangles whose edge ends straight on a crease give way to the quads around") {
    Fold fold;
    fold.cut();
    CHECK(collapse_flat_corners(0.1, fold.classes, fold.mesh) == 1);
    check_collapsed(fold.mesh);
}

TEST_CASE("vertices of creases and of bent ground stay") {
    Fold creased;
    creased.classes[11] = VertexClass::edge;
    CHECK(collapse_flat_corners(0.1, creased.classes, creased.mesh) == 0);
    Fold bent;
    bent.mesh.positions[11] += Vec3(0, 0, 0.3);
    CHECK(collapse_flat_corners(0.1, bent.classes, bent.mesh) == 0);
    Fold bordered; // the ground ends at that vertex
    bordered.mesh.corners.erase(bordered.mesh.corners.end() - 12, bordered.mesh.corners.end() - 4);
    bordered.mesh.first.resize(bordered.mesh.first.size() - 2);
    CHECK(collapse_flat_corners(0.1, bordered.classes, bordered.mesh) == 0);
    Fold smooth;
    smooth.classes.assign(smooth.classes.size(), VertexClass::smooth);
    CHECK(collapse_flat_corners(0.1, smooth.classes, smooth.mesh) == 0);
}
