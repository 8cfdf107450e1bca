#include "hsdm/contour/middle_discs.hh"

#include "hsdm/contour/disc_lanes.hh"
#include "hsdm/core/constants.hh"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

namespace hsdm {
namespace {

constexpr std::size_t word_bits = discs_of_word;

} // namespace

void MiddleDiscs::reset(std::size_t places, std::size_t surfaces, const Vec3& amid, double voxel_size) {
    discs_.clear();
    words_ = 0;
    place_count_ = places;
    surface_count_ = surfaces;
    amid_ = amid;
    per_voxel_ = 1 / voxel_size;
}

/// Discs that fill up the last word are all zeros: no place is behind one.
void MiddleDiscs::lay_out() {
    words_ = (discs_.size() + word_bits - 1) / word_bits;
    flat_.assign(words_ * 6 * word_bits, 0);
    near_.assign(words_ * 4 * word_bits, 0);
    for (std::size_t d = 0; d < discs_.size(); ++d) {
        double* const at = flat_.data() + d / word_bits * 6 * word_bits + d % word_bits;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            at[axis * word_bits] = discs_[d].normal[axis];
            at[(axis + 3) * word_bits] = discs_[d].middle[axis];
        }
        const Vec3 from = (discs_[d].middle - amid_) * per_voxel_;
        float* const near = near_.data() + d / word_bits * 4 * word_bits + d % word_bits;
        for (std::size_t axis = 0; axis < 3; ++axis) near[axis * word_bits] = static_cast<float>(from[axis]);
        near[3 * word_bits] = static_cast<float>(std::sqrt(discs_[d].squared_radius) * per_voxel_);
    }
    sides_.resize(place_count_ * words_);
    standing_.resize(surface_count_ * words_);
    has_sides_.assign(place_count_, Known::no);
    has_standing_.assign(surface_count_, Known::no);
}

const MiddleDiscs::Word* MiddleDiscs::sides(const Place& place) {
    Word* const row = sides_.data() + place.number * words_;
    Known& known = has_sides_[place.number];
    if (known == Known::no)
        for (std::size_t w = 0; w < words_; ++w)
            row[w] = lanes_.behind(flat_.data() + w * 6 * word_bits, place.position.data());
    known = Known::yes;
    return row;
}

/// Null if none stands on the surface.
const MiddleDiscs::Word* MiddleDiscs::standing(const Surface& surface) {
    if (discs_.empty()) return nullptr;
    if (words_ == 0) lay_out();
    Word* const row = standing_.data() + surface.number * words_;
    Known& known = has_standing_[surface.number];
    if (known == Known::no) {
        std::fill_n(row, words_, 0);
        known = Known::none;
        for (std::size_t d = 0; d < discs_.size(); ++d) {
            if (!(std::abs(surface.normal | discs_[d].normal) <= angles::halfway)) continue;
            row[d / word_bits] |= Word{1} << d % word_bits;
            known = Known::yes;
        }
    }
    return known == Known::yes ? row : nullptr;
}

bool MiddleDiscs::stand_on(const Surface& surface) {
    return standing(surface) != nullptr;
}

bool MiddleDiscs::part(const Place& p, const Place& q, const Surface& surface) {
    const Word* const here = standing(surface);
    if (here == nullptr) return false;
    const Word *const behind_p = sides(p), *const behind_q = sides(q);
    std::array<unsigned, 2> seen{0, 0}; // sheets of walls, of gaps
    const Vec3 way = q.position - p.position, middle = (p.position + way * 0.5 - amid_) * per_voxel_;
    const std::array<float, 4> of_way{static_cast<float>(middle[0]), static_cast<float>(middle[1]),
                                      static_cast<float>(middle[2]),
                                      static_cast<float>(0.5 * way.norm() * per_voxel_)};
    for (std::size_t w = 0; w < words_; ++w) {
        Word crossed = (behind_p[w] ^ behind_q[w]) & here[w];
        if (crossed != 0) crossed = lanes_.near_way(near_.data() + w * 4 * word_bits, crossed, of_way.data());
        for (; crossed != 0; crossed &= crossed - 1) {
            const MiddleDisc& disc =
                discs_[w * word_bits + static_cast<std::size_t>(std::countr_zero(crossed))];
            const double dp = disc.normal | (p.position - disc.middle),
                         dq = disc.normal | (q.position - disc.middle);
            const Vec3 x = p.position + way * (dp / (dp - dq));
            if ((x - disc.middle).sqrnorm() > disc.squared_radius) continue;
            // At the mouth of a gap its sheets lie below the surface, on the ground of a wall above it; the
            // rim of a wall and the bottom of a gap, which join the two sheets, see them on the other side.
            if (((surface.normal | (disc.point - x)) < 0) != disc.is_gap) continue;
            unsigned& sheets = seen[disc.is_gap];
            sheets |= dp < 0 ? 1u : 2u;
            if (sheets == 3) return true;
        }
    }
    return false;
}

} // namespace hsdm
