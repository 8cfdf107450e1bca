#include "hsdm/core/chunks.hh"
#include "hsdm/core/interruption.hh"
#include "hsdm/errors.hh"

#include <catch2/catch.hpp>

#include <atomic>
#include <chrono>
#include <thread>

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
