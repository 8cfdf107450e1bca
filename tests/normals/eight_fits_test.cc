#include "hsdm/normals/eight_fits.hh"

#include "support/random.hh"

#include <catch2/catch.hpp>

#include <cmath>
#include <functional>

using namespace hsdm;

namespace {

constexpr std::size_t eight = EightOffsets::lanes;

/// What offset(neighbour, lane) says.
EightOffsets offsets_of(std::size_t count, const std::function<Vec3(std::size_t, std::size_t)>& offset) {
    EightOffsets offsets;
    offsets.count = count;
    for (std::size_t k = 0; k < count; ++k)
        for (std::size_t lane = 0; lane < eight; ++lane) offsets.set(k, lane, offset(k, lane));
    return offsets;
}

/// The coordinates as they are.
EightFrames straight_frames() {
    EightFrames frames;
    for (std::size_t lane = 0; lane < eight; ++lane)
        frames.set(lane, {Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1)});
    return frames;
}

EightPlanes planes_of(const EightOffsets& offsets) {
    EightPlanes planes;
    fit_lanes().front().planes(offsets, planes);
    return planes;
}
EightTilts tilts_of(const EightOffsets& offsets, const EightFrames& frames = straight_frames()) {
    EightTilts tilts;
    fit_lanes().front().tilts(offsets, frames, tilts);
    return tilts;
}

/// About a plane, the flatter the later the lane, in any direction.
EightOffsets random_offsets(support::Random& random, std::size_t count) {
    const Vec3 up = random.direction();
    return offsets_of(count, [&](std::size_t, std::size_t lane) {
        const Vec3 d(random.gauss(), random.gauss(), random.gauss());
        return d - up * ((up | d) * (1 - std::pow(0.03, lane)));
    });
}

} // namespace

TEST_CASE("planes fitted eight at a time are those fitted one by one", "[normals]") {
    support::Random random(3);
    for (std::size_t trial = 0; trial < 50; ++trial) {
        const EightOffsets offsets = random_offsets(random, 5 + trial % 60);
        const EightPlanes planes = planes_of(offsets);
        for (std::size_t lane = 0; lane < eight; ++lane) {
            PlaneSums sums;
            sums.add(Vec3(0, 0, 0), 1);
            for (std::size_t k = 0; k < offsets.count; ++k)
                sums.add(Vec3(offsets.rows[k][0][lane], offsets.rows[k][1][lane], offsets.rows[k][2][lane]),
                         1);
            const PlaneFit alone = fit_plane(sums), fit = planes.of(lane);
            CHECK((fit.normal - alone.normal).norm() < 1e-9);
            CHECK(fit.variance == Approx(alone.variance).margin(1e-14));
        }
    }
}

TEST_CASE("points at one place span no plane, whatever those of other lanes do", "[normals]") {
    support::Random random(4);
    const EightPlanes planes = planes_of(offsets_of(10, [&](std::size_t, std::size_t lane) {
        return lane % 3 == 0 ? Vec3(0, 0, 0) : random.direction();
    }));
    for (std::size_t lane = 0; lane < eight; ++lane)
        CHECK(planes.of(lane).normal.norm() == Approx(lane % 3 == 0 ? 0 : 1));
}

TEST_CASE("the tilt is the slope of the quadratic less that of the plane", "[normals]") {
    support::Random random(4);
    // About (1/3, 0): the plane's slope is that of its middle. The first of them is the point itself.
    const double xs[] = {0, -1, 2}, ys[] = {0, -1, 1};
    for (int trial = 0; trial < 100; ++trial) {
        std::array<std::array<double, 6>, eight> c;
        for (auto& of_lane : c)
            for (double& x : of_lane) x = random.uniform(-1, 1);
        const EightTilts tilts = tilts_of(offsets_of(8, [&](std::size_t k, std::size_t lane) {
            const double x = xs[(k + 1) % 3], y = ys[(k + 1) / 3];
            const auto& a = c[lane];
            const double z = a[1] * x + a[2] * y + a[3] * x * x + a[4] * x * y + a[5] * y * y;
            return lane % 2 == 0 ? Vec3(x, y, z) : Vec3(y, x, z); // the axes swapped
        }));
        for (std::size_t lane = 0; lane < eight; ++lane) {
            // Least squares of x^2 over -1, 0, 2 has the slope 8/7; x y and y^2 are even about y = 0.
            CHECK(tilts.tilt[lane % 2][lane] == Approx(-8.0 / 7 * c[lane][3]).margin(1e-9));
            CHECK(tilts.tilt[1 - lane % 2][lane] == Approx(-1.0 / 3 * c[lane][4]).margin(1e-9));
            CHECK(tilts.variance[lane] < 1e-12);
        }
    }
}

