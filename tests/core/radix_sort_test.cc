#include "hsdm/core/radix_sort.hh"
#include "support/random.hh"

#include <catch2/catch.hpp>
#include <tbb/global_control.h>

#include <algorithm>

using namespace hsdm;

namespace {

/// Codes of so many bits, about three keys to a code; the index says where a key was.
std::vector<CodeIndex> random_keys(std::size_t count, int bits, std::uint64_t seed) {
    support::Random random(seed);
    std::vector<MortonCode> codes(count / 3 + 1);
    for (MortonCode& code : codes) code = random.bits() >> (64 - bits);
    std::vector<CodeIndex> keys;
    for (std::size_t i = 0; i < count; ++i)
        keys.push_back({codes[random.below(codes.size())], static_cast<Index>(i)});
    return keys;
}

/// The keys as a stable sort orders them, by the bits from `low` on.
std::vector<CodeIndex> expected(std::vector<CodeIndex> keys, int low = 0) {
    std::stable_sort(keys.begin(), keys.end(),
                     [low](const CodeIndex& a, const CodeIndex& b) { return a.code >> low < b.code >> low; });
    return keys;
}

bool same(const std::vector<CodeIndex>& a, const std::vector<CodeIndex>& b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const CodeIndex& x, const CodeIndex& y) {
        return x.code == y.code && x.index == y.index;
    });
}

} // namespace

TEST_CASE("keys come out by code, those of one code in the order they had", "[radix_sort]") {
    // None, one, and more than a chunk of 2^16 keys.
    for (const std::size_t count : {0u, 1u, 2u, 1000u, 70000u})
        for (const int bits : {3, 11, 12, 63}) {
            INFO(count << " keys of " << bits << " bits");
            const std::vector<CodeIndex> keys = random_keys(count, bits, count);
            std::vector<CodeIndex> sorted = keys;
            radix_sort(sorted, bits);
            CHECK(same(sorted, expected(keys)));
        }
}

TEST_CASE("bits below the lowest that is asked for do not count", "[radix_sort]") {
    for (const int low : {1, 11, 30}) {
        INFO("from bit " << low);
        const std::vector<CodeIndex> keys = random_keys(5000, low + 6, 3); // 64 different ones above
        std::vector<CodeIndex> sorted = keys;
        radix_sort(sorted, low + 6, low);
        CHECK(same(sorted, expected(keys, low)));
    }
}

TEST_CASE("bits above the highest that is asked for do not count", "[radix_sort]") {
    for (const int high : {1, 12, 30}) {
        INFO("to bit " << high);
        std::vector<CodeIndex> keys = random_keys(5000, high + 3, 5), sorted = keys;
        radix_sort(sorted, high);
        std::stable_sort(keys.begin(), keys.end(), [high](const CodeIndex& a, const CodeIndex& b) {
            const MortonCode mask = (MortonCode{1} << high) - 1;
            return (a.code & mask) < (b.code & mask);
        });
        CHECK(same(sorted, keys));
    }
}

TEST_CASE("digits that all keys share move none", "[radix_sort]") {
    std::vector<CodeIndex> keys = random_keys(3000, 11, 4);
    for (CodeIndex& key : keys) key.code = key.code << 22 | 0x155u; // one digit of six differs
    std::vector<CodeIndex> sorted = keys;
    radix_sort(sorted, 63);
    CHECK(same(sorted, expected(keys)));
    std::vector<CodeIndex> equal(3000, {42, 0});
    for (Index i = 0; i < equal.size(); ++i) equal[i].index = i;
    sorted = equal;
    radix_sort(sorted, 63);
    CHECK(same(sorted, equal));
}

TEST_CASE("the order of keys does not depend on the number of threads", "[radix_sort]") {
    std::vector<CodeIndex> many = random_keys(140001, 24, 5), one = many;
    radix_sort(many, 24);
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, 1);
    radix_sort(one, 24);
    CHECK(same(many, one));
}

TEST_CASE("numbers are sorted by the bits asked for and keep their order otherwise", "[radix_sort]") {
    for (const int low : {0, 32}) {
        INFO("from bit " << low);
        std::vector<std::uint64_t> numbers;
        for (const CodeIndex& key : random_keys(70000, 31, 6))
            numbers.push_back(low == 0 ? key.code : key.code << low | key.index);
        std::vector<std::uint64_t> sorted = numbers;
        radix_sort(sorted, 64, low);
        std::ranges::stable_sort(numbers, {}, [low](std::uint64_t number) { return number >> low; });
        CHECK(sorted == numbers);
    }
}
