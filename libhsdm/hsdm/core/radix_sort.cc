#include "hsdm/core/radix_sort.hh"

#include "hsdm/core/chunks.hh"
#include "hsdm/core/large_vector.hh"

#include <algorithm>
#include <array>
#include <utility>

namespace hsdm {
namespace {

constexpr int digit_bits = 11;
constexpr std::size_t buckets = std::size_t{1} << digit_bits;
constexpr std::size_t chunk_size = std::size_t{1}
                                   << 16; // a chunk's histogram must cost little against its keys

using Histogram = std::array<std::size_t, buckets>;

/// The bits from `shift` on, but none from `high` on: 11, or what is left of them.
class Digit {
public:
    Digit(int shift, int high)
        : shift_(shift), mask_((std::size_t{1} << std::min(digit_bits, high - shift)) - 1) {}
    std::size_t operator()(std::uint64_t key) const {
        return static_cast<std::size_t>(key >> shift_) & mask_;
    }
    std::size_t operator()(const CodeIndex& key) const { return (*this)(key.code); }

private:
    int shift_;
    std::size_t mask_;
};

/// Turns counts per chunk and bucket into the position of each chunk's first key of each bucket, chunk by
/// chunk as they lie in memory. Returns false if all keys share one bucket; then the counts are of no use any
/// more.
bool counts_to_offsets(std::vector<Histogram>& histograms, std::size_t n) {
    Histogram first{}; // of each bucket how many there are, then where it begins
    for (Histogram& histogram : histograms)
        for (std::size_t bucket = 0; bucket < buckets; ++bucket) {
            const std::size_t before = first[bucket];
            first[bucket] += histogram[bucket];
            histogram[bucket] = before;
        }
    std::size_t offset = 0;
    for (std::size_t& begin : first) {
        if (begin == n) return false;
        offset += std::exchange(begin, offset);
    }
    for (Histogram& histogram : histograms)
        for (std::size_t bucket = 0; bucket < buckets; ++bucket) histogram[bucket] += first[bucket];
    return true;
}

template <class Key>
void sort_by_digits(std::vector<Key>& keys, int high, int low) {
    const std::size_t n = keys.size();
    const std::size_t chunks = (n + chunk_size - 1) / chunk_size;
    std::vector<Key> buffer = unwritten_vector<Key>(n);
    std::vector<Histogram> histograms(chunks);
    for (int shift = low; shift < high; shift += digit_bits) {
        const Digit digit(shift, high);
        for_each_task(chunks, [&](std::size_t chunk) {
            Histogram& histogram = histograms[chunk];
            histogram.fill(0);
            for (std::size_t i = chunk * chunk_size; i < std::min(n, (chunk + 1) * chunk_size); ++i)
                ++histogram[digit(keys[i])];
        });
        if (!counts_to_offsets(histograms, n)) continue;
        for_each_task(chunks, [&](std::size_t chunk) {
            Histogram& histogram = histograms[chunk];
            for (std::size_t i = chunk * chunk_size; i < std::min(n, (chunk + 1) * chunk_size); ++i)
                buffer[histogram[digit(keys[i])]++] = keys[i];
        });
        keys.swap(buffer);
    }
}

} // namespace

void radix_sort(std::vector<CodeIndex>& keys, int high, int low) {
    sort_by_digits(keys, high, low);
}

void radix_sort(std::vector<std::uint64_t>& keys, int high, int low) {
    sort_by_digits(keys, high, low);
}

} // namespace hsdm
