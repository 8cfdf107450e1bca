#include "hsdm/core/chunks.hh"
#include "hsdm/core/large_vector.hh"
#include "hsdm/types.hh"

#include <catch2/catch.hpp>

#include <algorithm>
#include <string>

using namespace hsdm;

namespace {

constexpr std::size_t above_a_megabyte = 300000; // of anything below: filled by all threads

} // namespace

TEST_CASE("large vectors grow as others do, also by one of their own values", "[core]") {
    std::vector<Vec3> values = large_vector<Vec3>(3, Vec3(1, 2, 3));
    values[1] = Vec3(4, 5, 6);
    resize_large(values, above_a_megabyte, values[1]);
    REQUIRE(values.size() == above_a_megabyte);
    CHECK(values[0] == Vec3(1, 2, 3));
    CHECK(values[2] == Vec3(1, 2, 3));
    CHECK(std::all_of(values.begin() + 3, values.end(), [](const Vec3& v) { return v == Vec3(4, 5, 6); }));
    resize_large(values, 2);
    CHECK(values == std::vector<Vec3>{Vec3(1, 2, 3), Vec3(4, 5, 6)});
    assign_large(values, above_a_megabyte, Vec3(7, 8, 9));
    CHECK(values == std::vector<Vec3>(above_a_megabyte, Vec3(7, 8, 9)));
    CHECK(large_vector<Index>(above_a_megabyte) == std::vector<Index>(above_a_megabyte));
    CHECK(large_vector<std::string>(3, "abc") == std::vector<std::string>(3, "abc"));
}

TEST_CASE("unwritten vectors keep what they had and hold what is written", "[core]") {
    std::vector<Index> values{1, 2, 3};
    for (const std::size_t size : {std::size_t{5}, above_a_megabyte, std::size_t{4}}) {
        const std::size_t before = values.size();
        resize_unwritten(values, size);
        REQUIRE(values.size() == size);
        for (std::size_t i = before; i < size; ++i) values[i] = static_cast<Index>(i + 1);
        bool all = true;
        for (std::size_t i = 0; i < size; ++i) all &= values[i] == i + 1;
        CHECK(all);
    }
    values.push_back(5);
    CHECK(values == std::vector<Index>{1, 2, 3, 4, 5});
    CHECK(unwritten_vector<std::string>(2) == std::vector<std::string>(2)); // what has a constructor is made
    CHECK(unwritten_vector<double>(0).empty());
}

TEST_CASE("what many chunks append comes in their order, however unevenly, and then the last", "[core]") {
    constexpr std::size_t n = 600 * chunks::heavy; // joined in three goes
    const auto append = [](std::size_t begin, std::size_t end, std::vector<std::size_t>& part) {
        for (std::size_t i = begin; i < end; ++i) // hardly any at first, so that more come than expected
            for (std::size_t k = 0; k < (i < n / 2 ? i % 1000 == 0 : 1 + i % 3); ++k) part.push_back(i);
    };
    std::vector<std::size_t> expected;
    append(0, n, expected);
    CHECK(collected<std::size_t>(n, chunks::heavy, append) == expected);
    expected.push_back(n);
    CHECK(collected<std::size_t>(n, chunks::heavy, append, n) == expected);
    CHECK(collected<std::size_t>(0, chunks::heavy, append, n) == std::vector<std::size_t>{n});
}
