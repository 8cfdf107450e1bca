#include "hsdm/completion/completion_field.hh"
#include "hsdm/core/chunks.hh"
#include "hsdm/mesh/fill_holes.hh"
#include "hsdm/mesh/remove_facets.hh"
#include "support/meshes.hh"

#include <catch2/catch.hpp>

#include <cmath>

using namespace hsdm;

namespace {

Lattice whole_lattice(const PolygonMesh& mesh) {
    const LatticePlace place{Vec3(-1.31, -1.33, -1.37), 0.17, {16, 16, 16}};
    std::vector<MortonCode> codes{morton_encode(VoxelCoord{8, 8, 8})};
    dilate(place, 16, codes);
    return build_lattice(place, std::move(codes), mesh);
}

/// The sphere without its cap above a height.
PolygonMesh open_sphere(double height) {
    PolygonMesh mesh = support::divided_sphere(24);
    remove_facets(mesh, [&](std::size_t f) {
        return std::ranges::any_of(mesh.facet(f), [&](Index v) { return mesh.positions[v][2] > height; });
    });
    return mesh;
}

} // namespace

TEST_CASE("codes grow to all within a box, inside the lattice, each once", "[completion]") {
    const LatticePlace place{Vec3(0, 0, 0), 1, {9, 9, 9}};
    std::vector<MortonCode> codes{morton_encode(VoxelCoord{1, 5, 9}), morton_encode(VoxelCoord{1, 5, 9})};
    dilate(place, 2, codes);
    CHECK(codes.size() == 4 * 5 * 3);
    CHECK(std::is_sorted(codes.begin(), codes.end()));
    for (const MortonCode code : codes) CHECK(place.holds(morton_decode(code)));
}

TEST_CASE("a closed mesh is passed on every edge between inside and outside, and on no other",
          "[completion]") {
    const PolygonMesh mesh = support::divided_sphere(24);
    const Lattice lattice = whole_lattice(mesh);
    REQUIRE(lattice.size() == 17 * 17 * 17);
    const auto inside = [&](Index i) { return lattice.place.position(lattice.coord(i)).norm() < 0.99; };
    const auto outside = [&](Index i) { return lattice.place.position(lattice.coord(i)).norm() > 1; };
    std::size_t passed = 0;
    for (Index i = 0; i < lattice.size(); ++i)
        for (unsigned axis = 0; axis < 3; ++axis) {
            const Index next = lattice.next[i][axis];
            if (next == no_index) continue;
            CHECK(lattice.next[next][axis + 3] == i);
            const auto hits = lattice.on_edge(3 * std::size_t{i} + axis);
            for (const LatticeHit& hit : hits) {
                Vec3 at = lattice.place.position(lattice.coord(i));
                at[axis] += hit.t * lattice.place.spacing;
                CHECK(std::abs(at.norm() - 1) < 0.01);
                CHECK((hit.normal | at) > 0.99);
            }
            if ((inside(i) && outside(next)) || (outside(i) && inside(next))) {
                ++passed;
                CHECK(hits.size() % 2 == 1);
            }
            if (inside(i) && inside(next)) CHECK(hits.empty());
        }
    CHECK(passed > 400);
}

TEST_CASE("the field is negative inside and positive outside, also behind a hole", "[completion]") {
    const PolygonMesh mesh = open_sphere(0.8);
    const CompletionField field = completion_field(mesh, boundary_loops(mesh), 0.05);
    REQUIRE(field.value.size() == field.lattice.size());
    for (std::size_t i = 0; i < field.value.size(); ++i) {
        const Vec3 p = field.lattice.place.position(field.lattice.coord(static_cast<Index>(i)));
        INFO(p[0] << " " << p[1] << " " << p[2]);
        if (p.norm() < 0.9 && p[2] < 0.75) CHECK(field.value[i] < 0);
        if (p.norm() > 1.1) CHECK(field.value[i] > 0);
    }
    std::size_t open = 0;
    for (std::size_t e = 0; e < 3 * field.lattice.size(); ++e) open += field.is_open(e);
    CHECK(open > 300); // the cap is some 24 cells across
}
