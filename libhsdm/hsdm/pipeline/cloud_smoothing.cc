#include "hsdm/pipeline/cloud_smoothing.hh"

#include "hsdm/core/chunks.hh"
#include "hsdm/core/large_vector.hh"
#include "hsdm/normals/plane_smoothing.hh"
#include "hsdm/pipeline/cell_attributes.hh"
#include "hsdm/pipeline/nth_of_all.hh"
#include "hsdm/pipeline/tile_plan.hh"

#include <algorithm>
#include <cmath>

namespace hsdm {
namespace {

/// Where points came to lie, and how far along an axis the farthest was moved.
struct MovedBox {
    Box box;
    double farthest = 0;

    void add(const Vec3& from, const Vec3& to) {
        box.add(to);
        farthest = std::max(farthest, (to - from).max_abs());
    }
    void add(const MovedBox& other) {
        box.add(other.box);
        farthest = std::max(farthest, other.farthest);
    }
};

MovedBox of_all(const MovedBox& own, Ranks& ranks) {
    Ranks::Bytes bytes;
    put(own, bytes);
    MovedBox all;
    for (const Ranks::Bytes& got : ranks.gather(bytes)) all.add(ByteReader(got).take<MovedBox>());
    return all;
}

SheetCounts of_all(const SheetCounts& own, Ranks& ranks) {
    Ranks::Bytes bytes;
    for (const double count : {own.points, own.at_ends, own.ends_of_two}) put(count, bytes);
    put(own.strips, bytes);
    put_vector(own.noises, bytes);
    SheetCounts all;
    for (const Ranks::Bytes& got : ranks.gather(bytes)) {
        ByteReader reader(got);
        SheetCounts of_rank;
        for (double* const count : {&of_rank.points, &of_rank.at_ends, &of_rank.ends_of_two})
            *count = reader.take<double>();
        of_rank.strips = reader.take<SheetStrips>();
        of_rank.noises = reader.take_vector<double>();
        all += of_rank;
    }
    return all;
}

/// Points of a part of which not all is known might go anywhere, but must not get among those of which it is.
void keep_within(const std::vector<Vec3>& from, const MovedBox& all, std::vector<Vec3>& to) {
    const double far = all.farthest * (1 + 1e-9) + 1e-15 * all.box.extent(); // no known one goes as far
    for_each_index(to.size(), chunks::light, [&](Index i) {
        for (unsigned k = 0; k < 3; ++k) {
            to[i][k] = std::clamp(to[i][k], from[i][k] - far, from[i][k] + far);
            to[i][k] = std::clamp(to[i][k], all.box.lo[k], all.box.hi[k]);
        }
    });
}

/// The steps of smooth_points(), each a pass over tiles that finds what the next one must know of all points.
class CloudSmoother {
public:
    CloudSmoother(const ScratchCloud& cloud, const CloudSurvey& survey, const PlanRanges& plan)
        : plan_(plan),
          spacing_(estimate_spacing(survey.sums.counts(), cloud.cube_extent())),
          to_voxel_(3 * (morton_levels - cloud.depth())) {}

    /// Finds how points are moved; `noise` becomes what it was. Points are read `most` at a time.
    void find_moves(ScratchCloud& cloud, double& noise, std::size_t most) {
        box_ = cloud.box_in_cube(most);
        for (int round = 0; round < enough_rounds; ++round) {
            planes_.emplace(spacing_, noise);
            const double found = measure_planes(cloud);
            if (!is_clearly_less(found, noise)) break;
            noise = found;
        }
        if (cloud.has_normals()) return;
        const double of_each = planes_->noise_of_two_sheets(count_sheets(cloud));
        if (of_each <= 0) return;
        noise = of_each;
        finer_.emplace(PlaneSmoothing::between_sheets(spacing_, of_each));
        measure_finer_planes(cloud);
    }

    /// move(octree, point, position) of all of this rank's points.
    template <class Move>
    void for_moved(ScratchCloud& cloud, const Move& move) {
        const auto visit = [&](const Octree& part, Index begin, Index end, const MovedPoints& moved) {
            for (Index i = begin; i < end; ++i) move(part, i, moved.positions[i]);
        };
        if (finer_)
            for_tiles(cloud, width_of_finer() + width_of(*finer_, finer_moved_),
                      [&](const Octree& part, Index begin, Index end) {
                          MovedPoints moved = onto_finer_planes(part);
                          keep_within(part.positions, finer_moved_, moved.positions);
                          undo_shrinking(*finer_, finer_moved_.box, part, moved);
                          visit(part, begin, end, moved);
                      });
        else
            for_tiles(cloud, planes_->width_of_planes() + width_of(*planes_, moved_),
                      [&](const Octree& part, Index begin, Index end) {
                          MovedPoints moved = onto_planes(part);
                          undo_shrinking(*planes_, moved_.box, part, moved);
                          visit(part, begin, end, moved);
                      });
    }

private:
    /// visit(octree, begin, end) of each tile's own points, with all within `width` around.
    template <class Visit>
    void for_tiles(ScratchCloud& cloud, double width, const Visit& visit) {
        const double voxels = std::ceil(width / cloud.voxel_size());
        if (voxels > most_ghost_voxels) refuse_in_tiles("the noise is wider than tiles see");
        const int ghost = static_cast<int>(voxels) + 1; // for what was rounded
        cloud.for_tiles(plan_(cloud, ghost), ghost, [&](const Octree& octree, const VoxelRange& range) {
            const auto first_of = [&](MortonCode code) {
                return static_cast<Index>(std::ranges::lower_bound(octree.codes, code << to_voxel_)
                                          - octree.codes.begin());
            };
            visit(octree, first_of(range.begin), first_of(range.end));
        });
    }

