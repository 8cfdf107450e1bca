#pragma once
// Nearest points of a set, exactly, from any places.

#include "hsdm/types.hh"

#include <memory>
#include <span>
#include <vector>

namespace hsdm {

/// A point of the set.
struct NearPoint {
    Index index;     ///< in the set
    double distance; ///< from the place asked for, in the points' units
};

/// The points near each of many places, place after place as flat arrays: those near place p are
/// index[first[p]]
/// .. index[first[p + 1] - 1], nearest first, of equally near ones that with the lower index.
struct NearPoints {
    std::vector<std::size_t> first{0}; ///< places + 1
    std::vector<Index> index;          ///< in the set
    std::vector<double> distance;      ///< of each, in the points' units

    /// How many places there are.
    std::size_t places() const { return first.size() - 1; }
    /// Those near one place.
    std::span<const Index> of(std::size_t place) const {
        return {index.data() + first[place], index.data() + first[place + 1]};
    }
    /// How far they are.
    std::span<const double> distances_of(std::size_t place) const {
        return {distance.data() + first[place], distance.data() + first[place + 1]};
    }
};

/// A k-d tree over points, searched from any number of threads at once. Every answer is exact, in double
/// precision, and the same for any number of threads; equally near points come in the order of their indices.
/// Queries take places in the order of a space-filling curve, so their own order costs nothing. All throw
/// Error for a place that is not finite, or so far from the points that no double holds the distance's
/// square.
class NeighborSearch {
public:
    /// O(n log n), parallel; 45 bytes a point. The points must outlive it. Throws Error if there are none or
    /// more than 2^31 - 1, for a coordinate that is not finite, or if they are out of
    /// CloudFrame::check_reach().
    explicit NeighborSearch(std::span<const Vec3> points);
    NeighborSearch(NeighborSearch&& other) noexcept; ///< leaves nothing that could be searched
    ~NeighborSearch();

    /// Number of points.
    std::size_t size() const { return points_.size(); }

    /// The nearest point. O(log n).
    NearPoint nearest(const Vec3& place) const;
    /// The `count` nearest points of each place, all points if there are no more. Throws OptionError unless
    /// count > 0. O(places log n) for few, parallel.
    NearPoints nearest(std::span<const Vec3> places, int count) const;
    /// The same among the points within `radius`: so many at most. Throws OptionError unless count > 0 and
    /// the radius is a number that is not negative.
    NearPoints nearest_within(std::span<const Vec3> places, int count, double radius) const;
    /// All points within `radius` of each place, at distances up to and with it. Throws OptionError unless
    /// the radius is a number that is not negative. O(places log n + found), parallel.
    NearPoints within(std::span<const Vec3> places, double radius) const;
    /// The `count` nearest others of every point, all others if there are no more: points at the same place
    /// are neighbours of each other, none is its own. Otherwise as nearest().
    NearPoints neighbors(int count) const;

private:
    struct Tree;

    std::span<const Vec3> points_;
    std::unique_ptr<Tree> tree_;
};

} // namespace hsdm
