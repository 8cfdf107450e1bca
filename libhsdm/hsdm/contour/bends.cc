#include "hsdm/contour/bends.hh"

#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <cmath>

namespace hsdm {

double BendSums::deviation() const {
    return points > 0 ? std::sqrt(static_cast<double>(squares) / scale / static_cast<double>(points)) : 0;
}

BendSums measure_bends(const NormalSets& sets, double voxel_size, const std::function<bool(Index)>& counts) {
    constexpr double of_turn = 1.0 / 5;
    return tbb::parallel_reduce(
        tbb::blocked_range<std::size_t>(0, sets.sets.size(), 1 << 12), BendSums{},
        [&](const tbb::blocked_range<std::size_t>& range, BendSums sums) {
            for (std::size_t s = range.begin(); s != range.end(); ++s) {
                const NormalSet& set = sets.sets[s];
                if (!counts(set.voxel)) continue;
                const double turn = set.turn / voxel_size, square = std::min(of_turn * turn * turn, 1.0);
                sums.points += set.count;
                sums.squares += set.count * static_cast<std::uint64_t>(square * BendSums::scale);
            }
            return sums;
        },
        [](const BendSums& a, const BendSums& b) {
            return BendSums{a.points + b.points, a.squares + b.squares};
        });
}

} // namespace hsdm
