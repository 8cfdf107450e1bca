#pragma once
// How rough a sampled surface is at the scale of its neighbourhoods.

#include "hsdm/normals/neighbors.hh"

#include <array>
#include <optional>
#include <span>

namespace hsdm {

/// Typical distance of a point from the plane of its six nearest neighbours, over the neighbourhood's reach:
/// 0 for clean planes, below 0.01 for well-sampled smooth surfaces, 0.1 where noise is half the spacing of
/// the points. Six are of one sheet even where the sheet is one side of a thin plate. The lower third of a
/// sample, so that creases do not count. O(1) beyond the first 16,384 points.
double estimate_noise(const Octree& octree, const Neighbors& neighbors);

/// Standard deviation of the noise, in the cloud's units: the same distance, of 6 and 12 neighbours and then
/// of those that are left of a cloud thinned to a quarter, a sixteenth, ..., at the first scale at which it
/// is small against the reach. So it is found however many spacings it is, and no scale is looked at that is
/// wider than needed: the sides of a plate or a slit stay apart. O(n).
double noise_deviation(const Octree& octree, const Neighbors& neighbors);

/// One of so many points is in a sample, evenly taken in octree order.
std::size_t noise_stride(std::size_t points);
struct NoiseSample {
    /// The distance from the plane of the 6 and of the 12 nearest, and how far the farthest of these is.
    std::array<double, 2> distance{}, reach{};
    double farthest = 0; ///< how far the farthest of all neighbours is
};
/// estimate_noise() by such samples.
double estimate_noise(std::span<const NoiseSample> samples);
/// Of the 6 nearest alone, for both of what follows: they are sorted once.
std::vector<NoiseSample> noise_samples(const Octree& octree, const Neighbors& neighbors);
/// noise_deviation() by these and, where 6 do not tell, by what it takes more.
double noise_deviation(const Octree& octree, const Neighbors& neighbors,
                       std::span<const NoiseSample> samples);
/// The same of a cloud that is not in memory.
/// `neighbors`: of these points alone.
std::vector<NoiseSample> noise_samples(const Octree& octree, std::span<const Index> points,
                                       const Neighbors& neighbors);
/// From the samples in any order, of a cloud of so many points; nothing where it takes the same of
/// the thinned cloud.
std::optional<double> noise_deviation(std::span<const NoiseSample> samples, std::size_t points);
inline bool is_of_thinned(std::size_t point) {
    return point % 4 == 0;
}

/// Neighbours per point that such noise, measured with 16 of them, calls for: 16, 32 or 64.
int neighbors_for_noise(double noise);

} // namespace hsdm
