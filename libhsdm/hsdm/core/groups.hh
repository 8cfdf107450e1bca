#pragma once
// Groups of indices as flat arrays.

#include "hsdm/core/chunks.hh"

#include <span>

namespace hsdm {

/// The members of groups, each group's in ascending order.
class Groups {
public:
    /// `group`: per member, below `count`, or no_index for one that is in none. O(members + count).
    Groups(std::span<const Index> group, std::size_t count) : first_(large_vector<Index>(count + 1)) {
        for_each_in_order(group.size(), [&](std::size_t i) {
            if (group[i] != no_index) ++first_[group[i] + 1];
        });
        counts_to_first(first_);
        resize_unwritten(members_, first_.back());
        std::vector<Index> next = copy_of_large(first_);
        for_each_in_order(group.size(), [&](std::size_t i) {
            if (group[i] != no_index) members_[next[group[i]]++] = static_cast<Index>(i);
        });
    }
    std::span<const Index> of(std::size_t group) const {
        return {members_.data() + first_[group], members_.data() + first_[group + 1]};
    }

    /// All groups' members, group after group.
    const std::vector<Index>& members() const { return members_; }

private:
    std::vector<Index> first_, members_; // those of group g are members_[first_[g]] .. [first_[g + 1]]
};

} // namespace hsdm
