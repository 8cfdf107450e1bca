#include "hsdm/pipeline/cloud_noise.hh"

#include "hsdm/core/large_vector.hh"
#include "hsdm/normals/noise.hh"
#include "hsdm/pipeline/cell_pass.hh"

#include <algorithm>

namespace hsdm {
namespace {

class NoisePass final : public CellPass {
public:
    NoisePass(const ScratchCloud& cloud, const Survey& sums, int neighbors)
        : CellPass(cloud, sums.points()), first_(sums.first_points()), stride_(noise_stride(sums.points())) {
        options_.count = neighbors;
        options_.finest_level = sums.finest_leaves();
    }

    const std::vector<NoiseSample>& samples() const { return samples_; }

private:
    std::vector<double> look(const Octree& octree, const VoxelRange& range) override {
        points_.clear();
        for (std::size_t begin = 0, end; begin < octree.size(); begin = end) {
            const MortonCode cell = cell_of(octree, begin);
            for (end = begin; end < octree.size() && cell_of(octree, end) == cell;) ++end;
            if (is_own(range, cell))
                choose(begin, end,
                       std::ranges::lower_bound(first_, cell, {}, &Survey::FirstPoint::cell)->number);
        }
        const Neighbors neighbors = find_neighbors_of(octree, points_, options_);
        found_ = noise_samples(octree, points_, neighbors);
        std::vector<double> reach = large_vector<double>(octree.size(), 0);
        for (std::size_t k = 0; k < points_.size(); ++k) reach[points_[k]] = neighbors.reach[k];
        return reach;
    }

    /// Those of a cell's points that noise_deviation() looks at, by their number in the whole.
    void choose(std::size_t begin, std::size_t end, std::size_t number) {
        for (std::size_t i = begin; i < end; ++i)
            if ((number + i - begin) % stride_ == 0) points_.push_back(static_cast<Index>(i));
    }

    void take(const Octree&, std::size_t begin, std::size_t end) override {
        const auto at = [&](std::size_t point) {
            return found_.begin() + (std::ranges::lower_bound(points_, point) - points_.begin());
        };
        samples_.insert(samples_.end(), at(begin), at(end));
    }

    std::vector<Survey::FirstPoint> first_;
    std::size_t stride_;
    NeighborOptions options_;
    std::vector<Index> points_;
    std::vector<NoiseSample> found_, samples_;
};

} // namespace

CloudNoise cloud_noise(ScratchCloud& cloud, const CloudSurvey& survey, std::span<const VoxelRange> ranges,
                       int ghost, int neighbors) {
    NoisePass pass(cloud, survey.sums, neighbors);
    cloud.for_tiles(ranges, ghost,
                    [&](const Octree& octree, const VoxelRange& range) { pass.add(octree, range, ghost); });
    pass.add_far_cells(cloud);
    const std::vector<NoiseSample> all = values_of_all(cloud.ranks(), pass.samples());
    const std::optional<double> deviation = noise_deviation(all);
    if (!deviation) refuse_in_tiles("the noise is wider than neighbours are apart");
    return {*deviation, estimate_noise(all)};
}

} // namespace hsdm