TEST_CASE("the tilt of a noisy plane has the variance that is said", "[normals]") {
    support::Random random(9);
    double squares = 0, said = 0;
    for (int trial = 0; trial < 1000; ++trial) {
        const EightOffsets offsets = offsets_of(16, [&](std::size_t, std::size_t) {
            return Vec3(random.uniform(0, 1), random.uniform(-1, 1), 0); // all on one side, as at a border
        });
        // Noise of the point, too: heights are relative to it.
        std::array<double, eight> own;
        for (double& height : own) height = 0.3 * random.gauss();
        EightOffsets noisy = offsets;
        for (std::size_t k = 0; k < offsets.count; ++k)
            for (std::size_t lane = 0; lane < eight; ++lane)
                noisy.rows[k][2][lane] = 0.3 * random.gauss() - own[lane];
        const EightTilts tilts = tilts_of(noisy);
        for (std::size_t lane = 0; lane < eight; ++lane) {
            squares += tilts.tilt[0][lane] * tilts.tilt[0][lane] + tilts.tilt[1][lane] * tilts.tilt[1][lane];
            said += tilts.variance[lane];
        }
    }
    CHECK(squares == Approx(said).epsilon(0.1));
}

TEST_CASE("points on a line, on a conic or too few give no tilt, whatever other lanes hold", "[normals]") {
    support::Random random(3);
    const auto beside = [&](std::size_t lane, const Vec3& at) {
        return lane == 5 ? at : Vec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
    };
    const EightOffsets line = offsets_of(
        10, [&](double i, std::size_t lane) { return beside(lane, Vec3(0.1 * i, 0.2 * i, 0.01 * i * i)); });
    const EightOffsets few = offsets_of(
        5, [&](double i, std::size_t lane) { return beside(lane, Vec3(0.3 * i, 0.1 * i * i, 0.1 * i)); });
    const EightOffsets circle = offsets_of(12, [&](double i, std::size_t lane) { // through the point
        return beside(lane, Vec3(std::cos(i) - 1, std::sin(i), 0.1 * i));
    });
    for (const EightOffsets* offsets : {&line, &few, &circle}) {
        const EightTilts tilts = tilts_of(*offsets);
        CHECK(tilts.tilt[0][5] == 0);
        CHECK(tilts.tilt[1][5] == 0);
        CHECK(tilts.variance[5] == 0);
    }
    CHECK(tilts_of(circle).variance[4] > 0);
}

TEST_CASE("lanes of every width fit the same, to the last bit", "[normals]") {
    support::Random random(5);
    for (std::size_t round = 0; round < 500; ++round) {
        const EightOffsets offsets = random_offsets(random, 3 + round % 62);
        EightFrames frames;
        for (std::size_t lane = 0; lane < eight; ++lane)
            frames.set(lane, {random.direction(), random.direction(), random.direction()});
        const EightPlanes planes = planes_of(offsets);
        const EightTilts tilts = tilts_of(offsets, frames);
        for (const FitLanes& of_width : fit_lanes()) {
            EightPlanes same;
            of_width.planes(offsets, same);
            REQUIRE(same.along == planes.along);
            REQUIRE(same.variance == planes.variance);
            REQUIRE(same.trace == planes.trace);
            REQUIRE(same.gap == planes.gap);
            EightTilts alike;
            of_width.tilts(offsets, frames, alike);
            REQUIRE(alike.tilt == tilts.tilt);
            REQUIRE(alike.variance == tilts.variance);
        }
    }
}
