#pragma once
// Walls and gaps thinner than a voxel, as discs of the surface midway between their two sheets: what they
// part.

#include "hsdm/contour/disc_lanes.hh"
#include "hsdm/core/vector_pair.hh"
#include "hsdm/types.hh"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace hsdm {

/// A disc of the middle surface of a wall or gap, seen from a point of one of its two sheets.
struct SeenDisc {
    Vec3 point;
    double off; ///< from there to the disc's middle, along the normal of that sheet: ahead are gaps
    double radius;
};

/// The discs round one voxel. Places and surfaces near them have numbers, as each is asked for with many
/// others: on which sides of the discs a place lies and which stand on a surface is looked up once.
class MiddleDiscs {
public:
    struct Surface {
        std::size_t number;
        const Vec3& normal;
    };

    /// Without discs. So many surfaces, all within a few voxels of `amid`.
    void reset(std::size_t surfaces, const Vec3& amid, double voxel_size);
    /// Discs seen from one sheet, of this normal, which must outlive the questions. Before the first one.
    void add(const Vec3& normal, std::span<const SeenDisc> discs);
    /// Places to be asked for, which must outlive the questions.
    void set_places(std::span<const Vec3> places);

    /// Does any wall or gap stand on a surface: across it rather than along it?
    bool stand_on(const Surface& surface) { return standing(surface) != nullptr; }
    /// Turns to ways within a box on these surfaces, two at most. False if no disc can part any of them.
    bool look_at(std::span<const Surface> surfaces, const Box& box);
    /// Does a wall or gap part two places, by their numbers, of the box and on the surfaces that were last
    /// looked at?
    bool part(std::size_t p, std::size_t q);

private:
    using Word = std::uint64_t; ///< a bit for each of 64 discs

    struct Asked { ///< a surface: the discs that stand on it
        const Word* standing;
        Vec3 normal;
    };
    struct Sheet {
        Vec3 normal;
        std::span<const SeenDisc> discs;
        std::size_t first; ///< number of its first disc
    };
    struct Disc {
        Vec3 middle, normal, point;
        double squared_radius;
        bool is_gap;
    };
    struct Near { // discs of one word, and what of them a way crosses
        std::size_t word;
        Word discs, behind, crossed; ///< behind: those that the way begins behind
    };

    void begin_questions();
    void lay_out(std::size_t word);
    void lay_out(std::size_t disc, const Vec3& normal, const SeenDisc& seen);
    std::array<float, 4> ball(const Vec3& middle, double length) const;
    bool find_crossed(std::size_t p, std::size_t q);
    unsigned crossed_on(std::size_t p, std::size_t q, unsigned surfaces, bool gaps, bool behind,
                        bool all) const;
    Word side(std::size_t place, std::size_t word);
    const Word* standing(const Surface& surface);

    const DiscLanes& lanes_ = disc_lanes().front();
    std::span<const Vec3> places_;
    std::size_t surface_count_ = 0;
    Vec3 amid_{0, 0, 0};
    double per_voxel_ = 0;
    std::vector<Sheet> sheets_;             // in the order of their discs
    std::size_t count_ = 0;                 // of discs
    std::size_t words_ = 0;                 // of a row; 0: nothing was asked yet
    std::vector<VectorPair> normals_;       // of the sheets, two by two
    std::vector<std::uint8_t> is_laid_out_; // per word: what follows, by disc
    std::vector<Disc> discs_;
    std::vector<double> flat_; // of 64 discs six rows: of their normals and their middles
    std::vector<float> near_;  // of 64 discs four rows: of their middles, from amid_, and radii, in voxels
    std::vector<Word> gaps_;   // a row: those that are no walls
    std::vector<Word> sides_, standing_; // a row for each place, for each surface
    std::vector<std::uint8_t> has_side_; // for each word of these rows
    enum class Known : std::uint8_t { no, yes, none };
    std::vector<Known> has_standing_; // none: known that it has no bit
    std::array<Asked, 2> asked_;      // what was last looked at
    unsigned asked_count_ = 0;
    std::vector<Near> looked_at_;
};

} // namespace hsdm
