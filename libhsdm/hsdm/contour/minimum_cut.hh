#pragma once
// Labels of two kinds that cost least, all together: one exact decision instead of many local ones.

#include "hsdm/types.hh"

#include <array>
#include <vector>

namespace hsdm {

/// What labels 0 and 1 of some things cost, alone and in pairs.
class LabelCosts {
public:
    /// [label of the first][label of the second]
    using Table = std::array<std::array<double, 2>, 2>;
    /// Costs `cost` if `zero` has label 0 and `one` has label 1.
    struct Pair {
        Index zero, one;
        double cost;
    };

    explicit LabelCosts(std::size_t things) : of_one_(things, 0) {}

    void add(Index thing, double of_zero, double of_one) { of_one_[thing] += of_one - of_zero; }
    /// The table must be submodular: equal labels cost no more, together, than different ones.
    void add(Index first, Index second, const Table& cost);

    std::size_t size() const { return of_one_.size(); }
    const std::vector<double>& of_one() const { return of_one_; } ///< per thing: of 1, less that of 0
    const std::vector<Pair>& pairs() const { return pairs_; }

private:
    std::vector<double> of_one_;
    std::vector<Pair> pairs_;
};

/// The labels of least cost, each rounded to a millionth: a minimum cut of the graph of pairs (Boykov,
/// Kolmogorov, An experimental comparison of min-cut/max-flow algorithms, 2004; Kolmogorov, Zabih, What
/// energy functions can be minimized via graph cuts, 2004). Of several, the one with the fewest zeros, so the
/// order of pairs does not count. Parallel over components of the graph.
std::vector<std::uint8_t> cheapest_labels(const LabelCosts& costs);

} // namespace hsdm
