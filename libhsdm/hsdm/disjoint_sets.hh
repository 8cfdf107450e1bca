#pragma once
// Disjoint sets of indices: union by least member, path halving.

#include "hsdm/types.hh"

#include <algorithm>
#include <numeric>
#include <vector>

namespace hsdm {

/// Disjoint sets over 0 .. n - 1. The least member of a set stands for it, so results do not depend on the
/// order of the joins.
class DisjointSets {
public:
    explicit DisjointSets(std::size_t n) : parent_(n) { std::iota(parent_.begin(), parent_.end(), Index{0}); }

    Index find(Index i) {
        while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
        return i;
    }
    /// Returns whether the two were apart.
    bool join(Index a, Index b) {
        a = find(a);
        b = find(b);
        if (a == b) return false;
        parent_[std::max(a, b)] = std::min(a, b);
        return true;
    }

private:
    std::vector<Index> parent_;
};

} // namespace hsdm
