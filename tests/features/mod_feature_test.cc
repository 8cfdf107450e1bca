#include "features/meshes.hh"
#include "hsdm/errors.hh"
#include "hsdm/features/FeatureClassifierT.hh"
#include "hsdm/features/ModFeatureT.hh"

#include <OpenMesh/Tools/Decimater/DecimaterT.hh>
#include <OpenMesh/Tools/Decimater/ModQuadricT.hh>

#include <catch2/catch.hpp>

using namespace hsdm;
using namespace hsdm::test;

namespace {

/// Half of its triangles go at a time, as stock decimation has it but for ModFeatureT.
template <class Mesh>
void decimate_to(Mesh& mesh, std::size_t facets) {
    OpenMesh::Decimater::DecimaterT<Mesh> decimater(mesh);
    typename OpenMesh::Decimater::ModQuadricT<Mesh>::Handle quadrics;
    typename ModFeatureT<Mesh>::Handle features;
    decimater.add(quadrics);
    decimater.add(features);
    decimater.initialize();
    decimater.decimate_to_faces(0, facets);
    mesh.garbage_collection();
}

struct Creases {
    double marked_length = 0;
    std::size_t unmarked_sharp = 0, corners = 0;
};

template <class Mesh>
Creases creases_of(Mesh& mesh) {
    Creases found;
    for (const auto e : mesh.edges()) {
        if (mesh.status(e).feature())
            found.marked_length += static_cast<double>(mesh.calc_edge_length(e));
        else if (!e.is_boundary() && std::abs(mesh.calc_dihedral_angle(e)) > 0.62)
            ++found.unmarked_sharp;
    }
    for (const auto v : mesh.vertices()) {
        std::size_t marked = 0;
        for (const auto e : v.edges()) marked += mesh.status(e).feature();
        found.corners += marked >= 3;
    }
    return found;
}

template <class Mesh>
Mesh classified(const PolygonMesh& shape) {
    Mesh mesh = build<Mesh>(shape);
    FeatureClassifierT<Mesh> classifier(mesh);
    classifier.initialize();
    classifier.classify();
    return mesh;
}

} // namespace

TEMPLATE_TEST_CASE("a cube comes down to its twelve triangles and keeps its edges and corners", "", TriMeshF,
                   TriMeshD) {
    auto mesh = classified<TestType>(support::divided_cube(12));
    decimate_to(mesh, 12);
    CHECK(mesh.n_faces()
          <= (std::is_same_v<typename TestType::Scalar, float> ? 16 : 12)); // floats are not flat
    const Creases creases = creases_of(mesh);
    CHECK(creases.marked_length == Approx(24));
    CHECK(creases.unmarked_sharp == 0);
    CHECK(creases.corners == 8);
}

TEST_CASE("a cylinder's rims stay marked, closed and nearly as long at a tenth of its triangles",
          "[features][slow]") {
    auto mesh = classified<TriMeshD>(capped_cylinder(96, 40));
    const Creases before = creases_of(mesh);
    decimate_to(mesh, mesh.n_faces() / 10);
    const Creases after = creases_of(mesh);
    CHECK(after.marked_length > 0.98 * before.marked_length);
    CHECK(after.unmarked_sharp == 0);
    for (const auto v : mesh.vertices()) {
        int marked = 0;
        for (const auto e : v.edges()) marked += mesh.status(e).feature();
        CHECK((marked == 0 || marked == 2));
    }
}

TEST_CASE("a crease that ends in the surface keeps its end, and a boundary its corners") {
    auto mesh = build<TriMeshD>(sheet(8, [](Index x, Index y) { return x == 4 && y < 4 ? 1.0 : 0.0; }));
    const auto ridge = mesh.find_halfedge(mesh.vertex_handle(4 + 9), mesh.vertex_handle(4 + 18));
    REQUIRE(ridge.is_valid());
    mesh.status(mesh.edge_handle(ridge)).set_feature(true);
    const std::vector<TriMeshD::Point> kept{mesh.point(mesh.from_vertex_handle(ridge)),
                                            mesh.point(mesh.to_vertex_handle(ridge)),
                                            {0, 0, 0},
                                            {8, 8, 0}};
    decimate_to(mesh, 1);
    for (const auto& p : kept)
        CHECK(std::any_of(mesh.vertices_begin(), mesh.vertices_end(),
                          [&](const auto& v) { return mesh.point(v) == p; }));
    CHECK(creases_of(mesh).marked_length == 1);
}

TEST_CASE("a vertex of the class corner stays, whatever its edges") {
    auto mesh = build<TriMeshD>(sheet(6, [](Index, Index) { return 0.0; }));
    auto classes = kept_vertex_property<std::uint8_t>(mesh, vertex_class_property);
    for (const auto v : mesh.vertices()) classes[v] = 0;
    const auto centre = mesh.vertex_handle(24);
    classes[centre] = static_cast<std::uint8_t>(VertexClass::corner);
    const auto place = mesh.point(centre);
    decimate_to(mesh, 1);
    CHECK(mesh.n_faces() < 10);
    CHECK(std::any_of(mesh.vertices_begin(), mesh.vertices_end(),
                      [&](const auto& v) { return mesh.point(v) == place; }));
}

TEST_CASE("angles out of range are refused") {
    TriMeshD mesh = build<TriMeshD>(support::tetrahedron());
    ModFeatureT<TriMeshD> module(mesh);
    CHECK_THROWS_AS(module.set_options({.crease_angle = 0}), OptionError);
    CHECK_THROWS_AS(module.set_options({.corner_angle = 4}), OptionError);
}
