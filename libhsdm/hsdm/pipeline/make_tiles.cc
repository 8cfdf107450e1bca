#include "hsdm/pipeline/make_tiles.hh"

#include "hsdm/core/chunks.hh"
#include "hsdm/core/hash.hh"
#include "hsdm/core/large_vector.hh"
#include "hsdm/pipeline/cell_attributes.hh"
#include "hsdm/pipeline/compare_pieces.hh"
#include "hsdm/pipeline/stray_search.hh"
#include "hsdm/pipeline/tile_plan.hh"

#include <algorithm>
#include <utility>

namespace hsdm {
namespace {

class TileMaker {
public:
    TileMaker(const TilesInput& in, const std::vector<VoxelRange>& ranges, bool turned, TilesKnown& known,
              TileReport& how)
        : in_(in),
          cloud_(in.cloud),
          ranks_(in.cloud.ranks()),
          ranges_(ranges),
          turned_(turned),
          known_(known),
          how_(how),
          strays_(in.cloud, in.survey),
          was_kept_(ranges.size(), 0) {}

    std::optional<std::vector<Piece>> pieces() {
        std::vector<Piece> pieces(ranges_.size());
        std::vector<int> ghost(ranges_.size(), in_.ghost_voxels);
        std::vector<std::uint8_t> due(ranges_.size(), 1);
        while (std::ranges::count(due, 1) > 0) {
            make_due(due, ghost, pieces);
            if (!known_.outliers) {
                const StraySearch::Result strays = leave_strays_out();
                if (in_.on_outliers) in_.on_outliers();
                if (strays.moved) return std::nullopt;
                if (strays.outliers.count > 0) continue; // all are due still
            }
            due = disagreeing_tiles(
                pieces, ranges_, [&](std::size_t k) { return owner(k); }, ranks_);
            add_far_looking(pieces, due);
            for (std::size_t k = 0; k < ranges_.size(); ++k)
                if (due[k]) ghost[k] *= 2, ++how_.widened;
            if (std::ranges::count(due, 1) == 0) due = due_by_sums(pieces);
        }
        how_.kept_tiles = static_cast<std::size_t>(std::ranges::count(was_kept_, 1));
        return pieces;
    }

private:
    int owner(std::size_t tile) const { return cloud_.owner_of(ranges_[tile]); }
    bool is_own(std::size_t tile) const { return owner(tile) == ranks_.rank(); }

    /// Tiles that looked farther behind a ring than they know what is there, up to some 70 voxels along a bar
    /// (handles::fewest_of_part facets, three or more round it); or that know part of a loop to be closed.
    void add_far_looking(const std::vector<Piece>& pieces, std::vector<std::uint8_t>& due) const {
        std::vector<std::uint8_t> far_looking(pieces.size(), 0);
        for (std::size_t k = 0; k < pieces.size(); ++k)
            far_looking[k] = due[k] || (is_own(k) && pieces[k].counts.looked_far);
        due = ranks_.any_of_each(far_looking);
    }

    /// Those of this rank. All ranks know of all how wide they are.
    void make_due(const std::vector<std::uint8_t>& due, const std::vector<int>& ghost,
                  std::vector<Piece>& pieces) {
        std::vector<ScratchCloud::Surroundings> wanted;
        for (std::size_t k = 0; k < ranges_.size(); ++k) {
            if (due[k] && ghost[k] > most_ghost_voxels)
                refuse_in_tiles("neighbouring parts do not agree, or depend on more than lies around them");
            if (due[k] && is_own(k)) wanted.push_back({ranges_[k], ghost[k]});
        }
        cloud_.fetch(wanted);
        for (std::size_t k = 0; k < ranges_.size(); ++k)
            if (due[k] && is_own(k)) pieces[k] = checked_piece(k, ghost[k]);
    }

    Piece checked_piece(std::size_t tile, int ghost) {
        const VoxelRange& range = ranges_[tile];
        const std::uint64_t key = key_of(range, ghost);
        const auto record = in_.kept ? in_.kept->tile(key) : std::nullopt;
        was_kept_[tile] = record.has_value();
        if (record) return kept_piece(*record);
        const std::size_t far = strays_.far_cells().size();
        Piece piece = make_tile(range, ghost);
        if (in_.store) in_.store->put(piece);
        if (in_.kept && in_.kept->is_kept() && !strays_.has_found()) keep(piece, key, ghost, far);
        return piece;
    }

    /// Of all that a piece is made by: what is of the whole cloud and its options goes without saying.
    std::uint64_t key_of(const VoxelRange& range, int ghost) const {
        OrderedHash hash;
        for (const std::uint64_t code : {range.begin, range.end}) hash.add(code);
        const auto completed = static_cast<int>(in_.completed);
        for (const int number : {range.depth, range.cell_shift, ghost, known_.tangles.rounds, completed})
            hash.add(static_cast<std::uint64_t>(number));
        for (const bool is : {turned_, known_.has_layers, known_.go_back, known_.tangles.weighed,
                              known_.tangles.mends, known_.tangles.replaces})
            hash.add(std::uint64_t{is});
        for (const std::size_t count : known_.largest) hash.add(std::uint64_t{count});
        hash.add(in_.added);
        hash.add(std::uint64_t{in_.survey.sums.points()});
        hash.add(std::uint64_t{cloud_.attributes().bytes()});
        hash.add(cloud_.cube_extent());
        for (const double x : cloud_.origin()) hash.add(x);
        return hash.value() | std::uint64_t{1} << 63; // no pass
    }

