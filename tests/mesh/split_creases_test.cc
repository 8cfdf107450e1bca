#include "hsdm/mesh/split_creases.hh"

#include <catch2/catch.hpp>

#include <algorithm>
#include <map>

using namespace hsdm;

namespace {

/// A cube of quads with vertex normals along its diagonals.
PolygonMesh smooth_cube() {
    PolygonMesh mesh;
    for (int i = 0; i < 8; ++i) {
        mesh.positions.push_back(Vec3(i & 1, i >> 1 & 1, i >> 2));
        mesh.normals.push_back((mesh.positions.back() - Vec3(0.5, 0.5, 0.5)).normalized());
    }
    for (const std::array<Index, 4>& quad : {std::array<Index, 4>{0, 2, 3, 1},
                                             {4, 5, 7, 6},
                                             {0, 1, 5, 4},
                                             {2, 6, 7, 3},
                                             {0, 4, 6, 2},
                                             {1, 3, 7, 5}})
        mesh.add_facet(quad);
    mesh.properties.push_back({"weight", VertexProperty::Type::float64, {0, 1, 2, 3, 4, 5, 6, 7}});
    return mesh;
}

void mark_all_edges(PolygonMesh& mesh) {
    for (std::size_t f = 0; f < mesh.facet_count(); ++f) {
        const auto facet = mesh.facet(f);
        for (std::size_t i = 0; i < facet.size(); ++i)
            if (const Index from = facet[i], to = facet[(i + 1) % facet.size()]; from < to)
                mesh.sharp_edges.push_back({from, to});
    }
}

} // namespace

TEST_CASE("a cube of sharp edges has a vertex and a normal for each corner of its facets", "[mesh]") {
    PolygonMesh cube = smooth_cube();
    mark_all_edges(cube);
    const PolygonMesh split = split_creases(cube);
    REQUIRE(split.vertex_count() == 24);
    REQUIRE(split.facet_count() == 6);
    for (std::size_t f = 0; f < 6; ++f) {
        const auto facet = split.facet(f);
        const Vec3 across = (split.positions[facet[1]] - split.positions[facet[0]])
                            % (split.positions[facet[2]] - split.positions[facet[1]]);
        for (std::size_t i = 0; i < 4; ++i) {
            CHECK((split.normals[facet[i]] - across).norm() < 1e-12);
            CHECK(split.positions[facet[i]] == cube.positions[cube.facet(f)[i]]);
            CHECK(split.origin[facet[i]] == cube.facet(f)[i]);
            CHECK(split.properties[0].values[facet[i]] == cube.facet(f)[i]);
        }
    }
    CHECK(std::is_sorted(split.origin.begin(), split.origin.end()));
}

TEST_CASE("vertices that no sharp edge parts stay whole and keep their normals", "[mesh]") {
    PolygonMesh cube = smooth_cube();
    const PolygonMesh whole = split_creases(cube);
    CHECK(whole.vertex_count() == 8);
    CHECK((whole.normals == cube.normals));
    CHECK((whole.corners == cube.corners));
    cube.sharp_edges = {{0, 1}}; // ends in smooth vertices: parts nothing
    CHECK(split_creases(cube).vertex_count() == 8);
    cube.sharp_edges = {{4, 5}, {5, 7}, {6, 7}, {4, 6}}; // the rim of the top
    const PolygonMesh lid = split_creases(cube);
    CHECK(lid.vertex_count() == 12);
    CHECK(std::ranges::count(lid.normals, Vec3(0, 0, 1)) == 4);
    CHECK(std::ranges::count(lid.normals, cube.normals[0]) == 1);
}

TEST_CASE("on a crease the normal of the mesh's own that is nearest to a side's facets is that side's",
          "[mesh]") {
    PolygonMesh cube = smooth_cube();
    cube.sharp_edges = {{4, 5}, {5, 7}, {6, 7}, {4, 6}};
    const Vec3 tilted = Vec3(0.1, 0, 1).normalized();
    for (std::size_t i = 0; i < 9; ++i) {
        const Vec3 own = i / 3 == 0 ? Vec3(0, 0, -1) : i / 3 == 1 ? tilted : Vec3(0, 0, 0);
        cube.properties.push_back({"hsdm_normals_" + std::to_string(i / 3) + '_' + "xyz"[i % 3],
                                   VertexProperty::Type::float64, std::vector<double>(8, own[i % 3])});
    }
    const PolygonMesh lid = split_creases(cube);
    CHECK(std::ranges::count_if(lid.normals, [&](const Vec3& n) { return (n - tilted).norm() < 1e-12; })
          == 4);
}

TEST_CASE("a mesh without normals is not split, and loses its isolated vertices", "[mesh]") {
    PolygonMesh cube = smooth_cube();
    mark_all_edges(cube);
    cube.normals.clear();
    cube.positions.insert(cube.positions.begin() + 8, Vec3(9, 9, 9));
    cube.properties[0].values.push_back(8);
    const PolygonMesh whole = split_creases(cube);
    CHECK(whole.vertex_count() == 8);
    CHECK(whole.normals.empty());
    CHECK((whole.corners == cube.corners));
}
