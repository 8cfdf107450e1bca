#include "hsdm/normals/agglomerate.hh"
#include "support/random.hh"

#include <catch2/catch.hpp>

#include <algorithm>

using namespace hsdm;

namespace {

SignedEdge edge(Index a, Index b, float weight) {
    return {std::min(a, b), std::max(a, b), weight, std::abs(weight)};
}

/// Edges of a square grid that say what the hidden signs are, a share of them wrongly.
std::vector<SignedEdge> grid_edges(Index side, const std::vector<int>& hidden, double wrong,
                                   support::Random& random) {
    std::vector<SignedEdge> edges;
    const auto add = [&](Index a, Index b) {
        const int truth = hidden[a] * hidden[b];
        const bool lie = random.uniform() < wrong;
        edges.push_back(edge(
            a, b,
            static_cast<float>((lie ? -truth : truth) * random.uniform(lie ? 0.0 : 0.5, lie ? 0.5 : 1.0))));
    };
    for (Index y = 0; y < side; ++y)
        for (Index x = 0; x < side; ++x) {
            if (x + 1 < side) add(y * side + x, y * side + x + 1);
            if (y + 1 < side) add(y * side + x, (y + 1) * side + x);
        }
    return edges;
}

} // namespace

TEST_CASE("hidden signs are found although a tenth of the evidence is wrong", "[normals]") {
    support::Random random(7);
    const Index side = 60;
    std::vector<int> hidden;
    for (Index i = 0; i < side * side; ++i) hidden.push_back(random.uniform() < 0.5 ? -1 : 1);
    const Signs signs = agglomerate(side * side, grid_edges(side, hidden, 0.1, random));
    REQUIRE(signs.components == 1);
    int same = 0;
    for (Index i = 0; i < side * side; ++i) same += hidden[i] * signs.sign[i] > 0;
    CHECK(std::max(same, static_cast<int>(side * side) - same) > static_cast<int>(side * side) * 97 / 100);
}

TEST_CASE("no node is left against the sum of its evidence", "[normals]") {
    for (std::uint64_t seed = 1; seed <= 4; ++seed) {
        support::Random random(seed);
        const Index side = 40;
        const std::vector<int> hidden(side * side, 1);
        const std::vector<SignedEdge> edges = grid_edges(side, hidden, 0.15, random);
        const Signs signs = agglomerate(side * side, edges);
        std::vector<double> support(side * side, 0);
        for (const SignedEdge& e : edges)
            for (Index v : {e.a, e.b})
                support[v] += static_cast<double>(e.weight) * signs.sign[e.a] * signs.sign[e.b];
        CHECK(*std::min_element(support.begin(), support.end()) >= -1e-6);
    }
}

TEST_CASE("many weak witnesses along a border outweigh one strong one", "[normals]") {
    // Two rows of ten, sure of themselves; nine steps between them say opposite, one says same, and louder.
    std::vector<SignedEdge> edges;
    for (Index i = 0; i + 1 < 10; ++i)
        edges.push_back(edge(i, i + 1, 5)), edges.push_back(edge(10 + i, 11 + i, 5));
    for (Index i = 0; i < 10; ++i) edges.push_back(edge(i, 10 + i, i == 4 ? 2.0f : -1.0f));
    const Signs signs = agglomerate(20, edges);
    REQUIRE(signs.components == 1);
    for (Index i = 0; i < 10; ++i) CHECK(signs.sign[i] * signs.sign[10 + i] == -1);
}

TEST_CASE("a region that some wrong views hold turns as a whole where its border says so", "[normals]") {
    const Index side = 40, pole = side * side;
    for (std::uint64_t seed = 1; seed <= 8; ++seed) {
        support::Random random(seed);
        std::vector<SignedEdge> edges = grid_edges(side, std::vector<int>(side * side, 1), 0, random);
        const auto within = [](Index x) { return x >= 10 && x < 18; };
        for (Index i = 0; i < pole; ++i) // 32 steps cross the border, of 24 on the whole; five views say 10
            if (const bool region = within(i % side) && within(i / side); !region || i % 13 == 0)
                edges.push_back(edge(i, pole, region ? -2.0f : 2.0f));
        const Signs signs = agglomerate(pole + 1, edges, pole);
        const auto wrong = std::count_if(signs.sign.begin(), signs.sign.end(),
                                         [&](std::int8_t sign) { return sign != signs.sign[pole]; });
        CHECK(wrong == 0);
    }
}

TEST_CASE("of all signs those found agree with the evidence best, in four of five small graphs",
          "[normals]") {
    constexpr Index nodes = 12;
    int best_found = 0;
    for (std::uint64_t seed = 1; seed <= 100; ++seed) {
        support::Random random(seed);
        std::vector<SignedEdge> edges;
        for (Index a = 0; a < nodes; ++a)
            for (Index b = a + 1; b < nodes; ++b)
                if (random.uniform() < 0.35)
                    edges.push_back(edge(a, b, static_cast<float>(random.uniform(-0.5, 1))));
        const auto agreement = [&](const auto& sign) {
            double sum = 0;
            for (const SignedEdge& e : edges) sum += sign(e.a) == sign(e.b) ? e.weight : -e.weight;
            return sum;
        };
        double best = 0;
        for (unsigned signs = 0; signs < 1u << (nodes - 1); ++signs)
            best = std::max(best, agreement([&](Index v) { return signs >> v & 1; }));
        const Signs found = agglomerate(nodes, edges);
        best_found += agreement([&](Index v) { return found.sign[v] > 0; }) > best - 1e-4;
    }
    INFO(best_found);
    CHECK(best_found >= 80);
}

TEST_CASE("what no evidence joins stays apart, and the order of the edges does not matter", "[normals]") {
    std::vector<SignedEdge> edges{edge(0, 1, 1), edge(1, 2, -1), edge(4, 5, -2), edge(2, 3, 0)};
    const Signs signs = agglomerate(6, edges);
    CHECK(signs.components == 3);
    CHECK(signs.component == std::vector<Index>{0, 0, 0, 1, 2, 2});
    CHECK(signs.sign[0] * signs.sign[1] == 1);
    CHECK(signs.sign[0] * signs.sign[2] == -1);
    CHECK(signs.sign[4] * signs.sign[5] == -1);
    std::reverse(edges.begin(), edges.end());
    const Signs again = agglomerate(6, edges);
    CHECK(again.sign == signs.sign);
    CHECK(again.component == signs.component);
}

TEST_CASE("signs of evidence in steps do not depend on its order, nor on how it is divided", "[normals]") {
    support::Random random(3);
    const Index side = 40;
    const std::vector<int> hidden(side * side, 1);
    std::vector<SignedEdge> edges;
    for (int part = 0; part < 3; ++part)
        for (const SignedEdge& e : grid_edges(side, hidden, 0.3, random)) {
            const float weight = in_steps(e.weight);
            edges.push_back({e.a, e.b, weight, std::abs(weight)});
        }
    const Signs signs = agglomerate(side * side, edges);
    for (std::size_t i = edges.size(); i > 1; --i)
        std::swap(edges[i - 1], edges[static_cast<std::size_t>(random.uniform() * static_cast<double>(i))]);
    const Signs shuffled = agglomerate(side * side, edges);
    CHECK(signs.sign == shuffled.sign);
    CHECK(signs.contradicted == shuffled.contradicted);
    CHECK(signs.contradicted > 0);
}
