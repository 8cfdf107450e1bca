#include "hsdm/contour/normal_sets.hh"

#include "hsdm/contour/blunt_creases.hh"
#include "hsdm/contour/constants.hh"
#include "hsdm/core/check_option.hh"
#include "hsdm/core/chunks.hh"
#include "hsdm/core/constants.hh"
#include "hsdm/core/large_vector.hh"

#include <tbb/enumerable_thread_specific.h>

#include <cmath>
#include <limits>

namespace hsdm {
namespace {

constexpr std::uint8_t unassigned = 0xff;

/// Working space of one thread, reused from voxel to voxel.
struct Scratch {
    std::vector<std::uint8_t> label; // per point of the voxel
    std::vector<std::pair<double, Index>> offsets;
    std::vector<Index> points;         // of a set
    std::vector<CreaseSample> samples; // of a set
    std::vector<std::uint8_t> face;
    std::vector<Vec3> modes;
};

/// Finds the sets of one voxel. Labels are positions in `modes_` until finish() orders the sets by count.
class VoxelClusters {
public:
    VoxelClusters(const Octree& octree, Index begin, Index end, double voxel_size,
                  const NormalSetOptions& options, double cos_cluster, Scratch& scratch)
        : octree_(octree),
          begin_(begin),
          size_(end - begin),
          voxel_size_(voxel_size),
          options_(options),
          cos_cluster_(cos_cluster),
          label_(scratch.label),
          offsets_(scratch.offsets),
          points_(scratch.points),
          samples_(scratch.samples),
          face_(scratch.face),
          modes_(scratch.modes) {
        label_.assign(size_, unassigned);
        modes_.clear();
    }

    void run() {
        if (!one_direction()) {
            find_modes();
            for (int round = 0; round < repeats::twice; ++round) assign_to_nearest();
        }
        std::size_t directions = modes_.size();
        for (std::size_t k = 0; k < directions; ++k) split_at_crease(static_cast<std::uint8_t>(k));
        directions = modes_.size();
        for (std::size_t k = 0; k < directions; ++k) split_parallel_sheets(static_cast<std::uint8_t>(k));
    }

    std::size_t count() const { return modes_.size(); }

    NormalSet set(std::size_t k, Index voxel) const {
        points_.clear();
        for_each(k, [&](Index i) { points_.push_back(i); });
        return measure_set(octree_, points_, voxel, voxel_size_);
    }

    std::uint8_t label(Index i) const { return label_[i]; }

private:
    template <class F>
    void for_each(std::size_t k, F&& f) const {
        for (Index i = 0; i < size_; ++i)
            if (label_[i] == k) f(begin_ + i);
    }
    const Vec3& normal(Index i) const { return octree_.normals[begin_ + i]; }
    bool has_normal(Index i) const { return normal(i).sqrnorm() > 0.5; }

    /// Shortcut: in most voxels all normals agree with their mean, and no modes need be searched.
    bool one_direction() {
        Vec3 sum(0, 0, 0);
        for (Index i = 0; i < size_; ++i) sum += normal(i);
        const double length = sum.norm();
        if (length == 0) return false;
        const Vec3 mean = sum / length;
        for (Index i = 0; i < size_; ++i)
            if (has_normal(i) && (normal(i) | mean) < cos_cluster_) return false;
        for (Index i = 0; i < size_; ++i) label_[i] = has_normal(i) ? 0 : unassigned;
        modes_.push_back(mean);
        return true;
    }

    /// Repeatedly takes the mode that most of the unassigned normals lie near.
    void find_modes() {
        while (static_cast<int>(modes_.size()) < options_.max_sets) {
            Vec3 mode;
            if (!densest(mode)) break;
            for (int round = 0; round < repeats::few; ++round) mode = mean_within(mode);
            const auto k = static_cast<std::uint8_t>(modes_.size());
            modes_.push_back(mode);
            Index taken = 0;
            for (Index i = 0; i < size_; ++i)
                if (label_[i] == unassigned && (normal(i) | mode) >= cos_cluster_ && has_normal(i))
                    label_[i] = k, ++taken;
            if (taken == 0) {
                modes_.pop_back();
                break;
            }
        }
    }

