#pragma once
// Disjoint sets of indices: union by least member, path halving; from any number of threads at once.

#include "hsdm/core/large_vector.hh"
#include "hsdm/types.hh"

#include <algorithm>
#include <atomic>
#include <vector>

namespace hsdm {

/// Disjoint sets over 0 .. n - 1. The least member of a set stands for it, so results do not depend on the
/// order of the joins. Threads may join and find at the same time: a member's parent only ever becomes less.
class DisjointSets {
public:
    explicit DisjointSets(std::size_t n) : parent_(large_vector<Index>(n)) {
        for_each_in_order(n, [&](std::size_t i) { parent_[i] = static_cast<Index>(i); });
    }

    Index find(Index i) {
        for (;;) {
            Index up = parent(i).load(std::memory_order_relaxed);
            if (up == i) return i;
            const Index above = parent(up).load(std::memory_order_relaxed);
            if (above != up) parent(i).compare_exchange_weak(up, above, std::memory_order_relaxed);
            i = above;
        }
    }
    /// Joins two sets; false if they were one already.
    bool join(Index a, Index b) {
        for (;;) {
            a = find(a);
            b = find(b);
            if (a == b) return false;
            Index root = std::max(a, b);
            if (parent(root).compare_exchange_strong(root, std::min(a, b), std::memory_order_relaxed))
                return true;
        }
    }

private:
    std::atomic_ref<Index> parent(Index i) { return std::atomic_ref(parent_[i]); }

    std::vector<Index> parent_;
};

} // namespace hsdm
