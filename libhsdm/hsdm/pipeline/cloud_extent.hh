#pragma once
// What one pass over the points of a cloud that is not in memory finds: how many, and where.

#include "hsdm/cloud/cloud_frame.hh"
#include "hsdm/core/ranks.hh"
#include "hsdm/normals/orient_normals.hh"
#include "hsdm/pipeline/attribute_rows.hh"
#include "hsdm/pipeline/reconstruct_in_tiles.hh"

#include <optional>
#include <span>

namespace hsdm {

/// Throws RefusedInTiles of a cloud that can be reconstructed, but not in tiles.
[[noreturn]] void refuse_in_tiles(const std::string& what);

/// What is known of where the points were seen from.
struct CloudScanners {
    std::optional<Vec3> sensor{}; ///< as PointCloud::sensor
    std::vector<Vec3> sensors{};  ///< as PointCloud::sensors, each place once

    /// Of the cloud -> relative to the cube there.
    CloudScanners placed(const CloudFrame& frame, const Vec3& origin) const;
    void move(const Vec3& by);
    /// Which of the sensors saw a point is not told by it.
    OrientOptions orientation() const;
    /// Of a part of the cloud, by its own numbers, the numbers that its scanners have here, or -1.
    std::vector<std::int32_t> numbers_in(const PointView& part) const;
    void put(Ranks::Bytes& bytes) const;
    static CloudScanners from(ByteReader& bytes);
};

/// The scanners that a part of a cloud tells of: those of PointCloud::sensors, or that of PointCloud::sensor.
std::span<const Vec3> scanners_in(const PointView& part);
/// By its own numbers, which of them saw a point; -1: none.
std::int32_t scanner_of(const PointView& part, std::size_t point);

/// What a pass over the points finds.
struct CloudExtent {
    std::size_t points = 0, nonfinite = 0;
    std::size_t first_nonfinite = 0; ///< if there is one
    Box box;                         ///< of those that are finite
    bool has_normals = false;        ///< have all, or none?
    CloudScanners scanners{};
    CloudAttributes attributes{};

    std::size_t finite() const { return points - nonfinite; }

    /// Some points of this rank's part, each standing for so many.
    std::vector<Vec3> sample{};
    std::size_t sample_stride = 1;
};

inline constexpr std::size_t most_sampled = std::size_t{1} << 16; ///< points of a rank

/// One pass over the points, each rank over its part: what all of them find. Throws Error for what is no
/// cloud, or none that is done in tiles.
CloudExtent measure_extent(const PointParts& parts, Ranks& ranks);

/// As bytes, but for the sample.
void put_extent(const CloudExtent& extent, Ranks::Bytes& bytes);
CloudExtent extent_from(ByteReader& bytes);

} // namespace hsdm