    /// Among at most about 32 of the unassigned normals, the one with the most unassigned normals near it.
    bool densest(Vec3& mode) const {
        Index free = 0;
        for (Index i = 0; i < size_; ++i) free += label_[i] == unassigned && has_normal(i);
        if (free == 0) return false;
        const Index stride = std::max<Index>(1, free / 32);
        Index best = 0, rank = 0;
        for (Index i = 0; i < size_; ++i) {
            if (label_[i] != unassigned || !has_normal(i) || rank++ % stride != 0) continue;
            Index near = 0;
            for (Index j = 0; j < size_; ++j)
                near += label_[j] == unassigned && (normal(i) | normal(j)) >= cos_cluster_;
            if (near > best) best = near, mode = normal(i);
        }
        return best > 0;
    }

    Vec3 mean_within(const Vec3& mode) const {
        Vec3 sum(0, 0, 0);
        for (Index i = 0; i < size_; ++i)
            if (label_[i] == unassigned && (normal(i) | mode) >= cos_cluster_) sum += normal(i);
        const double length = sum.norm();
        return length > 0 ? sum / length : mode;
    }

    /// One Lloyd step over all points that have a normal.
    void assign_to_nearest() {
        std::array<Vec3, 8> sums;
        sums.fill(Vec3(0, 0, 0));
        for (Index i = 0; i < size_; ++i) {
            if (!has_normal(i)) continue;
            std::size_t best = 0;
            for (std::size_t k = 1; k < modes_.size(); ++k)
                if ((modes_[k] | normal(i)) > (modes_[best] | normal(i))) best = k;
            label_[i] = static_cast<std::uint8_t>(best);
            sums[best] += normal(i);
        }
        for (std::size_t k = 0; k < modes_.size(); ++k)
            if (const double length = sums[k].norm(); length > 0) modes_[k] = sums[k] / length;
    }

    /// Splits the set of a direction that holds the two faces of a blunt crease.
    void split_at_crease(std::uint8_t k) {
        if (static_cast<int>(modes_.size()) >= options_.max_sets) return;
        points_.clear();
        Vec3 sum(0, 0, 0);
        for_each(k, [&](Index i) { points_.push_back(i), sum += octree_.normals[i]; });
        if (points_.size() < 2 || !is_bent(sum, static_cast<double>(points_.size()))) return;
        samples_.clear();
        for (Index i : points_) samples_.push_back({octree_.positions[i], octree_.normals[i]});
        face_.resize(points_.size());
        BluntCrease crease;
        if (!find_blunt_crease(samples_, 1, face_, crease)) return;
        // A face of fewer points than make a plane counts if it turns by more than one sheet may.
        const auto second = static_cast<std::size_t>(std::ranges::count(face_, 1));
        if (std::min(second, points_.size() - second) < points_of_plane
            && (crease.normals[0] | crease.normals[1]) > angles::one_sheet)
            return;
        modes_[k] = crease.normals[0];
        for (std::size_t i = 0; i < points_.size(); ++i)
            if (face_[i] == 1) label_[points_[i] - begin_] = static_cast<std::uint8_t>(modes_.size());
        modes_.push_back(crease.normals[1]);
    }

    /// Splits the set of a direction at its widest gap along the mean normal if the two sides are parallel
    /// sheets: on one curved sheet the chord between the sides' centroids would be perpendicular to the sum
    /// of their normals.
    void split_parallel_sheets(std::uint8_t k) {
        while (static_cast<int>(modes_.size()) < options_.max_sets) {
            offsets_.clear();
            double lowest = std::numeric_limits<double>::infinity(), highest = -lowest;
            for_each(k, [&](Index i) {
                offsets_.emplace_back(modes_[k] | octree_.positions[i], i);
                lowest = std::min(lowest, offsets_.back().first);
                highest = std::max(highest, offsets_.back().first);
            });
            // No gap is wider than all: so it is in most voxels.
            if (!(highest - lowest > options_.sheet_gap * voxel_size_)) return;
            std::sort(offsets_.begin(), offsets_.end());
            const std::size_t cut = where_to_cut(modes_[k]);
            if (cut == 0) return;
            const auto added = static_cast<std::uint8_t>(modes_.size());
            modes_.push_back(modes_[k]);
            // The first point's part keeps its label, whichever way normals point.
            const auto first = std::ranges::min_element(offsets_, {}, &std::pair<double, Index>::second);
            const bool relabel_above = first - offsets_.begin() < static_cast<std::ptrdiff_t>(cut);
            for (std::size_t i = relabel_above ? cut : 0; i < (relabel_above ? offsets_.size() : cut); ++i)
                label_[offsets_[i].second - begin_] = added;
            split_parallel_sheets(added);
        }
    }

