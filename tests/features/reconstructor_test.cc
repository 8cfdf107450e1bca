#include "features/meshes.hh"
#include "hsdm/ReconstructorT.hh"
#include "hsdm/errors.hh"
#include "hsdm/features/features.hh"
#include "hsdm/mesh/to_mesh.hh"

#include <catch2/catch.hpp>

#include <limits>

using namespace hsdm;
using namespace hsdm::test;
using OpenMesh::VertexHandle;

namespace {

/// Only vertices, as a scan is.
template <class Mesh>
void add_points(Mesh& mesh, const PolygonMesh& shape) {
    for (const Vec3& p : shape.positions) mesh.add_vertex(to_normal<typename Mesh::Point>(p));
}

} // namespace

#define EVERY_KIND_OF_MESH PolyMeshF, PolyMeshD, TriMeshF, TriMeshD

TEMPLATE_TEST_CASE("a mesh's vertices become a surface in the same mesh", "", EVERY_KIND_OF_MESH) {
    TestType mesh;
    mesh.request_vertex_status();
    mesh.request_edge_status();
    mesh.request_vertex_normals();
    OpenMesh::VPropHandleT<int> mine;
    mesh.add_property(mine, "mine");
    add_points(mesh, sphere(40));
    for (const auto v : mesh.vertices()) {
        mesh.property(mine, v) = 7;
        mesh.set_normal(v, to_normal<typename TestType::Normal>(
                               Vec3(mesh.point(v)[0], mesh.point(v)[1], mesh.point(v)[2])));
    }

    ReconstructorT<TestType> reconstructor(mesh);
    reconstructor.initialize({.depth = 3});
    const Report report = reconstructor.reconstruct();

    REQUIRE(mesh.n_faces() > 50);
    CHECK(report.input.points == sphere(40).vertex_count());
    CHECK(mesh.n_vertices() >= report.mesh.vertices);
    for (const auto v : mesh.vertices()) {
        CHECK(mesh.point(v).norm() == Approx(1).margin(0.3));
        CHECK((mesh.normal(v) | mesh.point(v)) > 0.5);
        CHECK(mesh.property(mine, v) == 0);
    }
    for (const auto f : mesh.faces())
        if (TestType::is_trimesh()) CHECK(mesh.valence(f) == 3);
    CHECK(OpenMesh::hasProperty<VertexHandle, std::uint8_t>(mesh, "hsdm_vertex_class"));
    CHECK(OpenMesh::hasProperty<VertexHandle, VertexNormalsT<TestType>>(mesh, "hsdm_normals"));
}

TEMPLATE_TEST_CASE("colours come out as means, and no attribute is left uninitialised", "", PolyMeshD,
                   TriMeshF) {
    using Color = typename TestType::Color;
    TestType mesh;
    mesh.request_vertex_colors();
    mesh.request_vertex_texcoords2D();
    mesh.request_halfedge_normals();
    mesh.request_halfedge_texcoords3D();
    mesh.request_edge_colors();
    mesh.request_face_colors();
    mesh.request_face_texture_index();
    add_points(mesh, sphere(40));
    for (const auto v : mesh.vertices()) {
        const bool upper = mesh.point(v)[2] > 0;
        mesh.set_color(v, detail::color_of<Color>({200, 10, std::uint8_t(upper ? 255 : 0), 255}));
        mesh.set_texcoord2D(v, {7, 7});
    }
    ReconstructorT<TestType> reconstructor(mesh);
    ReconstructOptions options;
    options.depth = 3;
    reconstructor.initialize(options);
    reconstructor.reconstruct();
    REQUIRE(mesh.n_faces() > 50);
    for (const auto v : mesh.vertices()) {
        const auto color = detail::color_bytes(mesh.color(v));
        CHECK(color[0] == 200);
        CHECK(color[1] == 10);
        if (mesh.point(v)[2] > 0.3) CHECK(color[2] == 255);
        if (mesh.point(v)[2] < -0.3) CHECK(color[2] == 0);
        CHECK(mesh.texcoord2D(v) == typename TestType::TexCoord2D(0, 0));
    }
    for (const auto h : mesh.halfedges()) {
        CHECK(mesh.normal(h) == typename TestType::Normal(0, 0, 0));
        CHECK(mesh.texcoord3D(h) == typename TestType::TexCoord3D(0, 0, 0));
    }
    for (const auto e : mesh.edges()) CHECK(mesh.color(e) == detail::zero<Color>());
    for (const auto f : mesh.faces()) CHECK(mesh.color(f) == detail::zero<Color>());
    for (const auto f : mesh.faces()) CHECK(mesh.texture_index(f) == 0);
}

