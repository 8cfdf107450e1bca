#include "hsdm/normals/layers.hh"
#include "hsdm/normals/normals.hh"
#include "hsdm/normals/orient_normals.hh"
#include "support/scanner.hh"

#include <catch2/catch.hpp>

#include <algorithm>
#include <numbers>
#include <vector>

using namespace hsdm;

namespace {

constexpr std::size_t of_sheet = 100;

/// Two sheets of patches that were read as the sides of a wall, and as layers.
struct TwoSheets {
    TwoSheets() {
        patches.counts.assign(2 * of_sheet, 5);
        walls.sign.assign(2 * of_sheet, 1);
        std::fill(walls.sign.begin() + of_sheet, walls.sign.end(), std::int8_t{-1});
        walls.component.assign(2 * of_sheet, 0);
        walls.components = 1;
        layers.signs = walls;
        layers.signs.sign.assign(2 * of_sheet, 1);
        for (Index p = 1; p < 2 * of_sheet; ++p) layers.edges.push_back({p - 1, p, 1, 1});
        layers.sky.assign(2 * of_sheet, 0);
    }
    void see(std::size_t from, std::size_t to, int side) {
        std::fill(layers.sky.begin() + static_cast<std::ptrdiff_t>(from),
                  layers.sky.begin() + static_cast<std::ptrdiff_t>(to), static_cast<std::int8_t>(side));
    }
    /// How many points took the layers' signs; all of a sheet or none.
    std::size_t taken() {
        layers.skyward = layers.signs;
        if (layers.clear_sky.empty()) layers.clear_sky = layers.sky;
        const std::size_t points = take_layers(patches, layers, walls).points;
        std::size_t turned = 0;
        for (std::size_t p = of_sheet; p < 2 * of_sheet; ++p) turned += walls.sign[p] > 0 ? 5 : 0;
        CHECK(turned == points);
        for (std::size_t p = 0; p < of_sheet; ++p) REQUIRE(walls.sign[p] == 1);
        return points;
    }

    Patches patches;
    LayerReading layers;
    Signs walls;
};

/// Share of the points of what was scanned whose estimated normals point into the solid, and of those that
/// were turned as layers.
struct Sides {
    double wrong = 0, of_layers = 0;
};

Sides sides_of(const support::Solid& solid, const PointCloud& cloud) {
    Octree octree = build_octree(cloud);
    const NormalsReport report = make_normals(octree);
    const auto count = static_cast<double>(octree.size());
    std::size_t wrong = 0;
    for (std::size_t i = 0; i < octree.size(); ++i) {
        const Vec3 p = octree.positions[i] + octree.origin, step = octree.normals[i] * 1e-4;
        wrong += solid.distance(p + step) < solid.distance(p - step);
    }
    return {static_cast<double>(wrong) / count, static_cast<double>(report.orientation.of_layers) / count};
}

/// Scans from five positions whose places are wrong by some spacings.
PointCloud misaligned(const support::Solid& solid, double spacings, std::uint64_t seed) {
    support::ScannerOptions options{.points = 20000, .seed = seed};
    options.misalignment = spacings * 0.02; // of a ball of 10,000 points
    PointCloud cloud = support::scan_from_above(solid, 1.1, options);
    cloud.sensors.clear(), cloud.sensor_of.clear();
    return cloud;
}

} // namespace

TEST_CASE("the sky corrects what layers say by themselves, it does not say it for them", "[normals]") {
    for (const std::size_t told : {60u, 70u}) { // patches of the second sheet that are layers without the sky
        TwoSheets sheets;
        sheets.see(0, of_sheet + told, 1);
        sheets.layers.skyward = sheets.layers.signs;
        std::fill(sheets.layers.signs.sign.begin() + static_cast<std::ptrdiff_t>(of_sheet + told),
                  sheets.layers.signs.sign.end(), std::int8_t{-1});
        sheets.layers.clear_sky = sheets.layers.sky;
        const std::size_t taken = take_layers(sheets.patches, sheets.layers, sheets.walls).points;
        CHECK(taken == 5 * (3 * told > 2 * of_sheet ? of_sheet : told));
    }
}

