#include "hsdm/contour/minimum_cut.hh"

#include "support/random.hh"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>

using namespace hsdm;

namespace {

double cost_of(const LabelCosts& costs, unsigned labels) {
    double sum = 0;
    for (Index i = 0; i < costs.size(); ++i)
        if (labels >> i & 1u) sum += costs.of_one()[i];
    for (const LabelCosts::Pair& pair : costs.pairs())
        if ((labels >> pair.zero & 1u) == 0 && (labels >> pair.one & 1u) == 1) sum += pair.cost;
    return sum;
}

unsigned as_bits(const std::vector<std::uint8_t>& labels) {
    unsigned bits = 0;
    for (std::size_t i = 0; i < labels.size(); ++i) bits |= static_cast<unsigned>(labels[i]) << i;
    return bits;
}

/// Random costs of up to twelve things: tables whose equal labels cost no more than different ones.
struct RandomCosts {
    struct Entry {
        Index first, second;
        LabelCosts::Table table;
    };
    std::size_t things;
    std::vector<double> alone;
    std::vector<Entry> entries;

    explicit RandomCosts(support::Random& random) : things(1 + random.below(12)) {
        for (std::size_t i = 0; i < things; ++i) alone.push_back(random.uniform() - 0.5);
        for (std::size_t k = 0, n = random.below(3 * things); k < n && things > 1; ++k) {
            Entry entry{
                static_cast<Index>(random.below(things)), static_cast<Index>(random.below(things)), {}};
            if (entry.first == entry.second) continue;
            auto& t = entry.table;
            for (auto& row : t)
                for (double& cost : row) cost = random.uniform();
            if (t[0][0] + t[1][1] > t[0][1] + t[1][0]) std::swap(t[0], t[1]);
            entries.push_back(entry);
        }
    }

    LabelCosts costs() const {
        LabelCosts result(things);
        for (Index i = 0; i < things; ++i) result.add(i, 0, alone[i]);
        for (const Entry& e : entries) result.add(e.first, e.second, e.table);
        return result;
    }

    /// By the tables themselves.
    double cost_by_tables(unsigned labels) const {
        double sum = 0;
        for (Index i = 0; i < things; ++i) sum += labels >> i & 1u ? alone[i] : 0;
        for (const Entry& e : entries) sum += e.table[labels >> e.first & 1u][labels >> e.second & 1u];
        return sum;
    }
};

} // namespace

TEST_CASE("no labels cost less than a minimum cut, tried one and all", "[contour]") {
    support::Random random(7);
    int with_pairs = 0;
    for (int trial = 0; trial < 400; ++trial) {
        const RandomCosts given(random);
        const LabelCosts costs = given.costs();
        with_pairs += !costs.pairs().empty();
        const unsigned found = as_bits(cheapest_labels(costs));
        double least = given.cost_by_tables(0);
        for (unsigned labels = 1; labels < 1u << given.things; ++labels)
            least = std::min(least, given.cost_by_tables(labels));
        CHECK(given.cost_by_tables(found) == Approx(least).margin(1e-4));
        // Both ways of counting differ by the same for all labels.
        CHECK(cost_of(costs, found) - cost_of(costs, 0)
              == Approx(given.cost_by_tables(found) - given.cost_by_tables(0)).margin(1e-9));
    }
    CHECK(with_pairs > 200);
}

TEST_CASE("a minimum cut does not depend on the order of pairs, and ties go to label 1", "[contour]") {
    support::Random random(8);
    for (int trial = 0; trial < 100; ++trial) {
        RandomCosts given(random);
        for (double& a : given.alone) a = std::round(4 * a) / 4; // many labellings cost the same
        for (auto& e : given.entries) {
            const double cost = static_cast<double>(random.below(3)) / 4;
            e.table = {{{0, cost}, {cost, 0}}};
        }
        const std::vector<std::uint8_t> found = cheapest_labels(given.costs());
        std::reverse(given.entries.begin(), given.entries.end());
        const LabelCosts costs = given.costs();
        CHECK(cheapest_labels(costs) == found);
        unsigned most_ones = 0;
        const double least = cost_of(costs, as_bits(found));
        for (unsigned labels = 0; labels < 1u << given.things; ++labels)
            if (cost_of(costs, labels) < least + 1e-6) most_ones |= labels; // so is the union of two
        CHECK(as_bits(found) == most_ones);
    }
}

TEST_CASE("nothing to label, and things that no pair joins", "[contour]") {
    CHECK(cheapest_labels(LabelCosts(0)).empty());
    LabelCosts costs(3);
    costs.add(0, 1, 2);
    costs.add(2, 2, 1);
    CHECK(cheapest_labels(costs) == std::vector<std::uint8_t>{0, 1, 1});
}
