#include "hsdm/core/small_table.hh"
#include "support/random.hh"

#include <catch2/catch.hpp>

#include <map>

using namespace hsdm;

TEST_CASE("a small table has what was added since it was emptied, as often as it is used and however full",
          "[core]") {
    support::Random random(1);
    SmallTable table;
    for (const unsigned count : {100u, 20000u, 3u, 0u, 300u}) {
        table.clear();
        std::map<Index, Index> all;
        for (std::size_t i = 0; i < count; ++i) {
            // Multiples of what a table is long, too: they meet in one place unless they are mixed.
            const auto key = static_cast<Index>(random.below(2 * count) << (i % 2 == 0 ? 0 : 12));
            const auto value = static_cast<Index>(i);
            CHECK(table.add(key, value) == all.try_emplace(key, value).second);
        }
        for (Index key = 0; key < 1000; ++key) {
            const auto found = all.find(key);
            CHECK(table.contains(key) == (found != all.end()));
            CHECK(table.at(key) == (found == all.end() ? no_index : found->second));
        }
        for (const auto& [key, value] : all) CHECK(table.at(key) == value);
    }
}
