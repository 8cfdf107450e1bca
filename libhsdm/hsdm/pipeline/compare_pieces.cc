#include "hsdm/pipeline/compare_pieces.hh"

#include "hsdm/core/parallel_sort.hh"

#include <algorithm>
#include <tuple>

namespace hsdm {
namespace {

/// What a tile has found in a voxel of another, or in one of its own that another one sees.
struct Sight {
    std::size_t tile, by; ///< whose voxel it is, and who looks from outside
    Piece::Digest digest;

    auto key() const { return std::tuple(tile, by, digest.code); }
};

void sort_by_key(std::vector<Sight>& sights) {
    parallel_sort(sights, [](const Sight& a, const Sight& b) { return a.key() < b.key(); });
}

class Comparison {
public:
    Comparison(const std::vector<Piece>& pieces, std::span<const VoxelRange> ranges,
               const std::function<int(std::size_t)>& owner, Ranks& ranks)
        : pieces_(pieces), ranges_(ranges), owner_(owner), ranks_(ranks) {}

    /// Who owns a tile compares what others have seen there.
    std::vector<std::uint8_t> disagreeing() const {
        std::vector<Sight> seen = seen_by_others(), own = own_that_others_see();
        sort_by_key(seen), sort_by_key(own);
        std::vector<std::uint8_t> found(pieces_.size(), 0);
        const auto differ = [&](const Sight& sight) { found[sight.tile] = found[sight.by] = 1; };
        auto s = seen.begin(), o = own.begin();
        while (s != seen.end() || o != own.end()) {
            const bool take_seen = o == own.end() || (s != seen.end() && s->key() <= o->key());
            const bool take_own = s == seen.end() || (o != own.end() && o->key() <= s->key());
            if (!take_seen || !take_own || !(s->digest == o->digest)) differ(take_seen ? *s : *o);
            if (take_seen) ++s;
            if (take_own) ++o;
        }
        return ranks_.any_of_each(found);
    }

private:
    bool is_own(std::size_t tile) const { return owner_(tile) == ranks_.rank(); }
    std::size_t tile_of(MortonCode code) const {
        const auto next = std::ranges::upper_bound(ranges_, code, {}, &VoxelRange::begin);
        return static_cast<std::size_t>(next - ranges_.begin()) - 1;
    }

    /// In this rank's voxels; what its own tiles have seen goes to the ranks that have theirs.
    std::vector<Sight> seen_by_others() const {
        std::vector<Ranks::Bytes> out(static_cast<std::size_t>(ranks_.size()));
        for (std::size_t by = 0; by < pieces_.size(); ++by) {
            if (!is_own(by)) continue;
            const std::vector<Piece::Digest>& beyond = pieces_[by].beyond;
            for (auto first = beyond.begin(); first != beyond.end();) {
                const std::size_t tile = tile_of(first->code);
                const auto last = std::ranges::lower_bound(first, beyond.end(), ranges_[tile].end, {},
                                                           &Piece::Digest::code);
                Ranks::Bytes& to = out[static_cast<std::size_t>(owner_(tile))];
                put(tile, to), put(by, to);
                put_vector(std::vector<Piece::Digest>(first, last), to);
                first = last;
            }
        }
        std::vector<Sight> seen;
        for (const Ranks::Bytes& got : ranks_.exchange(std::move(out)))
            for (ByteReader reader(got); !reader.at_end();) {
                const auto tile = reader.take<std::size_t>(), by = reader.take<std::size_t>();
                for (const auto& digest : reader.take_vector<Piece::Digest>())
                    seen.push_back({tile, by, digest});
            }
        return seen;
    }

    std::vector<Sight> own_that_others_see() const {
        std::vector<Sight> own;
        for (std::size_t tile = 0; tile < pieces_.size(); ++tile)
            if (is_own(tile))
                for (const Piece::Digest& digest : pieces_[tile].border) add_sights(tile, digest, own);
        return own;
    }

    /// One for each other tile that is near the voxel.
    void add_sights(std::size_t tile, const Piece::Digest& digest, std::vector<Sight>& own) const {
        const std::size_t before = own.size();
        ranges_[tile].any_cell_near(morton_decode(digest.code), compared_voxels, [&](MortonCode first) {
            const std::size_t by = tile_of(first);
            const auto is_there = [by](const Sight& sight) { return sight.by == by; };
            if (by != tile
                && std::none_of(own.begin() + static_cast<std::ptrdiff_t>(before), own.end(), is_there))
                own.push_back({tile, by, digest});
            return false;
        });
    }

    const std::vector<Piece>& pieces_;
    std::span<const VoxelRange> ranges_;
    const std::function<int(std::size_t)>& owner_;
    Ranks& ranks_;
};

} // namespace

std::vector<std::uint8_t> disagreeing_tiles(const std::vector<Piece>& pieces,
                                            std::span<const VoxelRange> ranges,
                                            const std::function<int(std::size_t)>& owner, Ranks& ranks) {
    return Comparison(pieces, ranges, owner, ranks).disagreeing();
}

} // namespace hsdm
