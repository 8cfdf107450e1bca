#include "hsdm/pipeline/nth_of_all.hh"

#include <bit>

namespace hsdm {
namespace {

std::vector<std::uint64_t> sum_of_each(const std::vector<std::uint64_t>& own, Ranks& ranks) {
    std::vector<std::uint64_t> all(own.size(), 0);
    for (const Ranks::Bytes& got : ranks.gather(bytes_of(own))) {
        const auto counts = ByteReader(got).take_rest<std::uint64_t>();
        for (std::size_t k = 0; k < all.size(); ++k) all[k] += counts[k];
    }
    return all;
}

} // namespace

/// By its first sixteen bits, then by the others.
float nth_of_all(const std::vector<float>& values, std::uint64_t below, Ranks& ranks) {
    constexpr unsigned half = 16;
    std::uint32_t high = 0;
    for (const bool second : {false, true}) {
        std::vector<std::uint64_t> counts(std::size_t{1} << half, 0);
        for (const float value : values) {
            const auto bits = std::bit_cast<std::uint32_t>(value);
            if (!second)
                ++counts[bits >> half];
            else if (bits >> half == high)
                ++counts[bits & 0xffffu];
        }
        counts = sum_of_each(counts, ranks);
        std::uint32_t place = 0;
        while (below >= counts[place]) below -= counts[place++];
        if (second) return std::bit_cast<float>(high << half | place);
        high = place;
    }
    return 0;
}

} // namespace hsdm
