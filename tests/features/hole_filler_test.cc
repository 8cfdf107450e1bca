#include "features/meshes.hh"
#include "hsdm/errors.hh"
#include "hsdm/features/HoleFillerT.hh"

#include <catch2/catch.hpp>

using namespace hsdm;
using namespace hsdm::test;

namespace {

template <class Mesh>
std::size_t boundary_edges(const Mesh& mesh) {
    return static_cast<std::size_t>(
        std::count_if(mesh.edges_begin(), mesh.edges_end(), [](const auto& e) { return e.is_boundary(); }));
}

} // namespace

#define EVERY_KIND_OF_MESH PolyMeshF, PolyMeshD, TriMeshF, TriMeshD

TEMPLATE_TEST_CASE("a hole is closed, and what was there stays as it was", "", EVERY_KIND_OF_MESH) {
    auto mesh = build<TestType>(support::divided_cube(4));
    OpenMesh::FPropHandleT<int> mine;
    mesh.add_property(mine, "mine");
    for (const auto f : mesh.faces()) mesh.property(mine, f) = f.idx();
    const std::vector<OpenMesh::FaceHandle> around(mesh.cvf_begin(mesh.vertex_handle(40)),
                                                   mesh.cvf_end(mesh.vertex_handle(40)));
    for (const auto f : around) mesh.delete_face(f, false);
    mesh.garbage_collection();
    const std::size_t faces = mesh.n_faces();
    const std::size_t open = boundary_edges(mesh);
    REQUIRE(open > 3);
    std::vector<int> kept;
    for (const auto f : mesh.faces()) kept.push_back(mesh.property(mine, f));

    HoleFillerT<TestType> filler(mesh);
    filler.initialize({.max_edges = FillHolesOptions::no_limit});
    const FillHolesCounts counts = filler.fill();

    CHECK(counts.loops == 1);
    CHECK(counts.closed == 1);
    CHECK(boundary_edges(mesh) == 0);
    CHECK(mesh.n_faces() == faces + counts.facets);
    for (std::size_t f = 0; f < faces; ++f)
        CHECK(mesh.property(mine, mesh.face_handle(static_cast<unsigned>(f))) == kept[f]);
    const long euler = long(mesh.n_vertices()) - long(mesh.n_edges()) + long(mesh.n_faces());
    CHECK(euler
              - 1
                    * long(std::count_if(mesh.vertices_begin(), mesh.vertices_end(),
                                         [&](const auto& v) { return mesh.is_isolated(v); }))
          == 2);
}

TEST_CASE("holes beyond the limits stay open") {
    auto mesh = build<PolyMeshD>(sheet(6, [](Index, Index) { return 0.0; }));
    HoleFillerT<PolyMeshD> filler(mesh);
    filler.initialize({.max_edges = 8});
    CHECK(filler.fill().closed == 0);
    filler.initialize({.max_edges = 100, .max_diameter = 1});
    CHECK(filler.fill().closed == 0);
    CHECK(boundary_edges(mesh) == 24);
}

TEST_CASE("options out of range, and no initialize(), are told") {
    auto mesh = build<PolyMeshD>(support::unit_cube());
    HoleFillerT<PolyMeshD> filler(mesh);
    CHECK_THROWS_AS(filler.fill(), std::logic_error);
    CHECK_THROWS_AS(filler.initialize({.max_edges = 2}), OptionError);
    CHECK_THROWS_AS(filler.initialize({.max_diameter = 0}), OptionError);
    CHECK_THROWS_AS(filler.initialize({.max_bend = 4}), OptionError);
}