    /// Where to cut the sorted offsets: behind the widest gap between two parallel sheets that merge_layers
    /// does not keep together; 0 if there is none.
    std::size_t where_to_cut(const Vec3& mode) const {
        const double least = options_.sheet_gap * voxel_size_;
        double last_gap = std::numeric_limits<double>::infinity(); // the gap tried before
        std::size_t last = 0;
        while (true) {
            std::size_t cut = 0;
            double widest = least;
            for (std::size_t i = 1; i < offsets_.size(); ++i) {
                const double gap = offsets_[i].first - offsets_[i - 1].first;
                const bool is_next = gap < last_gap || (gap == last_gap && i > last);
                if (gap > widest && is_next) widest = gap, cut = i;
            }
            if (cut == 0 || !parallel_sides(cut)) return 0;
            if (!options_.merge_layers || !double_layer(mode, cut)) return cut;
            // try the next narrower gap: a sheet that faces back may lie in it
            last_gap = widest, last = cut;
        }
    }

    /// Two sheets of a solid that lie over each other and face the same way have one between them that faces
    /// back. If there is none they are one surface scanned twice, unless they lie side by side (a step).
    bool double_layer(const Vec3& mode, std::size_t cut) const {
        const auto [below, width_below] = across(mode, 0, cut);
        const auto [above, width_above] = across(mode, cut, offsets_.size());
        if ((above - below).norm() > std::max(width_below, width_above)) return false;
        for (Index i = 0; i < size_; ++i) {
            if (!has_normal(i) || (normal(i) | mode) > -angles::halfway) continue;
            const double offset = mode | octree_.positions[begin_ + i];
            if (offset > offsets_[cut - 1].first && offset < offsets_[cut].first) return false;
        }
        return true;
    }

    /// Of the points `from` to `to` in order of offset: their mean without its component along the mode, and
    /// their root mean square distance from it, across the mode.
    std::pair<Vec3, double> across(const Vec3& mode, std::size_t from, std::size_t to) const {
        const auto flat = [&](std::size_t i) {
            const Vec3& p = octree_.positions[offsets_[i].second];
            return Vec3(p - mode * (mode | p));
        };
        Vec3 mean(0, 0, 0);
        for (std::size_t i = from; i < to; ++i) mean += flat(i);
        mean /= static_cast<double>(to - from);
        double squares = 0;
        for (std::size_t i = from; i < to; ++i) squares += (flat(i) - mean).sqrnorm();
        return {mean, std::sqrt(squares / static_cast<double>(to - from))};
    }

    bool parallel_sides(std::size_t cut) const {
        auto mean = [&](std::size_t from, std::size_t to, const std::vector<Vec3>& values) {
            Vec3 sum(0, 0, 0);
            for (std::size_t i = from; i < to; ++i) sum += values[offsets_[i].second];
            return Vec3(sum / static_cast<double>(to - from));
        };
        const std::size_t n = offsets_.size();
        const Vec3 chord = mean(cut, n, octree_.positions) - mean(0, cut, octree_.positions);
        const Vec3 normals =
            mean(cut, n, octree_.normals).normalized() + mean(0, cut, octree_.normals).normalized();
        return std::abs(chord | normals) > options_.sheet_gap * voxel_size_ * normals.norm();
    }

