// The yardsticks that seconds and bytes of different machines are compared by.
#pragma once

#include <cstddef>

namespace hsdm::bench {

/// Seconds of std::sort over 8,000,000 random 64-bit numbers on one core: the middle one of so many trials.
double sort_seconds(int repeats);

/// Bytes read and written in a second, both counted, by copying one array of `bytes` to another on so many
/// threads (0: all): the fastest of so many trials. Arrays that caches hold would be copied sooner.
double copy_bandwidth(int threads, std::size_t bytes = std::size_t{1} << 28, int repeats = 7);

/// Instructions in a second of a loop of additions that do not wait for each other: the fastest of some short
/// trials.
double addition_rate();

/// Threads that parallel loops run on unless told otherwise.
int all_threads();

} // namespace hsdm::bench
