#pragma once
// What one pass over the points of a cloud that is not in memory finds: how many, and where.

#include "hsdm/cloud/cloud_frame.hh"
#include "hsdm/core/ranks.hh"
#include "hsdm/pipeline/attribute_rows.hh"
#include "hsdm/pipeline/cloud_scanners.hh"
#include "hsdm/pipeline/reconstruct_in_tiles.hh"

namespace hsdm {

/// Throws RefusedInTiles of a cloud that can be reconstructed, but not in tiles.
[[noreturn]] void refuse_in_tiles(const std::string& what);

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
