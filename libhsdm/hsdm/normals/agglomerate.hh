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

/// Evidence, below 4,096, in steps of 1/4,096: sums of such floats are exact up to there, and so the same in
/// any order. With 16 neighbours two patches have as much if their leaves hold 256 points each: all but
/// leaves of the deepest level have neighborhoods::leaf_points at most.
inline float in_steps(double evidence) {
    constexpr double shift = 0x1.8p40; // the last digit of sums with it is a step
    return static_cast<float>(evidence + shift - shift);
}

/// Sorts edges by their ends, and adds up those between the same nodes. O(e).
void merge_edges(std::vector<SignedEdge>& edges, std::size_t nodes);

struct Signs {
    std::vector<std::int8_t> sign; ///< per node, +1 or -1, relative to its component
    std::vector<Index> component;  ///< per node
    std::size_t components = 0;
    double contradicted = 0; ///< share of the evidence that these signs contradict
};

/// Boruvka's algorithm with sums: in each round every component joins the one with which it has the strongest
/// evidence, summed along their whole border; the strongest first. Then the rounds are undone, last one
/// first, and in each of them components that the sum of their evidence contradicts are turned, so that early
/// errors do not stay. That is done again from the signs found, joining only nodes that agree, until nothing
/// turns: a region with few, strong errors inside it is right as a whole or wrong as a whole, and turns as
/// one. `pole`: a node with evidence on many others (the surroundings), which joins none of them again:
/// regions tied together by it alone are not one. O(e log n) a time. The result does not depend on the order
/// of the edges beyond the last bit of their sums.
Signs agglomerate(std::size_t nodes, const std::vector<SignedEdge>& edges, Index pole = no_index);

} // namespace hsdm
