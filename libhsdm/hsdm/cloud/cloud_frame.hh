#pragma once
// Converts between the cloud's coordinates and those that the stages work in.

#include "hsdm/types.hh"

#include <array>
#include <vector>

namespace hsdm {

/// The stages multiply lengths by each other many times over, and lay one grid over everything. So a cloud of
/// extreme size is measured in a unit of its own, and empty space between parts that lie far apart is cut
/// short: work = cloud / unit, less what was cut out below it. For all other clouds, those between 2^-30 and
/// 2^30 across and in one region, both are the same and nothing is computed.
class CloudFrame {
public:
    CloudFrame() = default;
    /// The frame of a cloud with this box, whose corners are finite. The unit is a power of two, so that a
    /// cloud scaled by a power of two is the same cloud to every stage.
    explicit CloudFrame(const Box& cloud);
    /// Throws Error if the box was less than 2^-1000 or more than 2^1020 across: there precision gives out.
    void check_reach() const;

    double unit() const { return unit_; } ///< of the working space's lengths, in the cloud's units
    bool has_cuts() const {
        return !stretches_[0].empty() || !stretches_[1].empty() || !stretches_[2].empty();
    }
    CloudFrame without_cuts() const;

    Vec3 to_work(const Vec3& cloud) const;
    /// The cloud's coordinates of a point; where cuts are, the point must lie within half a kept gap of the
    /// cloud's points.
    Vec3 to_cloud(const Vec3& work) const {
        return unit_ == 1 && !has_cuts() ? work : changed_to_cloud(work);
    }
    /// Per axis, the stretch between cuts that a point lies in, given in coordinates without cuts; the next
    /// function takes coordinates with cuts. Two points of different stretches are farther apart than their
    /// coordinates say.
    std::array<Index, 3> stretch_of_uncut(const Vec3& uncut) const;
    std::array<Index, 3> stretch_of(const Vec3& work) const;
    Box to_cloud(const Box& work) const { return {to_cloud(work.lo), to_cloud(work.hi)}; }

    /// Shortens every gap along an axis, between neighbouring ones of these coordinates, that is wider than
    /// `widest` (the same for all axes) to that width. Coordinates are the working space's without cuts; they
    /// are sorted. The axis must not have been cut before. Returns the longest stretch between cuts.
    /// O(n log n).
    double cut_gaps(unsigned axis, std::vector<double>& coordinates, double widest);

private:
    Vec3 changed_to_cloud(const Vec3& work) const;
    Index stretch_of(double work, unsigned axis) const;
    Index stretch_of_uncut(double uncut, unsigned axis) const;
    /// A stretch: from coordinate `first` on, `shift` has been cut out.
    struct Stretch {
        double first, shift;
    };
    double unit_ = 1;
    std::array<std::vector<Stretch>, 3> stretches_; // ascending; none where nothing is cut
    double widest_ = 0;                             // gap that was kept
};

} // namespace hsdm
