#include "hsdm/quality/percentiles.hh"

#include <catch2/catch.hpp>

using namespace hsdm;

TEST_CASE("a percentile is the least value that such a share does not exceed", "[percentiles]") {
    std::vector<double> values;
    for (int i = 0; i < 1000; ++i) values.push_back((i * 389 + 17) % 1000 + 1); // 1 to 1000, mixed
    const Percentiles found = percentiles_of(values);
    CHECK(found.p5 == 50);
    CHECK(found.median == 500);
    CHECK(found.p95 == 950);
    CHECK(found.p99 == 990);
}

TEST_CASE("percentiles of few values are among them, of none zero", "[percentiles]") {
    const Percentiles one = percentiles_of({7}), three = percentiles_of({3, 1, 2}), none = percentiles_of({});
    CHECK(one.p5 == 7);
    CHECK(one.p99 == 7);
    CHECK(three.p5 == 1);
    CHECK(three.median == 2);
    CHECK(three.p95 == 3);
    CHECK(none.median == 0);
}
