// What parts of a mesh tell of the whole, against the whole itself.
#include "hsdm/contour/components_of_part.hh"
#include "hsdm/contour/tangles_of_part.hh"
#include "hsdm/mesh/part_of.hh"
#include "hsdm/spatial/self_intersections.hh"
#include "support/random.hh"

#include <catch2/catch.hpp>

#include <algorithm>
#include <map>
#include <memory>

using namespace hsdm;

namespace {

constexpr Index quads_along = 45, quads_across = 7; // of quads

/// Two sheets of unit quads one above the other; vertices column by column.
PolygonMesh two_sheets() {
    PolygonMesh mesh;
    for (Index i = 0; i <= quads_along; ++i)
        for (Index k = 0; k <= quads_across; ++k)
            for (const double z : {0.0, 0.4}) mesh.positions.emplace_back(i, k, z);
    const auto at = [](Index i, Index k, Index sheet) { return 2 * (i * (quads_across + 1) + k) + sheet; };
    for (Index i = 0; i < quads_along; ++i)
        for (Index k = 0; k < quads_across; ++k)
            for (const Index s : {0u, 1u})
                mesh.add_facet(
                    std::array{at(i, k, s), at(i + 1, k, s), at(i + 1, k + 1, s), at(i, k + 1, s)});
    return mesh;
}

/// Some vertices of the lower sheet stick through the upper one, so far that moving may end it or not.
PolygonMesh tangled_sheets(double highest, support::Random& random) {
    PolygonMesh mesh = two_sheets();
    for (Index i = 5; i + 10 < quads_along; i += 15) {
        const Index at = i + static_cast<Index>(random.below(6));
        const auto v = 2 * (at * (quads_across + 1) + 3);
        mesh.positions[v] +=
            highest * Vec3(random.uniform(-0.3, 0.3), random.uniform(-0.3, 0.3), random.uniform());
    }
    return mesh;
}

Index column_of(Index vertex) {
    return vertex / (2 * (quads_across + 1));
}

/// A part of the columns: those it owns, and facets up to so many columns farther.
struct Stretch {
    Index begin, end;
    static constexpr Index known = 12;
    PartVoxels voxels;
    PolygonMesh mesh;           // of all vertices of the whole, so that numbers are those
    std::vector<Index> columns; // per vertex

    Stretch(const PolygonMesh& whole, Index first, Index last) : begin(first), end(last) {
        for (Index v = 0; v < whole.vertex_count(); ++v) columns.push_back(column_of(v));
        voxels.owns = [this](Index column) { return column >= begin && column < end; };
        voxels.is_near = [this](Index column) {
            return column + known / 2 >= begin && column < end + known / 2;
        };
        mesh.positions = whole.positions;
        for (std::size_t f = 0; f < whole.facet_count(); ++f)
            if (std::ranges::all_of(whole.facet(f), [&](Index v) {
                    return column_of(v) + known >= begin && column_of(v) < end + known;
                }))
                mesh.add_facet(whole.facet(f));
    }
    Stretch(const Stretch&) = delete;
    Stretch& operator=(const Stretch&) = delete;

    MeshOfPart made(const PolygonMesh& of) const {
        return {of, [this](Index v) { return columns[v]; }, voxels};
    }
};

using Ring = std::vector<std::array<double, 3>>;

/// Facets whose least column is one of these, by positions, in their order.
std::vector<Ring> facets_between(const PolygonMesh& mesh, Index begin, Index end) {
    std::vector<Ring> rings;
    for (std::size_t f = 0; f < mesh.facet_count(); ++f) {
        const Index least = column_of(std::ranges::min(mesh.facet(f)));
        if (least < begin || least >= end) continue;
        Ring ring;
        for (const Index v : mesh.facet(f))
            ring.push_back({mesh.positions[v][0], mesh.positions[v][1], mesh.positions[v][2]});
        rings.push_back(std::move(ring));
    }
    std::ranges::sort(rings);
    return rings;
}

constexpr UntangleOptions untangling_here{.reach = 0.5, .nearby = 1};

/// What the parts come to once their sums have been weighed as often as it takes.
TanglePlan untangle_parts(const std::vector<std::unique_ptr<Stretch>>& parts,
                          std::vector<PolygonMesh>& meshes) {
    TanglePlan plan;
    for (bool again = true; again;) {
        TangleCounts sums;
        meshes.clear();
        for (const auto& part : parts) {
            PolygonMesh mesh = copy_of(part->mesh);
            bool moved = false;
            sums += untangle_part(mesh, part->made(mesh), untangling_here, plan, FacetCells(mesh, 1), moved);
            meshes.push_back(std::move(mesh));
        }
        again = plan.weigh(sums);
    }
    return plan;
}

} // namespace

