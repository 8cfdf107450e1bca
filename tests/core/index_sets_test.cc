#include "hsdm/core/chunks.hh"
#include "hsdm/core/disjoint_sets.hh"
#include "hsdm/core/morton_index.hh"

#include <catch2/catch.hpp>

#include <random>
#include <set>

using namespace hsdm;

TEST_CASE("an index gives every code its position and no other code one", "[octree]") {
    std::mt19937_64 random(1);
    std::set<MortonCode> distinct;
    while (distinct.size() < 100000) distinct.insert(random() >> (random() % 60)); // crowded near 0
    const std::vector<MortonCode> codes(distinct.begin(), distinct.end());
    MortonIndex index;
    CHECK(index.find(codes[0]) == no_index); // before anything is in it
    index.build(codes);
    std::size_t wrong = 0;
    for (std::size_t i = 0; i < codes.size(); ++i) wrong += index.find(codes[i]) != i;
    for (int i = 0; i < 100000; ++i) {
        const MortonCode code = random() >> (random() % 60);
        if (!distinct.contains(code)) wrong += index.find(code) != no_index;
    }
    CHECK(wrong == 0);
    index.build({});
    CHECK(index.find(codes[0]) == no_index);
}

TEST_CASE("the next code up or down an axis is that of the next voxel", "[octree]") {
    std::mt19937 random(5);
    std::size_t wrong = 0;
    for (int i = 0; i < 1000; ++i)
        for (unsigned axis = 0; axis < 3; ++axis) {
            VoxelCoord c;
            for (auto& x : c) x = static_cast<std::int32_t>(random() % ((1u << (1 + random() % 20)) - 1));
            const MortonCode code = morton_encode(c);
            ++c[axis];
            wrong += morton_up(code, axis) != morton_encode(c);
            wrong += morton_down(morton_encode(c), axis) != code;
        }
    CHECK(wrong == 0);
}

TEST_CASE("sets joined by many threads are those that one thread joins", "[disjoint_sets]") {
    constexpr Index n = 200000;
    std::mt19937 random(2);
    std::vector<std::pair<Index, Index>> pairs; // chains, and pairs from anywhere
    for (Index i = 0; i + 1 < n; ++i)
        if (random() % 8) pairs.emplace_back(i, i + 1);
    for (Index i = 0; i < n / 8; ++i) pairs.emplace_back(random() % n, random() % n);
    std::shuffle(pairs.begin(), pairs.end(), random);

    DisjointSets one(n), many(n);
    std::size_t joined = 0;
    for (const auto& [a, b] : pairs) joined += one.join(a, b);
    std::vector<std::size_t> joins(chunk_count(pairs.size(), 1000), 0);
    for_chunks(pairs.size(), 1000, [&](std::size_t begin, std::size_t end, std::size_t chunk) {
        for (std::size_t i = begin; i < end; ++i) joins[chunk] += many.join(pairs[i].first, pairs[i].second);
    });
    CHECK(std::accumulate(joins.begin(), joins.end(), std::size_t{0}) == joined);
    std::size_t wrong = 0;
    for (Index i = 0; i < n; ++i) wrong += one.find(i) != many.find(i);
    CHECK(wrong == 0);
}