    /// What lies around a moved point may have come from twice the farthest way off.
    static double width_of(const PlaneSmoothing& smoothing, const MovedBox& moved) {
        return smoothing.width_around() + 2 * moved.farthest;
    }
    double width_of_finer() const { return std::max(planes_->width_of_planes(), finer_->width_of_planes()); }

    /// Returns the noise that the moves tell.
    double measure_planes(ScratchCloud& cloud) {
        std::vector<float> moves;
        MovedBox own;
        for_tiles(cloud, planes_->width_of_planes(), [&](const Octree& part, Index begin, Index end) {
            const MovedPoints moved = planes_->onto_planes(part.positions, box_);
            for (Index i = begin; i < end; ++i) {
                own.add(part.positions[i], moved.positions[i]);
                push_large(moves, static_cast<float>((moved.positions[i] - part.positions[i]).norm()));
            }
        });
        moved_ = of_all(own, cloud.ranks());
        const std::size_t points = cloud.ranks().sum(moves.size());
        return noise_of_move(nth_of_all(moves, moves_below(points), cloud.ranks()));
    }

    SheetCounts count_sheets(ScratchCloud& cloud) {
        SheetCounts own;
        for_tiles(cloud, planes_->width_of_planes() + width_of(*planes_, moved_),
                  [&](const Octree& part, Index begin, Index end) {
                      const MovedPoints moved = onto_planes(part);
                      own +=
                          planes_->count_sheets(part.positions, planes_->around(moved.positions, moved_.box),
                                                moved, [&](Index i) { return i >= begin && i < end; });
                  });
        return of_all(own, cloud.ranks());
    }

    MovedPoints onto_finer_planes(const Octree& part) const {
        MovedPoints moved = planes_->onto_planes(part.positions, box_);
        return finer_->onto_planes(part.positions, box_, std::move(moved.normals));
    }

    void measure_finer_planes(ScratchCloud& cloud) {
        MovedBox own;
        for_tiles(cloud, width_of_finer(), [&](const Octree& part, Index begin, Index end) {
            const MovedPoints moved = onto_finer_planes(part);
            for (Index i = begin; i < end; ++i) own.add(part.positions[i], moved.positions[i]);
        });
        finer_moved_ = of_all(own, cloud.ranks());
    }

    /// Once it is known how far points move.
    MovedPoints onto_planes(const Octree& part) const {
        MovedPoints moved = planes_->onto_planes(part.positions, box_);
        keep_within(part.positions, moved_, moved.positions);
        return moved;
    }
    static void undo_shrinking(const PlaneSmoothing& smoothing, const Box& box, const Octree& part,
                               MovedPoints& moved) {
        smoothing.undo_shrinking(part.positions, smoothing.around(moved.positions, box), moved);
    }

    const PlanRanges& plan_;
    double spacing_;
    int to_voxel_;
    Box box_;
    std::optional<PlaneSmoothing> planes_, finer_; // finer ones if there are two sheets
    MovedBox moved_, finer_moved_;
};

/// Moves the points; `as_read` becomes where they were, with where they went in place of normals.
double move_points(ScratchCloud& cloud, const CloudSurvey& survey, double noise, const PlanRanges& plan,
                   std::size_t most, std::optional<ScratchCloud>& as_read) {
    CloudSmoother smoother(cloud, survey, plan);
    smoother.find_moves(cloud, noise, most);
    ScratchCloud next = cloud.emptied(cloud.has_normals(), true);
    as_read.emplace(cloud.emptied(true, false));
    CellAttributes beside(cloud);
    next.fill([&](const ScratchCloud::PutRow& put_row) {
        smoother.for_moved(cloud, [&](const Octree& part, Index i, const Vec3& to) {
            PointRow row = ScratchCloud::row_at(part, i), before = row;
            std::copy_n(to.data(), 3, row.begin());
            std::copy_n(to.data(), 3, before.begin() + 3);
            put_row(row, beside.of(part, i));
            as_read->add(part.codes[i], before, nullptr);
        });
    });
    as_read->finish_sorted();
    cloud.take(std::move(next));
    return noise;
}

/// Leaves out the points that went where these are.
void leave_out_moved(std::vector<PointRow>&& gone, std::size_t most, ScratchCloud& as_read) {
    const auto place = [](const PointRow& row) { return std::array{row[0], row[1], row[2]}; };
    std::ranges::sort(gone, {}, place);
    ScratchCloud left = as_read.emptied(true, false);
    as_read.for_groups(most, [&](const Octree& part) {
        for (std::size_t i = 0; i < part.size(); ++i) {
            const Vec3& to = part.normals[i];
            if (!std::ranges::binary_search(gone, std::array{to[0], to[1], to[2]}, {}, place))
                left.add(part, i);
        }
    });
    left.finish_sorted();
    as_read.take(std::move(left));
}

} // namespace

SmoothReport smooth_cloud(ScratchCloud& cloud, CloudSurvey& survey, double noise, const PlanRanges& plan,
                          std::size_t most, PartStore& store, std::optional<ScratchCloud>& as_read) {
    SmoothReport report;
    report.noise = move_points(cloud, survey, noise, plan, most, as_read);
    survey = survey_cloud(cloud, survey.sums.points(), most);
    std::vector<PointRow> gone;
    report.between = leave_outliers_out(cloud, survey, plan, most, store, outliers_between_sheets(), gone);
    if (report.between.count > 0) leave_out_moved(std::move(gone), most, *as_read);
    return report;
}

} // namespace hsdm
