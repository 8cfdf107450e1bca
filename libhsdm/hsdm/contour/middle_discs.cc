#include "hsdm/contour/middle_discs.hh"

#include "hsdm/contour/disc_lanes.hh"
#include "hsdm/core/constants.hh"

#include <algorithm>
#include <bit>
#include <cmath>

namespace hsdm {
namespace {

constexpr std::size_t word_bits = discs_of_word;

template <class T>
void grow(std::vector<T>& values, std::size_t size) {
    if (values.size() < size) values.resize(size);
}

/// Sets the bits from begin to end of a row.
void set_bits(std::uint64_t* row, std::size_t begin, std::size_t end) {
    constexpr std::uint64_t all = ~std::uint64_t{0};
    for (std::size_t w = begin / word_bits; w * word_bits < end; ++w) {
        std::uint64_t bits = all;
        if (begin > w * word_bits) bits &= all << begin % word_bits;
        if (end < (w + 1) * word_bits) bits &= ~(all << end % word_bits);
        row[w] |= bits;
    }
}

} // namespace

void MiddleDiscs::reset(std::size_t surfaces, const Vec3& amid, double voxel_size) {
    sheets_.clear();
    count_ = words_ = 0;
    surface_count_ = surfaces;
    amid_ = amid;
    per_voxel_ = 1 / voxel_size;
}

void MiddleDiscs::add(const Vec3& normal, std::span<const SeenDisc> discs) {
    if (discs.empty()) return;
    sheets_.push_back({normal, discs, count_});
    count_ += discs.size();
}

void MiddleDiscs::set_places(std::span<const Vec3> places) {
    places_ = places;
    const std::size_t words = (count_ + word_bits - 1) / word_bits;
    grow(sides_, places_.size() * words);
    has_side_.assign(places_.size() * words, 0);
}

void MiddleDiscs::begin_questions() {
    words_ = (count_ + word_bits - 1) / word_bits;
    is_laid_out_.assign(words_, 0);
    grow(discs_, words_ * word_bits);
    grow(flat_, words_ * 6 * word_bits);
    grow(near_, words_ * 4 * word_bits);
    grow(gaps_, words_);
    grow(standing_, surface_count_ * words_);
    has_standing_.assign(surface_count_, Known::no);
    normals_.clear();
    for (std::size_t s = 0; s < sheets_.size(); s += 2)
        normals_.emplace_back(sheets_[s].normal, sheets_[std::min(s + 1, sheets_.size() - 1)].normal);
}

void MiddleDiscs::lay_out(std::size_t d, const Vec3& normal, const SeenDisc& seen) {
    const Vec3 middle = seen.point + normal * seen.off;
    discs_[d] = {middle, normal, seen.point, seen.radius * seen.radius, seen.off > 0};
    double* const at = flat_.data() + d / word_bits * 6 * word_bits + d % word_bits;
    float* const near = near_.data() + d / word_bits * 4 * word_bits + d % word_bits;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        at[axis * word_bits] = normal[axis];
        at[(axis + 3) * word_bits] = middle[axis];
        near[axis * word_bits] = static_cast<float>((middle[axis] - amid_[axis]) * per_voxel_);
    }
    near[3 * word_bits] = static_cast<float>(seen.radius * per_voxel_);
    if (seen.off > 0) gaps_[d / word_bits] |= Word{1} << d % word_bits;
}

/// The discs of a word, which no row has before one of them is asked for.
void MiddleDiscs::lay_out(std::size_t word) {
    is_laid_out_[word] = 1;
    gaps_[word] = 0;
    std::size_t d = word * word_bits;
    const std::size_t end = std::min(count_, d + word_bits);
    if (end < d + word_bits) { // zeros fill up the last word: no place is behind one
        std::fill_n(flat_.begin() + static_cast<std::ptrdiff_t>(word * 6 * word_bits), 6 * word_bits, 0.0);
        std::fill_n(near_.begin() + static_cast<std::ptrdiff_t>(word * 4 * word_bits), 4 * word_bits, 0.0f);
    }
    auto sheet = std::ranges::upper_bound(sheets_, d, {}, &Sheet::first) - 1;
    for (; d < end; ++sheet)
        for (std::size_t k = d - sheet->first; k < sheet->discs.size() && d < end; ++k, ++d)
            lay_out(d, sheet->normal, sheet->discs[k]);
}

MiddleDiscs::Word MiddleDiscs::side(std::size_t place, std::size_t word) {
    const std::size_t at = place * words_ + word;
    if (!has_side_[at]) {
        sides_[at] = lanes_.behind(flat_.data() + word * 6 * word_bits, places_[place].data());
        has_side_[at] = 1;
    }
    return sides_[at];
}

