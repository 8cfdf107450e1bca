#include "hsdm/core/disjoint_sets.hh"
#include "hsdm/core/groups.hh"
#include "support/random.hh"

#include <catch2/catch.hpp>

using namespace hsdm;

TEST_CASE("each member is in its group once, in ascending order", "[groups]") {
    support::Random random(1);
    constexpr std::size_t count = 50;
    std::vector<Index> group(1000);
    for (Index& g : group) g = static_cast<Index>(random.below(count + 10));
    for (Index& g : group)
        if (g >= count || g == 7) g = no_index; // group 7 has none
    const Groups groups(group, count);
    std::size_t members = 0;
    for (Index g = 0; g < count; ++g) {
        const auto own = groups.of(g);
        members += own.size();
        CHECK(std::is_sorted(own.begin(), own.end()));
        CHECK(std::adjacent_find(own.begin(), own.end()) == own.end());
        CHECK(std::all_of(own.begin(), own.end(), [&](Index i) { return group[i] == g; }));
    }
    CHECK(groups.of(7).empty());
    const auto without = static_cast<std::size_t>(std::count(group.begin(), group.end(), no_index));
    CHECK(without > 0);
    CHECK(members == group.size() - without);
}

TEST_CASE("groups without members are empty", "[groups]") {
    const Groups none({}, 3);
    for (std::size_t g = 0; g < 3; ++g) CHECK(none.of(g).empty());
    const std::vector<Index> group(5, no_index);
    CHECK(Groups(group, 1).of(0).empty());
}

TEST_CASE("the least member stands for its set, in whatever order sets are joined", "[disjoint_sets]") {
    support::Random random(2);
    for (int round = 0; round < 20; ++round) {
        constexpr Index n = 60;
        DisjointSets sets(n);
        std::vector<Index> least(n); // by relabelling everything at every join
        for (Index i = 0; i < n; ++i) least[i] = i;
        for (int k = 0; k < 40; ++k) {
            const auto a = static_cast<Index>(random.below(n)), b = static_cast<Index>(random.below(n));
            const Index from = std::max(least[a], least[b]), to = std::min(least[a], least[b]);
            CHECK(sets.join(a, b) == (from != to));
            std::replace(least.begin(), least.end(), from, to);
        }
        for (Index i = 0; i < n; ++i) CHECK(sets.find(i) == least[i]);
    }
}

TEST_CASE("what chunks produce comes in their order", "[chunks]") {
    constexpr std::size_t n = 1003, chunk_size = 100;
    CHECK(chunk_count(n, chunk_size) == 11);
    CHECK(chunk_count(1000, chunk_size) == 10);
    CHECK(chunk_count(0, chunk_size) == 0);
    std::vector<std::vector<std::size_t>> parts(chunk_count(n, chunk_size));
    for_chunks(n, chunk_size, [&](std::size_t begin, std::size_t end, std::size_t chunk) {
        for (std::size_t i = begin; i < end; ++i)
            if (chunk != 4) parts[chunk].push_back(i); // one produces nothing
    });
    const std::vector<std::size_t> whole = joined(parts);
    REQUIRE(whole.size() == n - chunk_size);
    for (std::size_t i = 0; i < whole.size(); ++i) CHECK(whole[i] == i + (i < 400 ? 0 : chunk_size));
}
