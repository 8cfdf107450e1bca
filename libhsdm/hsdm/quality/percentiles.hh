#pragma once
// What most of many lengths are.

#include <vector>

namespace hsdm {

/// Each is one of the values, the least that such a share of them does not exceed.
struct Percentiles {
    double p5 = 0;     ///< of 5 %
    double median = 0; ///< of half of them
    double p95 = 0;    ///< of 95 %
    double p99 = 0;    ///< of 99 %
};

/// The percentiles of values that are numbers; all zero if there are none. O(n).
Percentiles percentiles_of(std::vector<double> values);

} // namespace hsdm