    const Octree& octree_;
    Index begin_, size_;
    double voxel_size_;
    const NormalSetOptions& options_;
    double cos_cluster_;
    std::vector<std::uint8_t>& label_;
    std::vector<std::pair<double, Index>>& offsets_;
    std::vector<Index>& points_;
    std::vector<CreaseSample>& samples_;
    std::vector<std::uint8_t>& face_;
    std::vector<Vec3>& modes_;
};

void validate(const NormalSetOptions& options) {
    check_option(options.cluster_angle > 0 && options.cluster_angle < 1.5707963, "cluster_angle",
                 options.cluster_angle, "lie in (0, pi/2)");
    check_option(options.sheet_gap > 0, "sheet_gap", options.sheet_gap, "be positive");
    check_option(options.max_sets >= 1 && options.max_sets <= 8, "max_sets", options.max_sets,
                 "lie in [1, 8]");
}

} // namespace

NormalSet measure_set(const Octree& octree, std::span<const Index> points, Index voxel, double voxel_size) {
    Vec3 position(0, 0, 0), normal(0, 0, 0);
    for (Index i : points) {
        position += octree.positions[i];
        normal += octree.normals[i];
    }
    const auto n = static_cast<Index>(points.size());
    if (n == 0) return {position, normal, 0, voxel, {}, 0};
    position /= n;
    const Vec3 mean = normal / n;
    double below = 0; // curvature times variance, summed over the two tangent directions
    Spread spread;
    for (Index i : points) {
        const Vec3 d = octree.positions[i] - position;
        below += (octree.normals[i] - mean) | d;
        const std::array<double, 6> products{d[0] * d[0], d[1] * d[1], d[2] * d[2],
                                             d[0] * d[1], d[1] * d[2], d[2] * d[0]};
        for (std::size_t m = 0; m < 6; ++m) spread.moments[m] += products[m] / n;
    }
    const double length = normal.norm();
    normal = length > 0 ? normal / length : Vec3(0, 0, 1);
    // Limited, because noise in the normals must not push the centroid out of its own points.
    const double lift =
        std::clamp(0.5 * below / n, -sheets::plane_error * voxel_size, sheets::plane_error * voxel_size);
    return {position + normal * lift, normal, n, voxel, spread, below / n};
}

NormalSets build_normal_sets(const Octree& octree, const OctreeLevel& level,
                             const NormalSetOptions& options) {
    validate(options);
    NormalSets result;
    assign_large(result.first, level.size() + 1, 0);
    if (!octree.has_normals()) {
        assign_large(result.of_point, octree.size(), NormalSets::no_set);
        return result;
    }
    resize_unwritten(result.of_point, octree.size());

    tbb::enumerable_thread_specific<Scratch> scratch;
    const double cos_cluster = std::cos(options.cluster_angle);
    const auto cluster = [&](std::size_t first, std::size_t last, std::vector<NormalSet>& sets) {
        Scratch& own = scratch.local();
        std::array<NormalSet, NormalSets::most_per_voxel> found;
        for (auto v = static_cast<Index>(first); v < last; ++v) {
            const Index begin = level.first_point[v], end = level.first_point[v + 1];
            VoxelClusters clusters(octree, begin, end, level.voxel_size, options, cos_cluster, own);
            clusters.run();
            std::array<std::uint8_t, 8> order{};
            std::size_t n = 0;
            for (std::size_t k = 0; k < clusters.count(); ++k) {
                found[k] = clusters.set(k, v);
                if (found[k].count > 0) order[n++] = static_cast<std::uint8_t>(k);
            }
            if (n > 1)
                std::stable_sort(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(n),
                                 [&](auto a, auto b) { return found[a].count > found[b].count; });
            std::array<std::uint8_t, 8> rank{};
            for (std::size_t k = 0; k < n; ++k) {
                sets.push_back(found[order[k]]);
                rank[order[k]] = static_cast<std::uint8_t>(k);
            }
            for (Index i = begin; i < end; ++i) {
                const std::uint8_t label = clusters.label(i - begin);
                result.of_point[i] = label == unassigned ? NormalSets::no_set : rank[label];
            }
            result.first[v + 1] = static_cast<Index>(n);
        }
    };
    result.sets = collected<NormalSet>(level.size(), chunks::slow, cluster);
    counts_to_first(result.first);
    return result;
}

} // namespace hsdm
