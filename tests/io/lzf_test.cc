#include "hsdm/io/lzf.hh"
#include "io/pack_lzf.hh"
#include "support/random.hh"

#include <catch2/catch.hpp>

using namespace hsdm;

namespace {

/// The expanded bytes, or what stands for a refusal.
std::string expanded(const std::string& packed, std::size_t size) {
    std::string out(size, '?');
    return io::expand_lzf(packed, out) ? out : "refused";
}

std::string bytes(std::initializer_list<int> values) {
    std::string text;
    for (int value : values) text += static_cast<char>(value);
    return text;
}

} // namespace

TEST_CASE("LZF literals and references expand by the letter of the format", "[io]") {
    CHECK(expanded("", 0).empty());
    CHECK(expanded(bytes({2, 'a', 'b', 'c'}), 3) == "abc");
    // Length 3 from 3 back; then length 9 + 1 from 1 back, which repeats what it writes.
    CHECK(expanded(bytes({2, 'a', 'b', 'c', 1 << 5, 2}), 6) == "abcabc");
    CHECK(expanded(bytes({0, 'a', 7 << 5, 1, 0}), 11) == std::string(11, 'a'));
    // A distance of more than a byte.
    std::string far = bytes({31}) + std::string(32, 'x');
    for (int run = 0; run < 9; ++run) far += bytes({31}) + std::string(32, 'y');
    CHECK(expanded(far + bytes({1 << 5 | 1, 319 - 256}), 323).substr(318) == "yyxxx");
}

TEST_CASE("LZF that is cut off, runs over or reaches before its beginning is refused", "[io]") {
    for (const auto& packed :
         {bytes({2, 'a', 'b'}), bytes({0, 'a', 1 << 5}), bytes({0, 'a', 7 << 5}), bytes({0, 'a', 7 << 5, 0}),
          bytes({0, 'a', 1 << 5, 1}), bytes({1 << 5, 0}), bytes({3, 'a', 'b', 'c', 'd'}),
          bytes({0, 'a', 2 << 5, 0}), bytes({1, 'a', 'b'})})
        CHECK(expanded(packed, 3) == "refused");
}

TEST_CASE("whatever is packed with LZF expands to the same", "[io]") {
    support::Random random(7);
    for (int round = 0; round < 200; ++round) {
        std::string text;
        const std::size_t letters = 1 + random.below(round % 2 ? 3 : 256);
        for (std::size_t left = random.below(3000); left > 0; --left)
            text += static_cast<char>(random.below(letters));
        if (round % 5 == 0) text += std::string(20000, 'z') + text;
        CHECK((expanded(test::pack_lzf(text), text.size()) == text));
    }
}
