#pragma once
// Consistent signs from contradictory evidence: a graph whose edges say "same" or "opposite" and how surely.

#include "hsdm/types.hh"

#include <vector>

namespace hsdm {

struct SignedEdge {
    Index a, b;   ///< a < b
    float weight; ///< sum of the evidence: positive for the same sign, negative for opposite signs
    float total;  ///< sum of its magnitudes: a weight far below it is evidence that contradicts itself
};

struct Signs {
    std::vector<std::int8_t> sign; ///< per node, +1 or -1, relative to its component
    std::vector<Index> component;  ///< per node
    std::size_t components = 0;
};

/// Boruvka's algorithm with sums: in each round every component joins the one with which it has the strongest
/// evidence, summed along their whole border; the strongest first. Then the rounds are undone, last one
/// first, and in each of them components that the sum of their evidence contradicts are turned, so that early
/// errors do not stay. O(e log n) at worst, in at most log2 n rounds. The result does not depend on the order
/// of the edges beyond the last bit of their sums.
Signs agglomerate(std::size_t nodes, std::vector<SignedEdge> edges);

} // namespace hsdm
