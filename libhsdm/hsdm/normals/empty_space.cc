#include "hsdm/normals/empty_space.hh"

#include "hsdm/core/chunks.hh"
#include "hsdm/core/interruption.hh"

#include <algorithm>

namespace hsdm {

EmptySpace::EmptySpace(std::span<const MortonCode> codes, int depth)
    : depth_(depth), side_((std::size_t{1} << depth) + 2), label_(side_ * side_ * side_, unlabelled) {
    for_each_in_order(codes.size(), [&](std::size_t v) { label_[cell(morton_decode(codes[v]))] = occupied; });
    for_each_in_order(label_.size(), [&](std::size_t start) {
        if (label_[start] == unlabelled) flood(start);
    });
}

/// Flood fill by rows: each row's run of empty cells is labelled at once.
void EmptySpace::flood(std::size_t start) {
    const auto region = static_cast<Index>(regions_++);
    stack_.assign(1, start);
    for (std::size_t looks = 0; !stack_.empty(); ++looks) {
        if (looks % chunks::slow == 0) Interruption::poll();
        const std::size_t seed = stack_.back();
        stack_.pop_back();
        if (label_[seed] != unlabelled) continue;
        const std::size_t row = seed - seed % side_;
        std::size_t begin = seed, end = seed + 1;
        while (begin > row && label_[begin - 1] == unlabelled) --begin;
        while (end < row + side_ && label_[end] == unlabelled) ++end;
        std::fill(label_.begin() + static_cast<std::ptrdiff_t>(begin),
                  label_.begin() + static_cast<std::ptrdiff_t>(end), region);
        const std::size_t y = row / side_ % side_, z = row / side_ / side_;
        if (y > 0) push_runs(begin - side_, end - side_);
        if (y + 1 < side_) push_runs(begin + side_, end + side_);
        if (z > 0) push_runs(begin - side_ * side_, end - side_ * side_);
        if (z + 1 < side_) push_runs(begin + side_ * side_, end + side_ * side_);
    }
}

void EmptySpace::push_runs(std::size_t begin, std::size_t end) {
    for (std::size_t c = begin; c < end; ++c)
        if (label_[c] == unlabelled && (c == begin || label_[c - 1] != unlabelled)) stack_.push_back(c);
}

} // namespace hsdm
