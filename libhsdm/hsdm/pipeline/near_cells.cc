#include "hsdm/pipeline/near_cells.hh"

#include <algorithm>
#include <array>
#include <cstdint>

namespace hsdm {
namespace {

/// Marks of the cells in a box: those of a range, then those near them too.
class MarkedCells {
public:
    MarkedCells(const VoxelRange& range, int reach) {
        const std::int32_t last = (std::int32_t{1} << range.depth) - 1;
        lo_ = {last, last, last}, hi_ = {0, 0, 0};
        for (MortonCode code = range.begin; code < range.end; ++code) {
            const VoxelCoord at = morton_decode(code);
            for (std::size_t k = 0; k < 3; ++k)
                lo_[k] = std::min(lo_[k], at[k]), hi_[k] = std::max(hi_[k], at[k]);
        }
        std::size_t volume = 1;
        for (std::size_t k = 0; k < 3; ++k) {
            lo_[k] = std::max(0, lo_[k] - reach), hi_[k] = std::min(last, hi_[k] + reach);
            stride_[k] = volume;
            volume *= length(k);
        }
        marks_.assign(volume, 0);
        for (MortonCode code = range.begin; code < range.end; ++code) marks_[index(morton_decode(code))] = 1;
        for (std::size_t k = 0; k < 3; ++k) widen(k, reach);
    }

    MortonCode least() const { return morton_encode(lo_); }
    MortonCode greatest() const { return morton_encode(hi_); }
    bool has(const VoxelCoord& at) const {
        for (std::size_t k = 0; k < 3; ++k)
            if (at[k] < lo_[k] || at[k] > hi_[k]) return false;
        return marks_[index(at)] != 0;
    }

private:
    std::size_t length(std::size_t axis) const { return static_cast<std::size_t>(hi_[axis] - lo_[axis]) + 1; }
    std::size_t index(const VoxelCoord& at) const {
        std::size_t i = 0;
        for (std::size_t k = 0; k < 3; ++k) i += static_cast<std::size_t>(at[k] - lo_[k]) * stride_[k];
        return i;
    }

    /// Marks what is at most so far along one axis.
    void widen(std::size_t axis, int reach) {
        const std::vector<std::uint8_t> before = marks_;
        const std::size_t step = stride_[axis], count = length(axis);
        for (std::size_t first = 0; first < marks_.size(); ++first) {
            if (first / step % count != 0) continue;  // no line begins here
            int after = reach + 1, ahead = reach + 1; // so far from the last mark
            for (std::size_t i = 0; i < count; ++i) {
                const std::size_t up = first + i * step, down = first + (count - 1 - i) * step;
                after = before[up] ? 0 : after + 1, ahead = before[down] ? 0 : ahead + 1;
                if (after <= reach) marks_[up] = 1;
                if (ahead <= reach) marks_[down] = 1;
            }
        }
    }

    VoxelCoord lo_, hi_;
    std::array<std::size_t, 3> stride_{};
    std::vector<std::uint8_t> marks_;
};

} // namespace

std::vector<MortonCode> cells_near(const VoxelRange& range, int reach,
                                   std::span<const ScratchPoints::Cell> cells) {
    std::vector<MortonCode> near;
    if (range.begin == range.end) return near;
    const MarkedCells marked(range, reach);
    const auto first = std::ranges::lower_bound(cells, marked.least(), {}, &ScratchPoints::Cell::code);
    for (auto c = first; c != cells.end() && c->code <= marked.greatest(); ++c)
        if (marked.has(morton_decode(c->code))) near.push_back(c->code);
    return near;
}

} // namespace hsdm