/// Null if none stands on the surface.
const MiddleDiscs::Word* MiddleDiscs::standing(const Surface& surface) {
    if (count_ == 0) return nullptr;
    if (words_ == 0) begin_questions();
    Word* const row = standing_.data() + surface.number * words_;
    Known& known = has_standing_[surface.number];
    if (known == Known::no) {
        std::fill_n(row, words_, 0);
        known = Known::none;
        const Double2 most = Double2{} + angles::halfway;
        for (std::size_t pair = 0; pair < normals_.size(); ++pair) {
            const Double2 cosine = normals_[pair] | surface.normal;
            const unsigned stand = lanes_of_two(max_lanes(cosine, -cosine) <= most);
            for (std::size_t lane = 0; stand >> lane != 0; ++lane) {
                const std::size_t s = 2 * pair + lane;
                if ((stand >> lane & 1) == 0 || s == sheets_.size()) continue;
                set_bits(row, sheets_[s].first, sheets_[s].first + sheets_[s].discs.size());
                known = Known::yes;
            }
        }
    }
    return known == Known::yes ? row : nullptr;
}

/// Of a way of this length its middle and half of it, in voxels.
std::array<float, 4> MiddleDiscs::ball(const Vec3& middle, double length) const {
    const Vec3 from = (middle - amid_) * per_voxel_;
    return {static_cast<float>(from[0]), static_cast<float>(from[1]), static_cast<float>(from[2]),
            static_cast<float>(0.5 * length * per_voxel_)};
}

bool MiddleDiscs::look_at(std::span<const Surface> surfaces, const Box& box) {
    looked_at_.clear();
    asked_count_ = 0;
    for (const Surface& surface : surfaces)
        if (const Word* const here = standing(surface)) asked_[asked_count_++] = {here, surface.normal};
    if (asked_count_ == 0) return false;
    // Every way lies in the ball about the box, as if it were one way from corner to corner.
    const std::array<float, 4> ball = this->ball((box.lo + box.hi) * 0.5, box.diagonal());
    for (std::size_t w = 0; w < words_; ++w) {
        const Word standing = asked_[0].standing[w] | asked_[asked_count_ - 1].standing[w];
        if (standing == 0) continue;
        if (!is_laid_out_[w]) lay_out(w);
        const Word near = lanes_.near_way(near_.data() + w * 4 * word_bits, standing, ball.data());
        if (near != 0) looked_at_.push_back({w, near, 0, 0});
    }
    return !looked_at_.empty();
}

/// Which of the discs looked at a way crosses, by their planes. False if it has to cross none.
bool MiddleDiscs::find_crossed(std::size_t p, std::size_t q) {
    bool any = false;
    for (Near& near : looked_at_) {
        near.behind = side(p, near.word);
        near.crossed = (near.behind ^ side(q, near.word)) & near.discs;
        any |= near.crossed != 0;
    }
    return any;
}

/// On which of the surfaces, a bit each, a way crosses a wall, or gap, that it comes to from the front, or
/// from behind; all of them, or one that is found first.
unsigned MiddleDiscs::crossed_on(std::size_t p, std::size_t q, unsigned surfaces, bool gaps, bool behind,
                                 bool all) const {
    const Vec3 way = places_[q] - places_[p];
    unsigned found = 0;
    for (const Near& near : looked_at_) {
        Word crossed = near.crossed & (gaps ? gaps_[near.word] : ~gaps_[near.word])
                       & (behind ? near.behind : ~near.behind);
        for (; crossed != 0; crossed &= crossed - 1) {
            const auto bit = static_cast<std::size_t>(std::countr_zero(crossed));
            const Disc& disc = discs_[near.word * word_bits + bit];
            const double dp = disc.normal | (places_[p] - disc.middle),
                         dq = disc.normal | (places_[q] - disc.middle);
            const Vec3 x = places_[p] + way * (dp / (dp - dq));
            if ((x - disc.middle).sqrnorm() > disc.squared_radius) continue;
            for (unsigned s = 0; s < asked_count_; ++s) {
                if ((surfaces >> s & 1) == 0 || (asked_[s].standing[near.word] >> bit & 1) == 0) continue;
                // At the mouth of a gap its sheets lie below the surface, on the ground of a wall above it;
                // the rim of a wall and the bottom of a gap, which join the two sheets, see them on the other
                // side.
                if (((asked_[s].normal | (disc.point - x)) < 0) == gaps) found |= 1u << s;
            }
            if (found == surfaces || (found != 0 && !all)) return found;
        }
    }
    return found;
}

bool MiddleDiscs::part(std::size_t p, std::size_t q) {
    if (!find_crossed(p, q)) return false;
    for (const bool gaps : {false, true}) { // both sheets of either
        Word before = 0, behind = 0;
        for (const Near& near : looked_at_) {
            const Word crossed = near.crossed & (gaps ? gaps_[near.word] : ~gaps_[near.word]);
            before |= crossed & ~near.behind;
            behind |= crossed & near.behind;
        }
        if (before == 0 || behind == 0) continue;
        const unsigned surfaces = crossed_on(p, q, (1u << asked_count_) - 1, gaps, true, true);
        if (surfaces != 0 && crossed_on(p, q, surfaces, gaps, false, false) != 0) return true;
    }
    return false;
}

} // namespace hsdm