TEST_CASE("components of which nothing is turned keep their outward side, whatever they see", "[normals]") {
    TwoSheets sheets;
    const Index other = 2 * of_sheet; // a patch of its own, which sees the sky behind it
    sheets.patches.counts.push_back(5);
    sheets.walls.sign.push_back(1);
    sheets.walls.component.push_back(1);
    sheets.walls.components = 2;
    sheets.layers.signs.sign.push_back(1);
    sheets.layers.signs.component.push_back(1);
    sheets.layers.signs.components = 2;
    sheets.layers.sky.push_back(-1);
    sheets.see(0, of_sheet, 1);
    sheets.see(of_sheet, of_sheet + 30, 1);
    sheets.layers.skyward = sheets.layers.signs;
    sheets.layers.clear_sky = sheets.layers.sky;
    const SkyReading sky = take_layers(sheets.patches, sheets.layers, sheets.walls);
    CHECK(sky.points > 0);
    CHECK(sky.outward[0] == 1);
    CHECK(sky.outward[1] == 0);
    CHECK(sheets.walls.sign[other] == 1);
}

TEST_CASE("layers are what a wall would have turned away from the sky", "[normals]") {
    TwoSheets sheets;
    sheets.see(0, 70, 1);                       // the one is outermost here,
    sheets.see(of_sheet + 70, 2 * of_sheet, 1); // the other there
    CHECK(sheets.taken() == 5 * of_sheet);
}

TEST_CASE("a wall that is seen from both sides stays one, and so does what nobody sees", "[normals]") {
    TwoSheets wall;
    wall.see(0, of_sheet, 1);
    wall.see(of_sheet, 2 * of_sheet, -1);
    CHECK(wall.taken() == 0);

    TwoSheets slit;
    slit.see(0, 1, 1); // the rims of its sides alone
    slit.see(of_sheet, of_sheet + 1, 1);
    CHECK(slit.taken() == 0);

    CHECK(TwoSheets().taken() == 0);
}

TEST_CASE("what sees no sky is layers where most of what is in question is", "[normals]") {
    for (const Index unseen :
         {30u, 49u, 50u, 70u}) { // the last patches of the second sheet, a region of their own
        INFO(unseen << " patches without a view");
        TwoSheets sheets;
        const Index first = 2 * of_sheet - unseen;
        std::erase_if(sheets.layers.edges, [&](const SignedEdge& e) { return e.b == first; });
        sheets.see(0, of_sheet, 1);
        sheets.see(of_sheet, first, 1);
        CHECK(sheets.taken() == 5 * (2 * unseen < of_sheet ? of_sheet : of_sheet - unseen));
    }
}

TEST_CASE("what is turned away from the sky stays a wall where most is layers", "[normals]") {
    TwoSheets sheets;
    const Index first = 2 * of_sheet - 30;
    std::erase_if(sheets.layers.edges, [&](const SignedEdge& e) { return e.b == first; });
    sheets.see(0, of_sheet, 1);
    sheets.see(of_sheet, first, 1);
    sheets.see(first, first + 1, -1);
    CHECK(sheets.taken() == 5 * (of_sheet - 30));
}

TEST_CASE(
    "what has no clear view stays a wall where three of four views turn away, not where two of three do",
    "[normals]") {
    for (const std::size_t away : {2u, 4u}) {
        INFO("one view to the sky, " << away << " away from it");
        TwoSheets sheets;
        const Index first = 2 * of_sheet - 30; // a region of its own
        std::erase_if(sheets.layers.edges, [&](const SignedEdge& e) { return e.b == first; });
        sheets.see(0, of_sheet, 1);
        sheets.see(of_sheet, first, 1);
        sheets.layers.clear_sky = sheets.layers.sky;
        sheets.see(first, first + 1, 1);
        sheets.see(first + 1, first + 1 + away, -1);
        CHECK(sheets.taken() == 5 * (away == 2 ? of_sheet : of_sheet - 30));
    }
}

TEST_CASE("the clear sky decides, however much is open on both sides", "[normals]") {
    TwoSheets sheets;
    sheets.see(0, of_sheet, 1);
    sheets.see(of_sheet, of_sheet + 40, 1);
    sheets.layers.clear_sky = sheets.layers.sky; // as over a solid without an underside
    sheets.see(of_sheet + 40, 2 * of_sheet, -1);
    CHECK(sheets.taken() == 5 * of_sheet);
}

TEST_CASE("a plate without a clear view stays one where most is layers", "[normals]") {
    TwoSheets sheets;
    const Index first = 2 * of_sheet - 30;
    std::erase_if(sheets.layers.edges, [&](const SignedEdge& e) { return e.b == first; });
    sheets.see(0, of_sheet, 1);
    sheets.see(of_sheet, first, 1);
    sheets.layers.clear_sky = sheets.layers.sky;
    sheets.see(first, 2 * of_sheet, -1);
    CHECK(sheets.taken() == 5 * (of_sheet - 30));
}

