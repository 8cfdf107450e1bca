#include "hsdm/errors.hh"
#include "hsdm/spatial/neighbor_search.hh"
#include "support/random.hh"

#include <catch2/catch.hpp>
#include <tbb/global_control.h>

#include <cmath>
#include <limits>

using namespace hsdm;

namespace {

using Near = std::pair<double, Index>;

/// All points by squared distance, then index.
std::vector<Near> by_distance(const std::vector<Vec3>& points, const Vec3& place) {
    std::vector<Near> near;
    for (Index i = 0; i < points.size(); ++i) near.emplace_back((place - points[i]).sqrnorm(), i);
    std::sort(near.begin(), near.end());
    return near;
}

NearPoints none_for(std::size_t places) {
    NearPoints none;
    none.first.assign(places + 1, 0);
    return none;
}

/// For each place all points in that order.
using AllNear = std::vector<std::vector<Near>>;

AllNear all_by_distance(const std::vector<Vec3>& points, const std::vector<Vec3>& places) {
    AllNear all;
    for (const Vec3& place : places) all.push_back(by_distance(points, place));
    return all;
}

/// The first `count` of those within the radius.
NearPoints first_of(const AllNear& all, std::size_t count, double radius = 1e300) {
    NearPoints result = none_for(all.size());
    for (std::size_t p = 0; p < all.size(); ++p) {
        for (const auto& [squared, index] : all[p]) {
            if (result.index.size() - result.first[p] == count || squared > radius * radius) break;
            result.index.push_back(index);
            result.distance.push_back(std::sqrt(squared));
        }
        result.first[p + 1] = result.index.size();
    }
    return result;
}

bool equal(const NearPoints& a, const NearPoints& b) {
    return a.first == b.first && a.index == b.index && a.distance == b.distance;
}

std::vector<Vec3> in_a_box(std::size_t count, std::uint64_t seed, const Vec3& shift = Vec3(0, 0, 0)) {
    support::Random random(seed);
    std::vector<Vec3> points;
    for (std::size_t i = 0; i < count; ++i)
        points.push_back(shift + Vec3(random.uniform(), random.uniform(), random.uniform()));
    return points;
}

/// Whole coordinates, many points at the same place and most at equal distances from each other.
std::vector<Vec3> on_a_grid(std::size_t count, std::uint64_t seed) {
    support::Random random(seed);
    const auto whole = [&random] { return static_cast<double>(random.below(6)); };
    std::vector<Vec3> points;
    for (std::size_t i = 0; i < count; ++i) points.emplace_back(whole(), whole(), whole());
    return points;
}

/// On a sphere, with clusters that shrink towards a point: a deep tree.
std::vector<Vec3> uneven(std::size_t count, std::uint64_t seed) {
    support::Random random(seed);
    std::vector<Vec3> points;
    for (std::size_t i = 0; i < count; ++i)
        points.push_back(i % 2
                             ? random.direction()
                             : Vec3(1, 0, 0) + random.direction() * std::ldexp(1, -static_cast<int>(i % 50)));
    return points;
}

} // namespace

TEST_CASE("nearest points are those that a look at every point finds, equally near ones by index",
          "[neighbors]") {
    const std::vector<Vec3> points = GENERATE(in_a_box(3000, 1), on_a_grid(1500, 2), uneven(3000, 3),
                                              in_a_box(1000, 4, Vec3(1e7, -3e6, 5e8)), in_a_box(9, 5));
    std::vector<Vec3> places(points.begin(), points.begin() + 9);
    for (const Vec3& p : in_a_box(60, 6, points.front())) places.push_back(p);
    for (const Vec3& p : in_a_box(20, 7)) places.push_back(points.front() + p * 1e5);
    const NeighborSearch search(points);
    const AllNear all = all_by_distance(points, places);
    for (const int count : {1, 2, 8, 40, 5000})
        CHECK(equal(search.nearest(places, count), first_of(all, static_cast<std::size_t>(count))));
    for (const double radius : {0.0, 0.11, 1.0, 2.0, 1e4})
        for (const int count : {1, 7, 5000}) {
            const auto most = static_cast<std::size_t>(count);
            CHECK(equal(search.nearest_within(places, count, radius), first_of(all, most, radius)));
            if (count == 5000) CHECK(equal(search.within(places, radius), first_of(all, most, radius)));
        }
    for (std::size_t p = 0; p < places.size(); ++p) {
        const auto [squared, index] = all[p].front();
        CHECK(search.nearest(places[p]).index == index);
        CHECK(search.nearest(places[p]).distance == std::sqrt(squared));
    }
}

