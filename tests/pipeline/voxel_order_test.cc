#include "hsdm/pipeline/voxel_order.hh"

#include "support/meshes.hh"

#include <catch2/catch.hpp>

using namespace hsdm;
using namespace hsdm::support;

namespace {

/// Orders a mesh whose vertices stand for voxels in an order of their own.
PolygonMesh in_order_of_voxels(PolygonMesh mesh, FacetKnowledge& known) {
    const std::size_t n = mesh.vertex_count();
    std::vector<Index> voxel;
    for (std::size_t v = 0; v < n; ++v) voxel.push_back(static_cast<Index>(v * 7919 % n));
    known.links = link_facets(mesh);
    order_by_voxels(n, voxel, mesh, known);
    return mesh;
}

void check_links(const PolygonMesh& mesh) {
    FacetKnowledge known;
    const PolygonMesh ordered = in_order_of_voxels(mesh, known);
    const FacetLinks anew = link_facets(ordered);
    REQUIRE(known.links);
    CHECK(known.links->accepted == anew.accepted);
    CHECK(known.links->facet == anew.facet);
    CHECK(known.links->twin == anew.twin);
    CHECK(known.links->vertex == anew.vertex);
    CHECK(known.links->source == anew.source);
    CHECK(known.links->side_out == anew.side_out);
    CHECK(known.links->open_in == anew.open_in);
}

TEST_CASE("links of a mesh in the order of voxels are those that are found anew", "[pipeline]") {
    SECTION("closed") {
        check_links(divided_cube(5));
    }
    SECTION("closed, of triangles too") {
        check_links(cut_in_two(divided_sphere(4)));
    }
    SECTION("with borders") {
        check_links(round_tube(9, 6, 1, 0.5));
    }
    SECTION("with a vertex of no facet") {
        PolygonMesh mesh = round_tube(8, 5, 1, 0.5);
        mesh.positions.insert(mesh.positions.begin(), Vec3(9, 9, 9));
        for (Index& v : mesh.corners) ++v;
        check_links(mesh);
    }
}

} // namespace
