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

std::vector<NoiseSample> samples_of(ScratchCloud& cloud, const Survey& sums, const CloudPasses& passes,
                                    int neighbors) {
    NoisePass pass(cloud, sums, neighbors);
    const int ghost = passes.ghost_voxels;
    cloud.for_tiles(passes.plan(cloud, ghost), ghost,
                    [&](const Octree& octree, const VoxelRange& range) { pass.add(octree, range, ghost); });
    pass.add_far_cells(cloud);
    return values_of_all(cloud.ranks(), pass.samples());
}

ScratchCloud thinned(const ScratchCloud& cloud, const Survey& sums, std::size_t most) {
    ScratchCloud thin = cloud.emptied(false, false);
    const std::vector<Survey::FirstPoint> first = sums.first_points();
    const auto own = std::ranges::find_if(first, [&](const Survey::FirstPoint& of_cell) {
        return cloud.owner(of_cell.cell) == cloud.ranks().rank();
    });
    std::size_t number = own != first.end() ? own->number : 0;
    cloud.for_groups(most, [&](const Octree& part) {
        for (std::size_t i = 0; i < part.size(); ++i)
            if (is_of_thinned(number++)) thin.add(part, i);
    });
    thin.finish_sorted();
    return thin;
}

double deviation_of(ScratchCloud& cloud, const Survey& sums, const std::vector<NoiseSample>& samples,
                    const CloudPasses& passes) {
    if (const auto found = noise_deviation(samples, sums.points())) return *found;
    ScratchCloud thin = thinned(cloud, sums, passes.most_points);
    const Survey of_thin = survey_cloud(thin, (sums.points() + 3) / 4, passes.most_points).sums;
    return deviation_of(thin, of_thin, samples_of(thin, of_thin, passes, NeighborOptions().count), passes);
}

} // namespace

CloudNoise cloud_noise(ScratchCloud& cloud, const CloudSurvey& survey, const CloudPasses& passes) {
    const std::vector<NoiseSample> samples = samples_of(cloud, survey.sums, passes, NeighborOptions().count);
    return {deviation_of(cloud, survey.sums, samples, passes), estimate_noise(samples)};
}

double relative_noise(ScratchCloud& cloud, const CloudSurvey& survey, const CloudPasses& passes,
                      int neighbors) {
    return estimate_noise(samples_of(cloud, survey.sums, passes, neighbors));
}

} // namespace hsdm
