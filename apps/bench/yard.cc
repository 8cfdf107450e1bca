// hsdm_bench yard: what the seconds and bytes of a report are measured by, so that reports from different
// machines compare. Optimised as the library is.

#include "yard.hh"

#include "benchmarks.hh"

#include <CLI/CLI.hpp>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <random>
#include <stdexcept>
#include <vector>

namespace hsdm {
namespace {

/// In pieces that no cache keeps from one trial to the next, as all of the array lies between.
void copy_in_parallel(const std::vector<char>& from, std::vector<char>& to) {
    constexpr std::size_t piece = std::size_t{1} << 21;
    const std::size_t pieces = (from.size() + piece - 1) / piece;
    tbb::parallel_for(std::size_t{0}, pieces, [&](std::size_t i) {
        const std::size_t begin = i * piece;
        std::memcpy(to.data() + begin, from.data() + begin, std::min(piece, from.size() - begin));
    });
}

} // namespace

double bench::sort_seconds(int repeats) {
    constexpr std::size_t count = 8000000;
    std::vector<double> seconds;
    std::vector<std::uint64_t> numbers(count);
    for (int i = 0; i < repeats; ++i) {
        std::mt19937_64 random(1);
        std::generate(numbers.begin(), numbers.end(), random);
        const double start = now();
        std::sort(numbers.begin(), numbers.end());
        seconds.push_back(now() - start);
        if (numbers.front() > numbers.back()) throw std::logic_error("not sorted");
    }
    std::sort(seconds.begin(), seconds.end());
    return seconds[seconds.size() / 2];
}

double bench::copy_bandwidth(int threads, std::size_t bytes, int repeats) {
    std::vector<char> from(bytes, 1), to(bytes, 0); // all pages touched
    tbb::task_arena arena(threads > 0 ? threads : all_threads());
    double best = 0;
    for (int i = 0; i < repeats; ++i) {
        const double start = now();
        arena.execute([&] { copy_in_parallel(from, to); });
        best = std::max(best, 2 * static_cast<double>(bytes) / (now() - start));
    }
    if (to.back() != 1) throw std::logic_error("not copied");
    return best;
}

double bench::addition_rate() {
    constexpr int trials = 100, rounds = 2000000;
    constexpr double instructions = 8 + 3; // the loop's own: add, compare, jump
    double best = 0;
    for (int trial = 0; trial < trials; ++trial) {
        std::uint64_t a = 1, b = 1, c = 1, d = 1, e = 1, f = 1, g = 1, h = 1;
        const double start = now();
        for (int i = 0; i < rounds; ++i) {
            a += 1, b += 2, c += 3, d += 4, e += 5, f += 6, g += 7, h += 8;
            // Nothing may be known of them, or the loop would be left out.
            asm volatile("" : "+r"(a), "+r"(b), "+r"(c), "+r"(d), "+r"(e), "+r"(f), "+r"(g), "+r"(h));
        }
        best = std::max(best, instructions * rounds / (now() - start));
    }
    return best;
}

int bench::all_threads() {
    return tbb::this_task_arena::max_concurrency();
}

int bench::yard(int argc, char** argv) {
    CLI::App app(
        "The yardstick Y, seconds of std::sort over 8 million random 64-bit numbers on one core, and "
        "the bytes that copying reads and writes in a second.");
    bool json = false;
    int repeats = 3;
    app.add_flag("--json", json, "for programs");
    app.add_option("--repeats", repeats, "sorts, of which the middle one counts")
        ->check(CLI::PositiveNumber)
        ->capture_default_str();
    CLI11_PARSE(app, argc, argv);
    const double y = sort_seconds(repeats);
    const int threads = all_threads();
    const double one = copy_bandwidth(1) / 1e9, all = copy_bandwidth(threads) / 1e9;
    if (json)
        std::printf("{\"sort_seconds\": %.4f, \"copy_1_thread_gbs\": %.3f, \"copy_all_threads_gbs\": %.3f, "
                    "\"threads\": %d}\n",
                    y, one, all, threads);
    else
        std::printf("| Y: seconds of a sort | copied on 1 thread, GB/s | copied on %d threads, GB/s |\n"
                    "|---|---|---|\n| %.3f | %.2f | %.2f |\n",
                    threads, y, one, all);
    return 0;
}

} // namespace hsdm
