#pragma once
// Walls and gaps thinner than a voxel, as discs of the surface midway between their two sheets: what they
// part.

#include "hsdm/contour/disc_lanes.hh"
#include "hsdm/types.hh"

#include <cstdint>
#include <span>
#include <vector>

namespace hsdm {

/// A disc of the middle surface of a wall or gap, seen from a point of one of its two sheets.
struct MiddleDisc {
    Vec3 middle;
    Vec3 normal; ///< of that sheet
    Vec3 point;  ///< of that sheet
    double squared_radius;
    bool is_gap; ///< the sheets face each other
};

/// The discs round one voxel. Places and surfaces near them have numbers, as each is asked for with many
/// others: on which sides of the discs a place lies and which stand on a surface is looked up once.
class MiddleDiscs {
public:
    struct Surface {
        std::size_t number;
        const Vec3& normal;
    };

    /// Without discs. Places, which must outlive the questions, and so many surfaces, all within a few voxels
    /// of `amid`.
    void reset(std::span<const Vec3> places, std::size_t surfaces, const Vec3& amid, double voxel_size);
    /// Discs seen from one sheet, of one normal. Before the first question.
    void add(std::span<const MiddleDisc> discs);

    /// Does any wall or gap stand on a surface: across it rather than along it?
    bool stand_on(const Surface& surface) { return standing(surface) != nullptr; }
    /// Does one that stands on one of these surfaces, two at most, part two places, by their numbers, on it?
    bool part(std::size_t p, std::size_t q, std::span<const Surface> surfaces);

private:
    using Word = std::uint64_t; ///< a bit for each of 64 discs
    class Question;

    void lay_out();
    void lay_out(std::size_t disc);
    const Word* sides(std::size_t place);
    const Word* standing(const Surface& surface);

    const DiscLanes& lanes_ = disc_lanes().front();
    std::span<const Vec3> places_;
    std::size_t surface_count_ = 0;
    Vec3 amid_{0, 0, 0};
    double per_voxel_ = 0;
    std::vector<MiddleDisc> discs_;
    std::vector<std::size_t> first_of_sheet_; // discs seen from one sheet lie together
    std::size_t words_ = 0;                   // of a row; 0: not laid out yet
    std::vector<double> flat_;                // of 64 discs six rows: of their normals and their middles
    std::vector<float> near_; // of 64 discs four rows: of their middles, from amid_, and radii, in voxels
    std::vector<Word> gaps_;  // a row: those that are no walls
    std::vector<Word> sides_, standing_; // a row for each place, for each surface
    enum class Known : std::uint8_t { no, yes, none };
    std::vector<Known> has_sides_, has_standing_; // none: known that it has no bit
};

} // namespace hsdm
