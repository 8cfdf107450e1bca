#pragma once
// Sorting by all threads.

#include <tbb/parallel_sort.h>

#include <algorithm>
#include <vector>

namespace hsdm {

/// Sorts many values, in parallel, and leaves each once.
template <class T>
void parallel_sort_unique(std::vector<T>& values) {
    tbb::parallel_sort(values.begin(), values.end());
    values.erase(std::unique(values.begin(), values.end()), values.end());
}

} // namespace hsdm