    /// `far`: so many cells were put off before.
    void keep(const Piece& piece, std::uint64_t key, int ghost, std::size_t far) {
        in_.store->flush_to_disk();
        Ranks::Bytes record;
        put(ghost, record);
        const std::vector<MortonCode>& cells = strays_.far_cells();
        put_vector(std::vector<MortonCode>(cells.begin() + static_cast<std::ptrdiff_t>(far), cells.end()),
                   record);
        in_.store->put_record(piece, record);
        in_.kept->keep_tile(key, record, in_.store->bytes());
    }

    Piece kept_piece(const Ranks::Bytes& record) {
        ByteReader reader(record);
        const auto ghost = reader.take<int>();
        const auto far = reader.take_vector<MortonCode>();
        if (!known_.outliers) strays_.put_off(far, ghost);
        return in_.store->take_record(reader);
    }

    Piece make_tile(const VoxelRange& range, int ghost) {
        Piece piece;
        piece.range = range;
        Octree octree = cloud_.octree_around(range, ghost);
        how_.points_read += octree.size();
        if (octree.size() == 0) return piece;
        if (!known_.outliers) strays_.add(octree, range, ghost);
        if (strays_.has_found()) return piece; // all are made again without them
        const OctreeLevel level = extract_level(octree, cloud_.depth());
        const std::vector<char> rows = take_attributes(cloud_, range, octree);
        const PointView attributes = cloud_.attributes().view(rows);
        MethodInput in{cloud_.frame(), attributes, octree, level, in_.options, in_.phases};
        in.has_layers = known_.has_layers;
        const PartOfLevel part{
            in_.survey.spacing,
            in_.survey.sums.set_sizes().typical(),
            turned_,
            known_.go_back,
            known_.tangles,
            known_.largest,
            in_.completed,
            [&](MortonCode code) { return range.holds(code); },
            [&](MortonCode code) { return range.is_near(morton_decode(code), ghost / 2); }};
        return make_piece(in, part, range, cloud_.attributes().of_vertices());
    }

    /// Once all tiles have looked for them: all is different without them.
    StraySearch::Result leave_strays_out() {
        const StraySearch::Result result = strays_.leave_out(cloud_, in_.survey, in_.group_points);
        known_.outliers = result.outliers;
        return result;
    }

    /// Of all ranks' tiles, added up in one order.
    FacetCounts counts_of_all(const std::vector<Piece>& pieces) {
        Ranks::Bytes own;
        for (std::size_t k = 0; k < pieces.size(); ++k)
            if (is_own(k)) put(pieces[k].counts, own);
        FacetCounts all;
        for (const Ranks::Bytes& got : ranks_.gather(own))
            for (const FacetCounts& counts : ByteReader(got).take_rest<FacetCounts>()) all += counts;
        return all;
    }

    /// Tiles to be made once more since sums over all tell something that these were not made by.
    std::vector<std::uint8_t> due_by_sums(const std::vector<Piece>& pieces) {
        const FacetCounts sums = counts_of_all(pieces);
        std::vector<std::uint8_t> due(pieces.size(), 0);
        if (must_go_back(sums) || must_use_largest(pieces))
            std::ranges::fill(due, std::uint8_t{1});
        else if (known_.tangles.weigh(sums.tangles))
            for (std::size_t k = 0; k < pieces.size(); ++k) due[k] = pieces[k].counts.tangles.near;
        return ranks_.any_of_each(due);
    }

    /// Splinters are small beside the largest component, which was taken for large.
    bool must_use_largest(const std::vector<Piece>& pieces) {
        LargestOfWhole largest;
        for (std::size_t stage = 0; stage < largest.size(); ++stage)
            largest[stage] = largest_of_all(pieces, stage);
        return std::exchange(known_.largest, largest) != largest;
    }

    std::size_t largest_of_all(const std::vector<Piece>& pieces, std::size_t stage) {
        const std::size_t enough = SplinterOptions().enough();
        std::vector<PartComponents> parts;
        for (std::size_t k = 0; k < pieces.size(); ++k)
            if (is_own(k)) parts.push_back(pieces[k].components[stage]);
        if (ranks_.any(largest_component(parts, enough) >= enough)) return enough;
        Ranks::Bytes own;
        for (const PartComponents& part : parts) {
            put(part.largest, own);
            put_vector(part.sizes, own), put_vector(part.shared, own);
        }
        parts.clear();
        for (const Ranks::Bytes& got : ranks_.gather(own))
            for (ByteReader reader(got); !reader.at_end();) {
                PartComponents& part = parts.emplace_back();
                part.largest = reader.take<std::size_t>();
                part.sizes = reader.take_vector<std::size_t>();
                part.shared = reader.take_vector<PartComponents::Shared>();
            }
        return std::max<std::size_t>(1, largest_component(parts, enough));
    }

    /// Vertices as moved towards the points stay only where that brings all together nearer. Are they to go
    /// back, and have not yet?
    bool must_go_back(const FacetCounts& all) {
        const double gain = all.misfit_placed - all.misfit_moved;
        constexpr double rounding = 1e-9; // sums of parts are rounded otherwise than that of the whole
        if (std::abs(gain) <= rounding * all.misfit_placed && all.misfit_placed > 0)
            refuse_in_tiles("facets moved to the points are neither nearer to them nor farther off");
        return !std::exchange(known_.go_back, gain < 0) && known_.go_back;
    }

    const TilesInput& in_;
    ScratchCloud& cloud_;
    Ranks& ranks_;
    const std::vector<VoxelRange>& ranges_;
    bool turned_;
    TilesKnown& known_;
    TileReport& how_;
    StraySearch strays_;
    std::vector<std::uint8_t> was_kept_; // of own tiles, as they are now
};

} // namespace

std::optional<std::vector<Piece>> make_tiles(const TilesInput& in, const std::vector<VoxelRange>& ranges,
                                             bool turned, TilesKnown& known, TileReport& how) {
    return TileMaker(in, ranges, turned, known, how).pieces();
}

} // namespace hsdm