TEST_CASE("neighbours are all others at the same place first, never the point itself", "[neighbors]") {
    const std::vector<Vec3> points = GENERATE(in_a_box(800, 8), on_a_grid(800, 9), on_a_grid(6, 10));
    const NeighborSearch search(points);
    const AllNear all = all_by_distance(points, points);
    for (const int count : {1, 5, 1000}) {
        const NearPoints found = search.neighbors(count);
        REQUIRE(found.places() == points.size());
        std::size_t wrong = 0;
        for (Index i = 0; i < points.size(); ++i) {
            std::vector<Near> others = all[i];
            std::erase_if(others, [i](const Near& near) { return near.second == i; });
            others.resize(std::min<std::size_t>(others.size(), static_cast<std::size_t>(count)));
            for (std::size_t k = 0; k < others.size(); ++k)
                wrong += found.of(i)[k] != others[k].second
                         || found.distances_of(i)[k] != std::sqrt(others[k].first);
            wrong += found.of(i).size() != others.size();
        }
        CHECK(wrong == 0);
    }
}

TEST_CASE("what is found does not depend on the number of threads", "[neighbors]") {
    const std::vector<Vec3> points = in_a_box(40000, 11), places = in_a_box(5000, 12);
    const NeighborSearch many(points);
    const NearPoints nearest = many.nearest(places, 9), within = many.within(places, 0.03);
    const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
    const NeighborSearch alone(points);
    CHECK(equal(alone.nearest(places, 9), nearest));
    CHECK(equal(alone.within(places, 0.03), within));
}

TEST_CASE("the same points at any scale have the same neighbours", "[neighbors]") {
    const std::vector<Vec3> points = in_a_box(500, 13);
    const NearPoints expected = NeighborSearch(points).neighbors(6);
    const double factor = std::ldexp(1.0, GENERATE(-990, -400, -31, 31, 400, 1010));
    std::vector<Vec3> scaled = points;
    for (Vec3& p : scaled) p *= factor;
    const NeighborSearch search(scaled);
    NearPoints found = search.neighbors(6);
    for (double& d : found.distance) d /= factor;
    CHECK(equal(found, expected));
    CHECK(search.within(scaled, 0.5 * factor).index == NeighborSearch(points).within(points, 0.5).index);
}

TEST_CASE("one point is nearest to every place and has no neighbours", "[neighbors]") {
    const std::vector<Vec3> one = {Vec3(1, 2, 3)}, places = {Vec3(1, 2, 3), Vec3(1e150, 0, 0)};
    const NeighborSearch search(one);
    CHECK(search.size() == 1);
    CHECK(search.nearest(places, 4).index == std::vector<Index>{0, 0});
    CHECK(search.nearest(places[1]).distance == 1e150);
    CHECK(search.within(places, 0).of(0).size() == 1);
    CHECK(search.within(places, 0).of(1).empty());
    CHECK(equal(search.neighbors(3), none_for(1)));
    CHECK(equal(search.nearest({}, 3), none_for(0)));
}

TEST_CASE("points without extent are found by index", "[neighbors]") {
    const std::vector<Vec3> points(300, Vec3(0.1, 0.2, 0.3));
    const NeighborSearch search(points);
    CHECK(search.nearest(Vec3(5, 5, 5)).index == 0);
    const NearPoints found = search.neighbors(2);
    CHECK(std::vector<Index>(found.index.begin(), found.index.begin() + 6)
          == std::vector<Index>{1, 2, 0, 2, 0, 1});
    CHECK(found.distance == std::vector<double>(600, 0));
}

TEST_CASE("points and places that no distance can be taken of are refused", "[neighbors]") {
    const double nan = std::numeric_limits<double>::quiet_NaN(),
                 inf = std::numeric_limits<double>::infinity();
    CHECK_THROWS_AS(NeighborSearch({}), Error);
    CHECK_THROWS_AS(NeighborSearch(std::vector<Vec3>{Vec3(0, 0, 0), Vec3(0, nan, 0)}), Error);
    CHECK_THROWS_AS(NeighborSearch(std::vector<Vec3>{Vec3(-1e308, 0, 0), Vec3(1e308, 0, 0)}), Error);
    const std::vector<Vec3> points = in_a_box(50, 14);
    const NeighborSearch search(points);
    for (const Vec3& place : {Vec3(0, nan, 0), Vec3(0, 0, inf), Vec3(1e300, 0, 0)}) {
        const std::vector<Vec3> places = {Vec3(0, 0, 0), place};
        CHECK_THROWS_AS(search.nearest(place), Error);
        CHECK_THROWS_AS(search.nearest(places, 3), Error);
        if (place[0] == 0) CHECK_THROWS_AS(search.within(places, 3), Error);
    }
    CHECK(search.within(std::vector<Vec3>{Vec3(1e300, 0, 0)}, 1e200).index.empty());
}

TEST_CASE("counts and radii are held against their ranges", "[neighbors]") {
    const std::vector<Vec3> points = in_a_box(50, 15);
    const NeighborSearch search(points);
    for (const int count : {0, -1}) {
        CHECK_THROWS_AS(search.nearest(points, count), OptionError);
        CHECK_THROWS_AS(search.nearest_within(points, count, 1), OptionError);
        CHECK_THROWS_AS(search.neighbors(count), OptionError);
    }
    for (const double radius :
         {-1.0, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
        CHECK_THROWS_AS(search.within(points, radius), OptionError);
        CHECK_THROWS_AS(search.nearest_within(points, 3, radius), OptionError);
    }
}
