#include "hsdm/quality/percentiles.hh"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace hsdm {

Percentiles percentiles_of(std::vector<double> values) {
    if (values.empty()) return {};
    auto begin = values.begin(); // what is before it is not greater than what comes
    const auto value_of = [&](double share) {
        const double rank = std::ceil(share * static_cast<double>(values.size()));
        const auto nth = values.begin() + static_cast<std::ptrdiff_t>(rank) - 1;
        std::nth_element(begin, nth, values.end());
        begin = nth;
        return *nth;
    };
    Percentiles result;
    result.p5 = value_of(0.05);
    result.median = value_of(0.5);
    result.p95 = value_of(0.95);
    result.p99 = value_of(0.99);
    return result;
}

} // namespace hsdm
