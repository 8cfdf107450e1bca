#include "hsdm/pipeline/survey.hh"

#include "hsdm/core/interruption.hh"

namespace hsdm {

Survey::Survey(int depth, int cell_depth, std::size_t expected)
    : depth_(depth), cell_depth_(cell_depth), expected_(expected) {}

std::size_t Survey::place_stride(std::size_t points) {
    constexpr std::size_t samples = 1 << 12;
    return points / samples + 1;
}

void Survey::add(const Octree& part) {
    if (part.size() == 0) return;
    const VoxelCounts counts = count_places(part);
    for (std::size_t level = 0; level <= morton_levels; ++level) deep_.voxels[level] += counts.voxels[level];
    deep_.places += counts.places;
    count_squares(part);
    sample(part);
    const OctreeLevel level = extract_level(part, depth_);
    const SetSizes sizes = sizes_of(build_normal_sets(part, level));
    sets_.points += sizes.points, sets_.squares += sizes.squares;
    points_ += part.size();
    last_ = part.codes.back();
}

/// The runs of points of each level: a run ends where the next point is in another voxel of it.
void Survey::count_squares(const Octree& part) {
    const auto end_runs = [&](unsigned from) {
        for (unsigned level = from; level <= morton_levels; ++level) {
            squares_[level] += open_[level] * open_[level];
            open_[level] = 0;
        }
    };
    MortonCode before = last_;
    for_each_in_order(part.size(), [&](std::size_t i) {
        const MortonCode code = part.codes[i];
        const bool first = points_ == 0 && i == 0;
        const auto from = first ? 0u : static_cast<unsigned>(split_level(before, code));
        if (!first && from <= morton_levels) end_runs(from);
        for (unsigned level = from; level < static_cast<unsigned>(cell_depth_); ++level) ++shallow_[level];
        for (double& run : open_) ++run;
        before = code;
    });
}

void Survey::sample(const Octree& part) {
    const std::size_t stride = place_stride(expected_);
    for_each_in_order(part.size(), [&](std::size_t i) {
        const std::size_t number = points_ + i;
        if (NormalSample::holds(number, expected_)) {
            normals_.number.push_back(number);
            normals_.points.push_back({part.positions[i], part.normals[i]});
        }
        if (number % stride == 0) places_.push_back(part.positions[i]);
    });
}

VoxelCounts Survey::counts() const {
    VoxelCounts counts = deep_;
    for (std::size_t level = 0; level < static_cast<std::size_t>(cell_depth_); ++level)
        counts.voxels[level] = shallow_[level];
    return counts;
}

SparseLevel Survey::sparse() const {
    const auto squares_at = [&](int level) {
        const auto l = static_cast<std::size_t>(level);
        return squares_[l] + open_[l] * open_[l];
    };
    return sparse_level(points_, counts().voxels, squares_at, NormalOutlierOptions().points_per_voxel);
}

} // namespace hsdm
