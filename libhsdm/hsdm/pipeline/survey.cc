#include "hsdm/pipeline/survey.hh"

#include "hsdm/core/interruption.hh"
#include "hsdm/core/large_vector.hh"

#include <algorithm>
#include <numeric>

namespace hsdm {

Survey::Survey(int depth, int cell_depth, std::size_t expected, std::size_t before)
    : depth_(depth), cell_depth_(cell_depth), expected_(expected), before_(before) {}

std::size_t Survey::place_stride(std::size_t points) {
    constexpr std::size_t samples = 1 << 12;
    return points / samples + 1;
}

void Survey::add(const Octree& part) {
    if (part.size() == 0) return;
    const VoxelCounts counts = count_places(part);
    for (std::size_t level = 0; level <= morton_levels; ++level) deep_.voxels[level] += counts.voxels[level];
    deep_.places += counts.places;
    const auto leaves = count_leaves(part.codes); // those of cells' size or larger are not of the part alone
    for (auto level = static_cast<std::size_t>(cell_depth_) + 1; level < leaves.size(); ++level)
        leaves_[level] += leaves[level];
    count_squares(part);
    sample(part);
    if (part.has_normals()) {
        const SetSizes sizes = sizes_of(build_normal_sets(part, extract_level(part, depth_)));
        sets_.points += sizes.points, sets_.squares += sizes.squares;
    }
    points_ += part.size();
}

/// The runs of points of each level: a run ends where the next point is in another voxel of it.
void Survey::count_squares(const Octree& part) {
    std::array<double, morton_levels + 1> runs{};
    const auto end_runs = [&](int from, MortonCode code) {
        for (auto level = static_cast<unsigned>(std::max(from, cell_depth_)); level <= morton_levels;
             ++level) {
            squares_[level] += runs[level] * runs[level];
            if (level == static_cast<unsigned>(cell_depth_))
                cells_.push_back({code >> 3 * (morton_levels - cell_depth_), runs[level]});
            runs[level] = 0;
        }
    };
    for_each_in_order(part.size(), [&](std::size_t i) {
        if (i > 0) end_runs(split_level(part.codes[i - 1], part.codes[i]), part.codes[i - 1]);
        for (double& run : runs) ++run;
    });
    end_runs(0, part.codes.back());
}

void Survey::sample(const Octree& part) {
    const std::size_t stride = place_stride(expected_);
    for_each_in_order(part.size(), [&](std::size_t i) {
        const std::size_t number = before_ + points_ + i;
        if (part.has_normals() && NormalSample::holds(number, expected_))
            normals_.points.push_back({part.positions[i], part.normals[i]});
        if (number % stride == 0) places_.push_back(part.positions[i]);
    });
}

VoxelCounts Survey::counts() const {
    VoxelCounts counts = deep_;
    for (int level = 0; level < cell_depth_; ++level) {
        std::size_t& voxels = counts.voxels[static_cast<std::size_t>(level)];
        voxels = 0;
        for (std::size_t c = 0; c < cells_.size(); ++c)
            voxels += c == 0 || is_split(cells_[c - 1].code, cells_[c].code, level);
    }
    return counts;
}

/// Are two cells in different voxels of a level above theirs?
bool Survey::is_split(MortonCode cell, MortonCode next, int level) const {
    const int shift = 3 * (cell_depth_ - level);
    return cell >> shift != next >> shift;
}

double Survey::squares_at(int level) const {
    if (level >= cell_depth_) return squares_[static_cast<std::size_t>(level)];
    double squares = 0, run = 0;
    for (std::size_t c = 0; c < cells_.size(); ++c) {
        if (c > 0 && is_split(cells_[c - 1].code, cells_[c].code, level)) squares += run * run, run = 0;
        run += cells_[c].points;
    }
    return squares + run * run;
}

/// Leaves as large as a cell or larger: the largest voxels that hold few enough points.
std::size_t Survey::coarse_leaves() const {
    const auto most = static_cast<double>(neighborhoods::leaf_points);
    std::size_t leaves = 0;
    for (std::size_t begin = 0, end; begin < cells_.size(); begin = end) {
        end = begin + 1;
        if (cells_[begin].points > most) continue; // its leaves are within
        ++leaves;
        for (int level = cell_depth_; level-- > 0;) {
            const auto is_apart = [&](std::size_t c) {
                return is_split(cells_[std::min(c, begin)].code, cells_[std::max(c, begin)].code, level);
            };
            if (begin > 0 && !is_apart(begin - 1)) break; // more came before than the leaf may hold
            double points = 0;
            std::size_t last = begin;
            while (last < cells_.size() && points <= most && !is_apart(last)) points += cells_[last++].points;
            if (points > most) break;
            end = last;
        }
    }
    return leaves;
}

std::size_t Survey::leaves() const {
    return std::accumulate(leaves_.begin(), leaves_.end(), coarse_leaves());
}

int Survey::finest_leaves() const {
    auto leaves = leaves_;
    leaves[static_cast<std::size_t>(cell_depth_)] += coarse_leaves();
    return hsdm::finest_leaves(leaves);
}

std::vector<Survey::FirstPoint> Survey::first_points() const {
    std::vector<FirstPoint> first;
    std::size_t before = 0;
    for (const Cell& cell : cells_) {
        first.push_back({cell.code, before});
        before += static_cast<std::size_t>(cell.points);
    }
    return first;
}

SparseLevel Survey::sparse() const {
    return sparse_level(
        points_, counts().voxels, [&](int level) { return squares_at(level); },
        NormalOutlierOptions().points_per_voxel);
}

Survey::Survey(ByteReader& bytes)
    : depth_(bytes.take<int>()),
      cell_depth_(bytes.take<int>()),
      expected_(bytes.take<std::size_t>()),
      before_(bytes.take<std::size_t>()) {
    add_next(bytes);
}

void Survey::put_state(Ranks::Bytes& bytes) const {
    for (const int depth : {depth_, cell_depth_}) put(depth, bytes);
    for (const std::size_t count : {expected_, before_}) put(count, bytes);
    put_sums(bytes);
}

void Survey::put_sums(Ranks::Bytes& bytes) const {
    put(points_, bytes);
    put(deep_, bytes);
    put(squares_, bytes);
    put(leaves_, bytes);
    put(sets_, bytes);
    put_vector(cells_, bytes);
    put_vector(normals_.points, bytes);
    put_vector(places_, bytes);
}

void Survey::join(Ranks& ranks) {
    if (ranks.size() == 1) return;
    Ranks::Bytes own;
    put_sums(own);
    Survey all(depth_, cell_depth_, expected_);
    for (const Ranks::Bytes& got : ranks.gather(own)) {
        ByteReader reader(got);
        all.add_next(reader);
    }
    *this = std::move(all);
}

/// Sums of whole numbers, which are the same however they are divided.
void Survey::add_next(ByteReader& rank) {
    points_ += rank.take<std::size_t>();
    const auto deep = rank.take<VoxelCounts>();
    const auto squares = rank.take<std::array<double, morton_levels + 1>>();
    const auto leaves = rank.take<std::array<std::size_t, morton_levels + 1>>();
    const auto sets = rank.take<SetSizes>();
    for (std::size_t level = 0; level <= morton_levels; ++level) {
        deep_.voxels[level] += deep.voxels[level];
        squares_[level] += squares[level];
        leaves_[level] += leaves[level];
    }
    deep_.places += deep.places;
    sets_.points += sets.points, sets_.squares += sets.squares;
    append_large(cells_, rank.take_vector<Cell>());
    append_large(normals_.points, rank.take_vector<NormalSample::Point>());
    append_large(places_, rank.take_vector<Vec3>());
}

} // namespace hsdm
