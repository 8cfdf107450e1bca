#pragma once
// Sorting by all threads, which whoever started the work can stop.

#include "hsdm/core/interruption.hh"

#include <tbb/parallel_sort.h>

#include <algorithm>
#include <functional>
#include <vector>

namespace hsdm {

/// Sorts many values, in parallel; asks in between, after which, stopped, their order is any. Equal values
/// may change places: `less` should tell all apart.
template <class T, class Less = std::less<T>>
void parallel_sort(std::vector<T>& values, const Less& less = {}) {
    const auto asks = [&less](const T& a, const T& b) {
        constexpr unsigned comparisons = 1 << 14; // far less than what is asked after
        static thread_local unsigned count = 0;
        if (++count % comparisons == 0) Interruption::poll();
        return less(a, b);
    };
    tbb::parallel_sort(values.begin(), values.end(), asks);
}

/// Sorts many values, in parallel, and leaves each once.
template <class T>
void parallel_sort_unique(std::vector<T>& values) {
    parallel_sort(values);
    values.erase(std::unique(values.begin(), values.end()), values.end());
}

} // namespace hsdm