TEST_CASE("parts of a tangled mesh are untangled as the whole is", "[untangle]") {
    support::Random random(5);
    std::size_t mended = 0, apart = 0;
    for (int turn = 0; turn < 4; ++turn) {
        PolygonMesh whole = tangled_sheets(turn % 2 == 0 ? 0.8 : 3, random);
        std::vector<std::unique_ptr<Stretch>> parts;
        const auto cut = static_cast<Index>(10 + random.below(15)), other = static_cast<Index>(cut + 10);
        for (const auto& [begin, end] :
             {std::pair<Index, Index>{0, cut}, {cut, other}, {other, quads_along + 1}})
            parts.push_back(std::make_unique<Stretch>(whole, begin, end));
        std::vector<PolygonMesh> meshes;
        const TanglePlan plan = untangle_parts(parts, meshes);
        if (untangle(whole, untangling_here).after > 0) mend_tangles(whole, untangling_here.nearby);
        for (std::size_t k = 0; k < parts.size(); ++k)
            CHECK(facets_between(meshes[k], parts[k]->begin, parts[k]->end)
                  == facets_between(whole, parts[k]->begin, parts[k]->end));
        (plan.weighed ? mended : apart) += 1;
        std::uint64_t left = 0;
        for (std::size_t k = 0; k < parts.size(); ++k)
            left += own_intersections(parts[k]->made(meshes[k])).count;
        CHECK(left == find_self_intersections(whole).triangle_pairs);
    }
    CHECK(mended > 0);
    CHECK(apart > 0);
}

TEST_CASE("what is done about intersections follows from sums", "[untangle]") {
    TangleCounts sums;
    sums.triangles = {9, 4, 2, 3, 2, 5, 6};
    sums.facets = {9, 4, 2, 3, 2, 5, 6};
    TanglePlan plan;
    CHECK(plan.weigh(sums));
    CHECK(plan.rounds == 2); // the first of the fewest
    CHECK(plan.mends);
    CHECK(plan.replaces);
    CHECK(plan.weigh(sums)); // nothing came of it
    CHECK_FALSE(plan.replaces);
    CHECK_FALSE(plan.weigh(sums));

    sums.triangles[5] = 0;
    TanglePlan none;
    CHECK_FALSE(none.weigh(sums));
    CHECK_FALSE(none.weighed);

    sums.triangles = {900, 800, 700, 600, 500, 400, 300};
    sums.facets.fill(untangling::most_pairs + 1);
    TanglePlan many; // moved as it is already, but what is left has not been counted
    CHECK(many.weigh(sums));
    CHECK(many.rounds == untangling::rounds);
    CHECK_FALSE(many.mends);
    CHECK_FALSE(many.weigh(sums));
}

TEST_CASE("the largest component is known from parts, whatever their number", "[mesh]") {
    support::Random random(7);
    for (int turn = 0; turn < 20; ++turn) {
        const PolygonMesh sheets = two_sheets();
        PolygonMesh whole;
        whole.positions = sheets.positions;
        const double share = random.uniform(0.3, 1);
        for (std::size_t f = 0; f < sheets.facet_count(); ++f)
            if (random.uniform() < share) whole.add_facet(sheets.facet(f));
        std::map<Index, std::size_t> sizes; // by walking from facet to facet
        std::vector<Index> of(whole.vertex_count());
        for (Index v = 0; v < of.size(); ++v) of[v] = v;
        for (bool any = true; any;) {
            any = false;
            for (std::size_t f = 0; f < whole.facet_count(); ++f) {
                Index least = no_index;
                for (const Index v : whole.facet(f)) least = std::min(least, of[v]);
                for (const Index v : whole.facet(f)) any |= std::exchange(of[v], least) != least;
            }
        }
        std::size_t expected = 0;
        for (std::size_t f = 0; f < whole.facet_count(); ++f)
            expected = std::max(expected, ++sizes[of[whole.facet(f)[0]]]);
        std::vector<std::unique_ptr<Stretch>> parts;
        for (Index begin = 0; begin <= quads_along;) {
            const auto end = static_cast<Index>(begin + 1 + random.below(20));
            parts.push_back(std::make_unique<Stretch>(whole, begin, std::min<Index>(end, quads_along + 1)));
            begin = end;
        }
        std::vector<PartComponents> told;
        for (const auto& part : parts)
            told.push_back(components_of_part(part->made(part->mesh), 10000,
                                              [](Index column) { return std::uint64_t{column}; }));
        CHECK(largest_component(told, 10000) == expected);
        CHECK(largest_component(told, 20) == std::min<std::size_t>(expected, 20));
    }
}
