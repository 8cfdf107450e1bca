#pragma once
// The input of every reconstruction: scanned points and what the scanner said of each.

#include "hsdm/types.hh"

#include <array>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace hsdm {

/// One more value per point (intensity, quality, label ...), by the name its file gave it.
struct Scalar {
    std::string name;           ///< as the file gave it
    std::vector<double> values; ///< one per point
    bool is_label = false;      ///< integers that must not be averaged: a vertex takes the majority's
};

/// Whether no coordinate is NaN or Inf. O(n), parallel.
bool all_finite(std::span<const Vec3> positions);
/// The box of positions; empty if there are none. O(n), parallel.
Box bounds_of(std::span<const Vec3> positions);

/// Points in the cloud's units, structure of arrays. Optional arrays are empty or hold one entry per point.
struct PointCloud {
    std::vector<Vec3> positions; ///< in the cloud's units
    std::vector<Vec3> normals;   ///< as the file gave them; not required to be unit vectors or outward
    std::vector<std::array<std::uint8_t, 4>> colors; ///< red, green, blue, alpha
    std::vector<Scalar> scalars;                     ///< further values, each with one entry per point
    std::optional<Vec3> sensor;                      ///< where the scanner stood, if the file says
    /// Where several scanners stood, if that is sure, and per point the number of the one that saw it; a
    /// number that none of them has says nothing of its point. With one scanner the numbers may be missing.
    /// Normals that are estimated, or contradict each other, are turned to them.
    std::vector<Vec3> sensors;
    std::vector<std::int32_t> sensor_of; ///< empty, or one entry per point

    /// Number of points.
    std::size_t size() const { return positions.size(); }
    /// Whether there are normals, of whatever length.
    bool has_normals() const { return !normals.empty(); }
    /// Box of the positions. O(n), parallel.
    Box bounds() const { return bounds_of(positions); }
};

/// Throws Error if an array of the cloud has neither an entry for each point nor, where it may be missing,
/// none: it would be read beyond its end. Every public function that takes a cloud begins with it.
void check_arrays(const PointCloud& cloud);

/// What `drop_nonfinite` removed.
struct Dropped {
    std::size_t nonfinite = 0;       ///< points with NaN or Inf in a coordinate
    std::size_t first_nonfinite = 0; ///< index of the first of them, if there is one
    std::size_t bad_normals = 0;     ///< points kept whose normal was zero or not finite
};

/// Removes the points with a NaN or Inf coordinate, in place and in order; normals that are not finite or
/// zero become (0, 0, 0), which every stage reads as "no normal here". O(n). Throws as check_arrays(), with
/// the cloud as it was.
Dropped drop_nonfinite(PointCloud& cloud);

} // namespace hsdm