TEST_CASE("of normals that came with the points all of the sky counts, clear or not", "[normals]") {
    TwoSheets sheets;
    std::vector<SignedEdge> evidence; // of a wall, with one tenth of it against that
    for (Index p = 0; p < of_sheet; ++p) {
        const float across = p % 10 == 0 ? 1 : -1;
        evidence.push_back({p, p + static_cast<Index>(of_sheet), across, 1});
        if (p + 1 == of_sheet) continue;
        for (const Index sheet : {Index{0}, static_cast<Index>(of_sheet)})
            evidence.push_back({sheet + p, sheet + p + 1, 4, 4});
    }
    sheets.see(0, 70, 1);                       // the one is outermost here,
    sheets.see(of_sheet + 70, 2 * of_sheet, 1); // the other there
    sheets.layers.clear_sky.assign(2 * of_sheet, 0);
    sheets.patches.centroids.assign(2 * of_sheet, Vec3(0, 0, 0));
    sheets.patches.normals.assign(2 * of_sheet, Vec3(0, 0, 1));
    sheets.patches.sides.assign(2 * of_sheet, 5);
    OutsideView view;
    view.votes.assign(2 * of_sheet, 0);
    for (const bool came : {false, true}) {
        OrientOptions options;
        options.signs_count = came;
        const PatchSigns signs =
            sign_patches(sheets.patches, evidence, view, {}, options, [&] { return sheets.layers; });
        CHECK(signs.report.of_layers == (came ? 5 * of_sheet : 0));
    }
}

TEST_CASE("a wall stays one if only signs that follow the sky call it layers", "[normals]") {
    TwoSheets sheets;
    sheets.see(0, of_sheet, 1);
    sheets.see(of_sheet, of_sheet + 20, 1);
    sheets.layers.skyward = sheets.layers.signs;
    sheets.layers.signs = sheets.walls;
    sheets.layers.clear_sky = sheets.layers.sky;
    CHECK(take_layers(sheets.patches, sheets.layers, sheets.walls).points == 0);
}

TEST_CASE("the side in question is the layers' even if most of the sheets is turned away", "[normals]") {
    TwoSheets sheets;
    for (std::int8_t& sign : sheets.walls.sign) sign = static_cast<std::int8_t>(-sign);
    sheets.see(0, of_sheet, 1);
    sheets.see(2 * of_sheet - 20, 2 * of_sheet, 1);
    sheets.layers.skyward = sheets.layers.signs;
    sheets.layers.clear_sky = sheets.layers.sky;
    const SkyReading sky = take_layers(sheets.patches, sheets.layers, sheets.walls);
    CHECK(sky.points == 5 * of_sheet);
    REQUIRE(sky.outward.size() == 1);
    for (const std::int8_t sign : sheets.walls.sign) REQUIRE(sign * sky.outward[0] == 1);
}

TEST_CASE("layers of scans that do not register have their normals on one side", "[normals][slow]") {
    const support::Solid ball = support::sphere(1);
    double layers = 0;
    for (std::uint64_t seed = 31; seed <= 33; ++seed)
        for (const double spacings : {0.7, 1.0, 1.5}) {
            INFO("seed " << seed << ", " << spacings << " spacings");
            const Sides sides = sides_of(ball, misaligned(ball, spacings, seed));
            CHECK(sides.wrong < 0.02);
            layers += sides.of_layers;
        }
    CHECK(layers > 0);
}

TEST_CASE("layers over what is open below have their normals on one side", "[normals][slow]") {
    const support::Solid bracket =
        support::box({1.4, 1, 1}).placed(support::turned({0, 0, 1}, 0.7))
        - support::box({1.1, 1.4, 1}).placed(support::turned({0, 0, 1}, 0.7, {0.2, 0.17, 0.3}));
    for (const std::uint64_t seed : {1u, 103u}) {
        INFO("seed " << seed);
        support::ScannerOptions options{.points = 60000, .seed = seed};
        options.misalignment = 0.0105; // about a spacing
        PointCloud cloud = support::scan_from_above(bracket, 1.05, options);
        cloud.sensors.clear(), cloud.sensor_of.clear();
        CHECK(sides_of(bracket, cloud).wrong < 0.04);
    }
}

TEST_CASE("the sides of thin walls are no layers", "[normals]") {
    const auto cup = support::cylinder(0.8, 1.4)
                     - support::cylinder(0.75, 1.4).placed(support::turned({0, 0, 1}, 0.3, {0, 0, 0.05}));
    for (const auto& solid : {support::box({2, 2, 0.06}), support::nested_spheres(1, 0.95), cup}) {
        const PointCloud cloud = support::sample(solid, {.points = 40000, .seed = 5});
        const Sides sides = sides_of(solid, cloud);
        CHECK(sides.wrong < 0.01);
        CHECK(sides.of_layers < 0.001);
    }
}
