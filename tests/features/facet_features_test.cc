#include "hsdm/features/facet_features.hh"
#include "hsdm/features/features.hh"
#include "hsdm/mesh/to_mesh.hh"
#include "hsdm/mesh/vertex_normals.hh"
#include "hsdm/quality/topology.hh"
#include "hsdm/reconstruct.hh"
#include "support/meshes.hh"
#include "support/sample.hh"

#include <catch2/catch.hpp>

using namespace hsdm;

namespace {

/// A part with creases, corners and a crease that ends; with a border where it is cut off.
PolygonMesh part(bool open) {
    PointCloud cloud =
        support::sample(support::box({1, 0.7, 0.4}) - support::cylinder(0.15, 2), {.points = 12000});
    if (open) {
        PointCloud rest;
        for (std::size_t i = 0; i < cloud.positions.size(); ++i) {
            if (cloud.positions[i][0] > 0.3) continue;
            rest.positions.push_back(cloud.positions[i]);
            rest.normals.push_back(cloud.normals[i]);
        }
        cloud = std::move(rest);
    }
    PolygonMesh mesh = to_polygons(reconstruct(cloud, {.depth = 5}).mesh);
    mesh.properties.clear(), mesh.normals.clear(), mesh.sharp_edges.clear();
    return mesh;
}

/// Every seventh edge is known to be sharp, every fifth smooth.
FeatureHints some_hints(const PolygonMesh& mesh, const FacetLinks& links) {
    FeatureHints hints;
    hints.sides.assign(mesh.corners.size(), EdgeHint::none);
    for (Index c = 0; c < mesh.corners.size(); ++c) {
        const Index edge = links.twin[c] == no_index ? c : std::min(c, links.twin[c]);
        if (edge % 7 == 0) hints.sides[c] = EdgeHint::sharp;
        if (edge % 5 == 0) hints.sides[c] = EdgeHint::smooth;
    }
    return hints;
}

} // namespace

TEST_CASE("features of facets are those of their half-edge mesh, bit for bit", "[features]") {
    const PolygonMesh facets = part(GENERATE(false, true));
    const FacetLinks links = link_facets(facets);
    const FeatureHints hints = GENERATE(false, true) ? some_hints(facets, links) : FeatureHints();
    const NormalSmoothingOptions smoothing{.rounds = GENERATE(0, 3)};
    ToMeshResult built = to_mesh(facets);
    PolyMesh& mesh = built.mesh;
    const FeatureCounts counts = classify_features(mesh, {.write_normals = false}, hints);
    smooth_normals(mesh, smoothing);

    FacetFeatures found = find_facet_features(facets, links, FeatureHints(hints), {});
    FacetNormals of_facets = facet_normals(facets);
    smooth_facet_normals(of_facets, neighbours_of(facets, links, found.sharp), smoothing);
    found.normals = std::move(of_facets.normals);
    CHECK(found.counts == counts);
    CHECK(counts.corner_vertices > 0);
    const OpenMesh::VProp<std::uint8_t> classes(mesh, vertex_class_property),
        number(mesh, normal_count_property);
    const OpenMesh::VProp<VertexNormalsT<PolyMesh>> normals(mesh, vertex_normals_property);
    FacetFan fan(facets, links, found);
    std::size_t different = 0;
    for (const auto v : mesh.vertices()) {
        fan.gather(static_cast<Index>(v.idx()));
        Vec3 mean(0, 0, 0);
        const SectorNormals sectors = fan.normals(mean);
        different += classes[v] != static_cast<std::uint8_t>(fan.kind()) || number[v] != sectors.count
                     || normals[v] != sectors.normals || mesh.normal(v) != mean;
    }
    CHECK(different == 0);
}

TEST_CASE("connectivity by links is that by edges", "[topology]") {
    PolygonMesh mesh = part(GENERATE(false, true));
    SECTION("of a part") {}
    SECTION("of two triangles that share a corner") {
        mesh = PolygonMesh();
        mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, -1, 0}, {5, 5, 5}};
        mesh.add_facet(std::array<Index, 3>{0, 1, 2});
        mesh.add_facet(std::array<Index, 3>{0, 3, 4});
    }
    SECTION("of three triangles that share a corner") {
        mesh = PolygonMesh();
        mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, -1, 0}, {0, 0, 1}, {0, 1, 1}};
        mesh.add_facet(std::array<Index, 3>{0, 1, 2});
        mesh.add_facet(std::array<Index, 3>{0, 3, 4});
        mesh.add_facet(std::array<Index, 3>{0, 5, 6});
    }
    const Topology a = measure_connectivity(mesh), b = measure_connectivity(mesh, link_facets(mesh));
    CHECK(a.vertices == b.vertices);
    CHECK(a.isolated_vertices == b.isolated_vertices);
    CHECK(a.edges == b.edges);
    CHECK(a.triangles == b.triangles);
    CHECK(a.quads == b.quads);
    CHECK(a.larger == b.larger);
    CHECK(a.components == b.components);
    CHECK(a.boundary_edges == b.boundary_edges);
    CHECK(a.boundary_loops == b.boundary_loops);
    CHECK(a.euler == b.euler);
    CHECK(a.genus() == b.genus());
    CHECK(a.nonmanifold_vertices == b.nonmanifold_vertices);
}