namespace {

struct FractionTraits : OpenMesh::DefaultTraits {
    using Color = OpenMesh::Vec4f;
};
using FractionMesh = OpenMesh::TriMesh_ArrayKernelT<FractionTraits>;
struct WholeTraits : OpenMesh::DefaultTraitsDouble {
    using Color = OpenMesh::Vec4i; // read nowhere but in a copy
};
using WholeMesh = OpenMesh::TriMesh_ArrayKernelT<WholeTraits>;

/// A scan with normals and colours; with_deleted: in which every third vertex is one deleted.
template <class Mesh>
Mesh scanned(bool with_deleted) {
    Mesh mesh;
    mesh.request_vertex_status();
    mesh.request_vertex_normals();
    mesh.request_vertex_colors();
    for (const Vec3& p : sphere(30).positions) {
        if (with_deleted && mesh.n_vertices() % 3 == 0) {
            const auto gone = mesh.add_vertex(typename Mesh::Point(9, 9, 9));
            mesh.set_normal(gone, typename Mesh::Normal(1, 0, 0));
            mesh.set_color(gone, detail::color_of<typename Mesh::Color>({1, 2, 3, 4}));
            mesh.status(gone).set_deleted(true);
        }
        const auto v = mesh.add_vertex(to_normal<typename Mesh::Point>(p));
        mesh.set_normal(v, to_normal<typename Mesh::Normal>(p));
        const std::uint8_t green = p[2] > 0 ? 250 : 50;
        mesh.set_color(v, detail::color_of<typename Mesh::Color>({100, green, 0, 200}));
    }
    return mesh;
}

template <class Mesh>
Report surface_of(Mesh& mesh) {
    ReconstructorT<Mesh> reconstructor(mesh);
    ReconstructOptions options;
    options.depth = 3;
    reconstructor.initialize(options);
    return reconstructor.reconstruct();
}

} // namespace

TEMPLATE_TEST_CASE("points are read where the mesh keeps them, and without those deleted", "", TriMeshF,
                   FractionMesh, WholeMesh) {
    PointCloud same; // what the library would be given in a copy
    TestType mesh = scanned<TestType>(false);
    for (const auto v : mesh.vertices()) {
        same.positions.push_back(to_vec3(mesh.point(v)));
        same.normals.push_back(to_vec3(mesh.normal(v)));
        same.colors.push_back(detail::color_bytes(mesh.color(v)));
    }
    const Reconstruction expected = hsdm::reconstruct(same, {.depth = 3});
    for (const bool with_deleted : {false, true}) {
        mesh = scanned<TestType>(with_deleted);
        const Report report = surface_of(mesh);
        CHECK(report.input.points == same.size());
        CHECK(report.rejected == expected.report.rejected);
        REQUIRE(mesh.n_vertices() == expected.mesh.n_vertices());
        std::size_t others = 0;
        for (const auto v : mesh.vertices())
            others += mesh.point(v) != to_normal<typename TestType::Point>(expected.mesh.point(v));
        CHECK(others == 0);
        std::size_t greens = 0;
        for (const auto v : mesh.vertices()) greens += detail::color_bytes(mesh.color(v))[1] == 250;
        CHECK(greens > 20);
        CHECK(greens < mesh.n_vertices() - 20);
    }
}

TEST_CASE("colours of any kind are read and set", "") {
    using detail::color_bytes, detail::color_of;
    CHECK(color_bytes(OpenMesh::Vec3f(0, 0.5f, 1)) == std::array<std::uint8_t, 4>{0, 128, 255, 255});
    CHECK(color_bytes(OpenMesh::Vec4d(2, -1, 0.2, 0)) == std::array<std::uint8_t, 4>{255, 0, 51, 0});
    const double none = std::numeric_limits<double>::quiet_NaN();
    CHECK(color_bytes(OpenMesh::Vec3d(none, 1, none)) == std::array<std::uint8_t, 4>{0, 255, 0, 255});
    CHECK(color_bytes(OpenMesh::Vec4uc(1, 2, 3, 4)) == std::array<std::uint8_t, 4>{1, 2, 3, 4});
    CHECK(color_of<OpenMesh::Vec3f>({0, 51, 255, 7}) == OpenMesh::Vec3f(0, 0.2f, 1));
    CHECK(color_of<OpenMesh::Vec4uc>({1, 2, 3, 4}) == OpenMesh::Vec4uc(1, 2, 3, 4));
}

TEST_CASE("reconstructing before initialize throws, and a failure leaves the mesh as it was") {
    TriMeshF mesh = build<TriMeshF>(support::divided_cube(1));
    ReconstructorT<TriMeshF> reconstructor(mesh);
    CHECK_THROWS_AS(reconstructor.reconstruct(), std::logic_error);
    reconstructor.initialize({.depth = 40});
    CHECK_THROWS_AS(reconstructor.reconstruct(), OptionError);
    CHECK(mesh.n_vertices() == 8);
    CHECK(mesh.n_faces() == 12);
}
