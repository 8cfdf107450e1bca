#include "hsdm/mesh/area_vector.hh"
#include "hsdm/simplify/planar_patches.hh"
#include "simplify/grids.hh"
#include "support/meshes.hh"

#include <catch2/catch.hpp>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

using namespace hsdm;
using support::arc;
using support::grid;

namespace {

std::size_t patches_in(const PlanarPatches& patches) {
    std::set<Index> seen(patches.patch.begin(), patches.patch.end());
    seen.erase(no_index);
    return seen.size();
}

double farthest(const PolygonMesh& mesh, const PlanarPatches& patches) {
    double most = 0;
    for (std::size_t f = 0; f < mesh.facet_count(); ++f) {
        if (patches.patch[f] == no_index) continue;
        Vec3 centre(0, 0, 0);
        for (Index v : mesh.facet(f)) centre += mesh.positions[v];
        most = std::max(most, std::abs(patches.planes[patches.patch[f]].height(centre * 0.25)));
    }
    return most;
}

} // namespace

TEST_CASE("a cylinder and a cone are cut to strips of even width along their rulings", "[simplify]") {
    for (const double narrowing : {0.0, 0.5}) {
        INFO("narrowing " << narrowing);
        const double angle = 1.8, tolerance = 0.005;
        const PolygonMesh mesh = arc(1, angle, narrowing);
        const PlanarPatches patches = find_planar_patches(mesh, tolerance);
        // A chord of the angle a spans a^2 / 8 of the radius; the plane in its middle halves that.
        const auto needed = static_cast<std::size_t>(std::ceil(angle / std::sqrt(8 * 2 * tolerance)));
        CHECK(patches_in(patches) + 1 >= needed); // a cone's are as wide only at one end
        CHECK(patches_in(patches) <= needed + 1);
        REQUIRE(std::count(patches.patch.begin(), patches.patch.end(), no_index) == 0);
        REQUIRE(!patches.planes.empty());
        CHECK(farthest(mesh, patches) < 1.5 * tolerance);
        std::vector<double> area(patches.planes.size(), 0);
        const Vec3 axis(0, 1, 0);
        const double slope = -narrowing / std::sqrt(1 + narrowing * narrowing);
        for (std::size_t f = 0; f < mesh.facet_count(); ++f)
            area[patches.patch[f]] += area_vector(mesh, mesh.facet(f)).norm();
        for (const Plane& plane : patches.planes) CHECK(std::abs((plane.normal | axis) + slope) < 0.01);
        const auto [least, most] = std::minmax_element(area.begin(), area.end());
        CHECK(*most < 1.5 * *least);
    }
}

TEST_CASE("flat ground reaches into what bends beside it as far as the tolerance", "[simplify]") {
    // Flat for 1, then a quarter of a circle.
    const double radius = 0.6, tolerance = 0.004;
    const PolygonMesh mesh = grid(80, 40, [&](double u, double v) {
        const double s = u * (1 + radius * std::numbers::pi / 2);
        if (s <= 1) return Vec3(s, v, radius);
        const double a = (s - 1) / radius;
        return Vec3(1 + radius * std::sin(a), v, radius * std::cos(a));
    });
    const PlanarPatches patches = find_planar_patches(mesh, tolerance);
    CHECK(farthest(mesh, patches) < 1.5 * tolerance);
    REQUIRE(patches.patch[0] != no_index);
    const Plane& ground = patches.planes[patches.patch[0]];
    CHECK((ground.normal - Vec3(0, 0, 1)).norm() < 1e-3); // not tilted
    double reaches = 0;
    for (std::size_t f = 0; f < mesh.facet_count(); ++f)
        if (patches.patch[f] == patches.patch[0])
            for (Index v : mesh.facet(f)) reaches = std::max(reaches, mesh.positions[v][0]);
    CHECK(reaches > 1 + 0.5 * std::sqrt(2 * tolerance * radius));
    const double rest = std::numbers::pi / 2 - std::sqrt(2 * tolerance / radius);
    CHECK(patches_in(patches)
          <= 2 + static_cast<std::size_t>(std::ceil(rest / std::sqrt(16 * tolerance / radius))));
}

TEST_CASE("strips go all round a shaft, but not one that is thinner than the tolerance", "[simplify]") {
    const auto shaft = [](double radius) { return support::round_tube(120, 60, radius, 0.05 * radius); };
    const double tolerance = 0.01;
    const PlanarPatches patches = find_planar_patches(shaft(1), tolerance);
    const auto needed = static_cast<std::size_t>(2 * std::numbers::pi / std::sqrt(16 * tolerance));
    CHECK(patches_in(patches) >= needed);
    CHECK(patches_in(patches) <= needed + 5);
    CHECK(std::count(patches.patch.begin(), patches.patch.end(), no_index) == 0);
    for (const double radius : {0.012, 0.005}) {
        const PolygonMesh thin = shaft(radius);
        const PlanarPatches few = find_planar_patches(thin, tolerance);
        for (std::size_t f = 0; f < thin.facet_count(); ++f)
            if (few.patch[f] != no_index)
                CHECK((few.planes[few.patch[f]].normal | unit(area_vector(thin, thin.facet(f)))) > 0.3);
    }
}

TEST_CASE("no mesh, and facets without area, have no patches", "[simplify]") {
    CHECK(find_planar_patches(PolygonMesh(), 0.01).planes.empty());
    const PolygonMesh flat = grid(20, 20, [](double u, double) { return Vec3(u, 0, 0); });
    CHECK(patches_in(find_planar_patches(flat, 0.01)) == 0);
}

TEST_CASE("what bends two ways has no patches", "[simplify]") {
    const PolygonMesh mesh = grid(40, 40, [](double u, double v) {
        const double x = u - 0.5, y = v - 0.5;
        return Vec3(x, y, std::sqrt(1.5 - x * x - y * y));
    });
    CHECK(patches_in(find_planar_patches(mesh, 0.002)) == 0);
}

TEST_CASE("planar patches do not depend on the number of threads", "[simplify]") {
    const PolygonMesh mesh = arc(1, 2.5);
    const PlanarPatches all = find_planar_patches(mesh, 0.01);
    const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
    const PlanarPatches single = find_planar_patches(mesh, 0.01);
    CHECK(all.patch == single.patch);
    REQUIRE(all.planes.size() == single.planes.size());
    for (std::size_t p = 0; p < all.planes.size(); ++p) {
        CHECK(all.planes[p].normal == single.planes[p].normal);
        CHECK(all.planes[p].offset == single.planes[p].offset);
    }
}

TEST_CASE("a vertex among patches has their planes, others their facets' own", "[simplify]") {
    const PolygonMesh mesh = arc(1, 1.8);
    const PlanarPatches patches = find_planar_patches(mesh, 0.005);
    std::array<Vec3, 4> normals;
    for (const Quadric& planes : vertex_planes(mesh, patches, 0.003)) {
        const std::size_t count = planes.shared_normals(normals).size();
        CHECK((count == 1 || count == 2));
        CHECK(planes.rms(planes.minimum()) < 1e-9);
    }
    PlanarPatches none{std::vector<Index>(mesh.facet_count(), no_index), {}};
    const std::vector<Quadric> own = vertex_planes(mesh, none, 0.003), expected = vertex_planes(mesh);
    for (std::size_t v = 0; v < own.size(); ++v)
        CHECK(own[v].rms({0.3, 0.2, 0.1}) == expected[v].rms({0.3, 0.2, 0.1}));
}
