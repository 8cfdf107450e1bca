#include "hsdm/core/chunks.hh"
#include "hsdm/core/interruption.hh"
#include "hsdm/core/large_vector.hh"
#include "hsdm/errors.hh"

#include <catch2/catch.hpp>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <thread>
#include <vector>

using namespace hsdm;

TEST_CASE("a loop ends within its tasks once the work is not to go on") {
    std::atomic<int> done = 0;
    const auto caller = std::this_thread::get_id();
    bool asked_elsewhere = false;
    const auto loop = [&](int answers) {
        done = 0;
        const Interruption interruption([&, answers]() mutable {
            asked_elsewhere = asked_elsewhere || std::this_thread::get_id() != caller;
            return answers-- > 0;
        });
        for_each_task(2000, [&](std::size_t) {
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
            ++done;
        });
    };
    CHECK_THROWS_AS(loop(0), Cancelled);
    CHECK(done < 2000);
    CHECK_THROWS_AS(loop(1), Cancelled);
    CHECK(done < 2000);
    CHECK_NOTHROW(loop(1 << 20));
    CHECK(done == 2000);
    CHECK_FALSE(asked_elsewhere);
}

TEST_CASE("loops inside loops end, too, and what comes after is not asked") {
    std::atomic<int> done = 0;
    {
        const Interruption interruption([] { return false; });
        CHECK_THROWS_AS(for_each_task(64,
                                      [&](std::size_t) {
                                          for_each_task(64, [&](std::size_t) {
                                              std::this_thread::sleep_for(std::chrono::milliseconds(1));
                                              ++done;
                                          });
                                      }),
                        Cancelled);
        CHECK(done < 64 * 64);
        const Interruption inner([] { return true; });
        CHECK_NOTHROW(for_each_task(
            100, [](std::size_t) { std::this_thread::sleep_for(std::chrono::milliseconds(1)); }));
    }
    CHECK_NOTHROW(
        for_each_task(100, [](std::size_t) { std::this_thread::sleep_for(std::chrono::milliseconds(1)); }));
}

TEST_CASE("a loop in order takes each index once, asks on the way, and ends when it is not to go on") {
    constexpr std::size_t n = 100000;
    std::vector<std::size_t> seen;
    for_each_in_order(n, [&](std::size_t i) { seen.push_back(i); });
    REQUIRE(seen.size() == n);
    CHECK(std::ranges::is_sorted(seen));
    CHECK(seen.back() == n - 1);

    std::size_t taken = 0;
    const Interruption interruption([] { return false; });
    CHECK_THROWS_AS(for_each_in_order(n,
                                      [&](std::size_t i) {
                                          ++taken;
                                          if (i == 10)
                                              std::this_thread::sleep_for(std::chrono::milliseconds(60));
                                      }),
                    Cancelled);
    CHECK(taken > 10);
    CHECK(taken < n / 2);
}

TEST_CASE("of two works one is on the thread that asks, and a failure of either is told") {
    const auto caller = std::this_thread::get_id();
    std::thread::id here;
    bool elsewhere = false;
    run_both([&] { here = std::this_thread::get_id(); }, [&] { elsewhere = true; });
    CHECK(here == caller);
    CHECK(elsewhere);
    const auto fail = [] { throw Error("failed"); };
    CHECK_THROWS_WITH(run_both(fail, [] {}), "failed");
    CHECK_THROWS_WITH(run_both([] {}, fail), "failed");
    CHECK_THROWS_WITH(run_both(fail, [] { throw Error("too"); }), "failed");
}

TEST_CASE("a large vector has the values it is made of, and is not made when it is not to go on") {
    constexpr std::size_t n = 5000000;
    std::vector<std::size_t> values = large_vector<std::size_t>(n, 7);
    REQUIRE(values.size() == n);
    CHECK(std::ranges::all_of(values, [](std::size_t v) { return v == 7; }));
    resize_large(values, n + n / 2, std::size_t{9});
    CHECK(values.size() == n + n / 2);
    CHECK(std::count(values.begin(), values.end(), 7) == static_cast<std::ptrdiff_t>(n));
    CHECK(std::count(values.begin() + n, values.end(), 9) == static_cast<std::ptrdiff_t>(n / 2));
    assign_large(values, 3, 1);
    CHECK(values == std::vector<std::size_t>{1, 1, 1});
    CHECK(large_vector<char>(0).empty());

    const Interruption interruption([] { return false; });
    std::this_thread::sleep_for(std::chrono::milliseconds(60)); // so that it is time to ask
    CHECK_THROWS_AS(large_vector<std::size_t>(n), Cancelled);
}
