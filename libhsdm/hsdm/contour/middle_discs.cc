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

void MiddleDiscs::reset(std::span<const Vec3> places, std::size_t surfaces, const Vec3& amid,
                        double voxel_size) {
    discs_.clear();
    first_of_sheet_.clear();
    words_ = 0;
    places_ = places;
    surface_count_ = surfaces;
    amid_ = amid;
    per_voxel_ = 1 / voxel_size;
}

void MiddleDiscs::add(std::span<const MiddleDisc> discs) {
    if (discs.empty()) return;
    first_of_sheet_.push_back(discs_.size());
    discs_.insert(discs_.end(), discs.begin(), discs.end());
}

void MiddleDiscs::lay_out(std::size_t d) {
    double* const at = flat_.data() + d / word_bits * 6 * word_bits + d % word_bits;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        at[axis * word_bits] = discs_[d].normal[axis];
        at[(axis + 3) * word_bits] = discs_[d].middle[axis];
    }
    const Vec3 from = (discs_[d].middle - amid_) * per_voxel_;
    float* const near = near_.data() + d / word_bits * 4 * word_bits + d % word_bits;
    for (std::size_t axis = 0; axis < 3; ++axis) near[axis * word_bits] = static_cast<float>(from[axis]);
    near[3 * word_bits] = static_cast<float>(std::sqrt(discs_[d].squared_radius) * per_voxel_);
    if (discs_[d].is_gap) gaps_[d / word_bits] |= Word{1} << d % word_bits;
}

void MiddleDiscs::lay_out() {
    words_ = (discs_.size() + word_bits - 1) / word_bits;
    flat_.resize(words_ * 6 * word_bits);
    near_.resize(words_ * 4 * word_bits);
    gaps_.assign(words_, 0);
    // Those that fill up the last word are all zeros: no place is behind one.
    std::fill(flat_.end() - 6 * word_bits, flat_.end(), 0);
    std::fill(near_.end() - 4 * word_bits, near_.end(), 0.0f);
    for (std::size_t d = 0; d < discs_.size(); ++d) lay_out(d);
    first_of_sheet_.push_back(discs_.size());
    sides_.resize(places_.size() * words_);
    standing_.resize(surface_count_ * words_);
    has_sides_.assign(places_.size(), Known::no);
    has_standing_.assign(surface_count_, Known::no);
}

const MiddleDiscs::Word* MiddleDiscs::sides(std::size_t place) {
    Word* const row = sides_.data() + place * words_;
    Known& known = has_sides_[place];
    if (known == Known::no)
        for (std::size_t w = 0; w < words_; ++w)
            row[w] = lanes_.behind(flat_.data() + w * 6 * word_bits, places_[place].data());
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
        for (std::size_t s = 0; s + 1 < first_of_sheet_.size(); ++s) {
            const std::size_t first = first_of_sheet_[s], end = first_of_sheet_[s + 1];
            if (!(std::abs(surface.normal | discs_[first].normal) <= angles::halfway)) continue;
            for (std::size_t d = first; d < end; ++d) row[d / word_bits] |= Word{1} << d % word_bits;
            known = Known::yes;
        }
    }
    return known == Known::yes ? row : nullptr;
}

/// What of the discs on one surface a way was seen to cross.
class MiddleDiscs::Question {
public:
    Question() = default;
    Question(const Word* standing, const Vec3& normal) : standing_(standing), normal_(normal) {}

    /// Those of a word that would say something new: of walls as of gaps one disc of each sheet is enough.
    Word open(std::size_t word, Word behind, Word gaps) const {
        return standing_[word] & ~(seen_of(seen_[0], behind) & ~gaps) & ~(seen_of(seen_[1], behind) & gaps);
    }
    /// Takes note of a disc that the way crosses at x. Returns whether both sheets of one kind were crossed.
    bool note(const MiddleDisc& disc, bool is_behind, const Vec3& x) {
        // At the mouth of a gap its sheets lie below the surface, on the ground of a wall above it; the
        // rim of a wall and the bottom of a gap, which join the two sheets, see them on the other side.
        if (((normal_ | (disc.point - x)) < 0) != disc.is_gap) return false;
        unsigned& sheets = seen_[disc.is_gap];
        sheets |= is_behind ? 1u : 2u;
        return sheets == 3;
    }

private:
    static Word seen_of(unsigned sheets, Word behind) {
        return (sheets & 1u ? behind : 0) | (sheets & 2u ? ~behind : 0);
    }

    const Word* standing_ = nullptr;
    Vec3 normal_;
    std::array<unsigned, 2> seen_{}; // sheets of walls, of gaps: 1 is the one whose front the way comes to
};

bool MiddleDiscs::part(std::size_t p, std::size_t q, std::span<const Surface> surfaces) {
    std::array<Question, 2> asked;
    std::size_t count = 0;
    for (const Surface& surface : surfaces)
        if (const Word* const here = standing(surface)) asked[count++] = {here, surface.normal};
    if (count == 0) return false;
    const Word *const behind_p = sides(p), *const behind_q = sides(q);
    const Vec3 way = places_[q] - places_[p], middle = (places_[p] + way * 0.5 - amid_) * per_voxel_;
    const std::array<float, 4> of_way{static_cast<float>(middle[0]), static_cast<float>(middle[1]),
                                      static_cast<float>(middle[2]),
                                      static_cast<float>(0.5 * way.norm() * per_voxel_)};
    for (std::size_t w = 0; w < words_; ++w) {
        const auto open = [&](const Question& question) { return question.open(w, behind_p[w], gaps_[w]); };
        const auto any_open = [&] { return count == 2 ? open(asked[0]) | open(asked[1]) : open(asked[0]); };
        Word crossed = (behind_p[w] ^ behind_q[w]) & any_open();
        if (crossed != 0) crossed = lanes_.near_way(near_.data() + w * 4 * word_bits, crossed, of_way.data());
        while (crossed != 0) {
            const Word bit = crossed & -crossed;
            crossed ^= bit;
            const MiddleDisc& disc = discs_[w * word_bits + static_cast<std::size_t>(std::countr_zero(bit))];
            const double dp = disc.normal | (places_[p] - disc.middle),
                         dq = disc.normal | (places_[q] - disc.middle);
            const Vec3 x = places_[p] + way * (dp / (dp - dq));
            if ((x - disc.middle).sqrnorm() > disc.squared_radius) continue;
            for (std::size_t s = 0; s < count; ++s)
                if ((open(asked[s]) & bit) != 0 && asked[s].note(disc, (behind_p[w] & bit) != 0, x))
                    return true;
            crossed &= any_open();
        }
    }
    return false;
}

} // namespace hsdm
